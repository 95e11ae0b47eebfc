// SPDX-License-Identifier: MIT
#include "refine/surface_pairing.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>

#include "kernel/spatial_order.h"

namespace corral {
namespace {

constexpr std::size_t kShare = 4096;  // pairs that one thread sums at a time

/// Eight pairs, or fewer: the moved points m in pr about a centre, d = m - q in pr, the normals n, and 1; all are zero where
/// there is no pair.
template <class Lanes>
struct PairLanes {
  Lanes m[3], d[3], n[3], one;
};

/// The columns whose products make up the sums: of a plane pair the 13 of its residual, of a point pair those that its three
/// residuals share.
struct PlaneColumns {
  static constexpr int kWidth = 13;
  static constexpr bool kWithNormals = true;
  template <class Lanes>
  static CORRAL_INLINE void set(const PairLanes<Lanes>& pair, Lanes* columns) {
    for (int axis = 0; axis < 3; ++axis)
      for (int j = 0; j < 3; ++j) columns[3 * axis + j] = pair.m[axis] * pair.n[j];
    for (int j = 0; j < 3; ++j) columns[9 + j] = pair.n[j];
    columns[12] = pair.n[0] * pair.d[0] + pair.n[1] * pair.d[1] + pair.n[2] * pair.d[2];
  }
  static Gram gram(const Eigen::Matrix<double, kWidth, kWidth>& sums) { return sums; }
};

struct PointColumns {
  static constexpr int kWidth = 7;
  static constexpr bool kWithNormals = false;
  template <class Lanes>
  static CORRAL_INLINE void set(const PairLanes<Lanes>& pair, Lanes* columns) {
    for (int axis = 0; axis < 3; ++axis) columns[axis] = pair.m[axis];
    columns[3] = pair.one;
    for (int axis = 0; axis < 3; ++axis) columns[4 + axis] = pair.d[axis];
  }
  static Gram gram(const Eigen::Matrix<double, kWidth, kWidth>& sums) {
    Gram gram = Gram::Zero();  // r_axis = sum_j (R - I)(axis, j) m_j + t_axis + d_axis
    for (int axis = 0; axis < 3; ++axis) {
      for (int j = 0; j < 4; ++j) {
        for (int k = 0; k < 4; ++k) gram(3 * j + axis, 3 * k + axis) = sums(j, k);
        gram(3 * j + axis, 12) = gram(12, 3 * j + axis) = sums(j, 4 + axis);
      }
      gram(12, 12) += sums(4 + axis, 4 + axis);
    }
    return gram;
  }
};

/// The columns of the point-to-plane equations: arm x normal, normal. The arm stands in the place of m.
struct EquationColumns {
  static constexpr int kWidth = 6;
  static constexpr bool kWithNormals = true;
  template <class Lanes>
  static CORRAL_INLINE void set(const PairLanes<Lanes>& pair, Lanes* columns) {
    for (int axis = 0; axis < 3; ++axis) {
      const int next = (axis + 1) % 3, last = (axis + 2) % 3;
      columns[axis] = pair.m[next] * pair.n[last] - pair.m[last] * pair.n[next];
      columns[3 + axis] = pair.n[axis];
    }
  }
};

}  // namespace

SurfacePairing::SurfacePairing(const SurfacePair& surfaces, double least_cosine)
    : surfaces_(surfaces), least_cosine_(least_cosine), unit_(surfaces.resolution) {
  const auto have_normals = [](const Points& normals) {
    const Eigen::VectorXd squares = normals.rowwise().squaredNorm();
    std::vector<char> have;
    have.reserve(static_cast<std::size_t>(squares.size()));
    for (const double square : squares) have.push_back(square > 0);
    return have;
  };
  order_ = spatial_order(surfaces.source.points, surfaces.parallel);
  source_ = surfaces.source.points(order_, Eigen::all);
  source_has_normal_ = have_normals(surfaces.source.normals);
  target_has_normal_ = have_normals(surfaces.target.normals);
}

Eigen::Index SurfacePairing::take(int most_points) {
  const Eigen::Index step = std::max<Eigen::Index>(1, (source_.rows() + most_points - 1) / most_points);
  if (step == taken_step_) return step;
  taken_step_ = step;
  const Eigen::Index count = (source_.rows() + step - 1) / step;
  taken_ = source_(Eigen::seqN(0, count, step), Eigen::all);
  taken_rows_.clear();
  for (std::size_t i = 0; i < order_.size(); i += static_cast<std::size_t>(step)) taken_rows_.push_back(order_[i]);
  for (AlignedColumn& column : taken_normals_) column.clear();
  if (count == 0) return step;
  taken_mean_ = taken_.colwise().mean().transpose();
  size_pr_ = std::sqrt((taken_.rowwise() - taken_mean_.transpose()).rowwise().squaredNorm().mean()) / unit_;
  return step;
}

/// Of the taken points, zero where there is none.
void SurfacePairing::take_source_normals() {
  for (int axis = 0; axis < 3; ++axis) {
    taken_normals_[axis].assign(is_pair_.size(), 0.0);
    for (std::size_t i = 0; i < taken_rows_.size(); ++i)
      if (source_has_normal_[static_cast<std::size_t>(taken_rows_[i])])
        taken_normals_[axis][i] = surfaces_.source.normals(taken_rows_[i], axis);
  }
}

/// To the pairs those of the target.
void SurfacePairing::take_target_normals() {
  for (int axis = 0; axis < 3; ++axis) {
    normals_[axis].assign(is_pair_.size(), 0.0);
    for (std::size_t i = 0; i < is_pair_.size(); ++i)
      if (is_pair_[i] != 0) normals_[axis][i] = surfaces_.target.normals(pairs_->target_rows[i], axis);
  }
}

/// Leaves only pairs whose normals agree, each with the mean of both. Where most look against each other, one of the
/// surfaces is taken to be inside out.
void SurfacePairing::compare_normals(const RigidTransform& pose) {
  if (taken_normals_[0].size() != is_pair_.size()) take_source_normals();
  vectorized([&](auto kind) {
    using Lanes = typename decltype(kind)::Lanes;
    const Lanes zero = Lanes::fill(0);
    agreement_.resize(is_pair_.size());
    Lanes turned[3], agreements = zero;
    const auto turn = [&](std::size_t i) {
      for (int axis = 0; axis < 3; ++axis) {
        turned[axis] = zero;
        for (int j = 0; j < 3; ++j)
          turned[axis] = turned[axis] + Lanes::fill(pose.rotation(axis, j)) * Lanes::load(&taken_normals_[j][i]);
      }
    };
    for (std::size_t i = 0; i < is_pair_.size(); i += kLanes) {
      turn(i);
      Lanes agreement = zero;
      for (int axis = 0; axis < 3; ++axis) agreement = agreement + turned[axis] * Lanes::load(&normals_[axis][i]);
      agreement.store(&agreement_[i]);
      agreements = agreements + agreement;
    }
    const Lanes side = Lanes::fill(sum(agreements) < 0 ? -1 : 1), least = Lanes::fill(least_cosine_);
    for (std::size_t i = 0; i < is_pair_.size(); i += kLanes) {
      turn(i);
      select(least <= side * Lanes::load(&agreement_[i]), Lanes::load(&is_pair_[i]), zero).store(&is_pair_[i]);
      Lanes mean[3], squared = zero;
      for (int axis = 0; axis < 3; ++axis) {
        mean[axis] = Lanes::load(&normals_[axis][i]) + side * turned[axis];
        squared = squared + mean[axis] * mean[axis];
      }
      const Lanes length = square_root(squared);
      for (int axis = 0; axis < 3; ++axis) (mean[axis] / length).store(&normals_[axis][i]);
    }
  });
}

template <class Lanes, bool kWithNormals>
CORRAL_INLINE auto SurfacePairing::eight_pairs(std::size_t first, const AlignedColumn (&places)[3],
                                               const Eigen::Vector3d& centre, double scale) const {
  PairLanes<Lanes> pairs;
  const Lanes zero = Lanes::fill(0);
  pairs.one = Lanes::load(&is_pair_[first]);
  for (int axis = 0; axis < 3; ++axis) {
    const Lanes m = Lanes::load(&places[axis][first]) - Lanes::fill(centre(axis)),
                d = Lanes::load(&pairs_->source[axis][first]) - Lanes::load(&pairs_->target[axis][first]);
    pairs.m[axis] = select(zero < pairs.one, m * Lanes::fill(scale), zero);
    pairs.d[axis] = select(zero < pairs.one, d * Lanes::fill(scale), zero);
  }
  if (!kWithNormals) return pairs;
  for (int axis = 0; axis < 3; ++axis)
    pairs.n[axis] = select(zero < pairs.one, Lanes::load(&normals_[axis][first]), zero);
  return pairs;
}

/// sum f f^T over the pairs, f their columns; m are some places about a centre, all is scaled.
template <class Columns>
auto SurfacePairing::sum_of_products(const AlignedColumn (&places)[3], const Eigen::Vector3d& centre,
                                     double scale) const {
  constexpr int kWidth = Columns::kWidth;
  using Sums = Eigen::Matrix<double, kWidth, kWidth>;
  std::vector<Sums> parts((is_pair_.size() + kShare - 1) / kShare);
  surfaces_.parallel(static_cast<int>(parts.size()), [&](int part) {
    const std::size_t begin = static_cast<std::size_t>(part) * kShare, end = std::min(begin + kShare, is_pair_.size());
    vectorized([&](auto kind) {
      using Lanes = typename decltype(kind)::Lanes;
      Lanes sums[kWidth][kWidth];
      for (auto& row : sums) std::fill_n(row, kWidth, Lanes::fill(0));
      for (std::size_t first = begin; first < end; first += kLanes) {
        Lanes columns[kWidth];
        Columns::set(eight_pairs<Lanes, Columns::kWithNormals>(first, places, centre, scale), columns);
        for (int i = 0; i < kWidth; ++i)
          for (int j = 0; j <= i; ++j) sums[i][j] = sums[i][j] + columns[i] * columns[j];
      }
      for (int i = 0; i < kWidth; ++i)
        for (int j = 0; j <= i; ++j)
          parts[static_cast<std::size_t>(part)](i, j) = parts[static_cast<std::size_t>(part)](j, i) = sum(sums[i][j]);
    });
  });
  Sums result = Sums::Zero();
  for (const Sums& part : parts) result += part;
  return result;
}

template <class Columns>
Gram SurfacePairing::gram() const {
  return Columns::gram(sum_of_products<Columns>(pairs_->source, centre_, 1 / unit_));
}

Pairing SurfacePairing::pair(SurfaceResidual residual, const RigidTransform& pose, double limit_pr) {
  moved_.noalias() = taken_ * pose.rotation.transpose();
  moved_.rowwise() += pose.translation.transpose();
  pairs_ = &surfaces_.pair(moved_, limit_pr * unit_);
  centre_ = pose.rotation * taken_mean_ + pose.translation;
  is_pair_.resize(pairs_->target_rows.size());
  for (std::size_t place = 0; place < is_pair_.size(); ++place) {
    const int row = pairs_->target_rows[place];
    is_pair_[place] = row >= 0 && target_has_normal_[static_cast<std::size_t>(row)] &&
                      source_has_normal_[static_cast<std::size_t>(taken_rows_[place])];
  }
  const bool by_planes = residual == SurfaceResidual::PointToPlane;
  if (by_planes) take_target_normals(), compare_normals(pose);
  Pairing pairing;
  pairing.centre = centre_;
  pairing.points = taken_.rows();
  for (const double is_pair : is_pair_) pairing.pairs += is_pair != 0;
  pairing.gram = by_planes ? gram<PlaneColumns>() : gram<PointColumns>();
  return pairing;
}

Spread SurfacePairing::spread(const Pairing& last) const {
  const double all = gram<PointColumns>()(12, 12), count = static_cast<double>(last.pairs);
  return {last.squares() / count, (all - last.squares()) / count};
}

double SurfacePairing::condition(Eigen::Index count) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double squares = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const AlignedColumn& places = pairs_->target[axis];
    for (std::size_t i = 0; i < is_pair_.size(); ++i)
      if (is_pair_[i] != 0) mean(axis) += places[i] / static_cast<double>(count);
    for (std::size_t i = 0; i < is_pair_.size(); ++i)
      if (is_pair_[i] != 0) squares += (places[i] - mean(axis)) * (places[i] - mean(axis));
  }
  const double size = std::sqrt(squares / static_cast<double>(count));
  if (!(size > 0)) return kInfinity;
  take_target_normals();
  const auto equations = sum_of_products<EquationColumns>(pairs_->target, mean, 1 / size);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> eigen(equations, Eigen::EigenvaluesOnly);
  const double least = eigen.eigenvalues()(0), most = eigen.eigenvalues()(5);
  return least > 0 ? most / least : kInfinity;
}

}  // namespace corral
