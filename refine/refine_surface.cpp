// SPDX-License-Identifier: MIT
#include "refine/refine_surface.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/error.h"
#include "kernel/spatial_order.h"
#include "kernel/vectorized.h"
#include "refine/gram_fit.h"

namespace corral {
namespace {

constexpr int kFewestPairs = 6;       // as many as a pose has parts
constexpr std::size_t kShare = 4096;  // pairs that one thread sums at a time
constexpr int kMostInVain = 3;        // rounds of a level without a new lowest cost: pairs that change to and fro

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

/// The pairs of one pose and what the rest needs of them.
struct Pairing {
  Eigen::Index points = 0, pairs = 0;
  Gram gram = Gram::Zero();

  double overlap() const { return points > 0 ? static_cast<double>(pairs) / static_cast<double>(points) : 0; }
  double squares() const { return gram(12, 12); }  // pr^2
  double rms_pr() const { return pairs > 0 ? std::sqrt(squares() / static_cast<double>(pairs)) : 0; }
  double cost(double limit_pr) const {
    return (squares() + static_cast<double>(points - pairs) * limit_pr * limit_pr) / static_cast<double>(points);
  }
};

class SurfaceRefiner {
 public:
  SurfaceRefiner(const SurfacePair& surfaces, const SurfaceOptions& options)
      : surfaces_(surfaces),
        options_(options),
        unit_(surfaces.resolution),
        source_(surfaces.source(spatial_order(surfaces.source, surfaces.parallel), Eigen::all)) {
    const Eigen::VectorXd squares = surfaces.target_normals.rowwise().squaredNorm();
    for (const double square : squares) has_normal_.push_back(square > 0);
  }

  RefinedSurface run(const RigidTransform& start) {
    pose_ = start;
    const double last_limit_pr = options_.levels.back().limit_pr;
    take(options_.levels.front().step);
    const Pairing before = pair(last_limit_pr);
    result_.before = {before.overlap(), before.rms_pr()};
    for (const SurfaceLevel& level : options_.levels) {
      if (refine(level)) continue;
      finish(last_limit_pr);
      return result_;
    }
    result_.status = SurfaceStatus::Refined;
    const Pairing after = finish(last_limit_pr);
    if (!is_enough(after))
      result_.status = SurfaceStatus::TooLittleOverlap;
    else if (!(result_.condition <= options_.largest_condition))
      result_.status = SurfaceStatus::DegenerateGeometry;
    else
      result_.target_from_source = pose_;
    return result_;
  }

 private:
  bool is_enough(const Pairing& pairing) const {
    return pairing.pairs >= kFewestPairs && pairing.overlap() >= options_.least_overlap;
  }

  /// Every so manieth source point in spatial order.
  void take(int step) {
    if (step == taken_step_) return;
    taken_step_ = step;
    const Eigen::Index count = (source_.rows() + step - 1) / step;
    taken_ = source_(Eigen::seqN(0, count, step), Eigen::all);
    if (count == 0) return;
    taken_mean_ = taken_.colwise().mean().transpose();
    size_pr_ = std::sqrt((taken_.rowwise() - taken_mean_.transpose()).rowwise().squaredNorm().mean()) / unit_;
  }

  Pairing pair(double limit_pr) {
    return options_.residual == SurfaceResidual::PointToPlane ? pair_by<PlaneColumns>(limit_pr)
                                                              : pair_by<PointColumns>(limit_pr);
  }

  template <class Columns>
  Pairing pair_by(double limit_pr) {
    moved_.noalias() = taken_ * pose_.rotation.transpose();
    moved_.rowwise() += pose_.translation.transpose();
    pairs_ = &surfaces_.pair(moved_, limit_pr * unit_);
    centre_ = pose_.rotation * taken_mean_ + pose_.translation;
    Pairing pairing;
    pairing.points = taken_.rows();
    is_pair_.resize(pairs_->target_rows.size());
    for (std::size_t place = 0; place < is_pair_.size(); ++place) {
      const int row = pairs_->target_rows[place];
      is_pair_[place] = row >= 0 && has_normal_[static_cast<std::size_t>(row)];
      pairing.pairs += is_pair_[place] != 0;
    }
    pairing.gram = Columns::gram(sum_of_products<Columns>(pairs_->source, centre_, 1 / unit_));
    return pairing;
  }

  /// sum f f^T over the pairs, f their columns; m are some places about a centre, all is scaled.
  template <class Columns>
  auto sum_of_products(const AlignedColumn (&places)[3], const Eigen::Vector3d& centre, double scale) const {
    constexpr int kWidth = Columns::kWidth;
    using Sums = Eigen::Matrix<double, kWidth, kWidth>;
    std::vector<Sums> parts((is_pair_.size() + kShare - 1) / kShare);
    surfaces_.parallel(static_cast<int>(parts.size()), [&](int part) {
      const std::size_t begin = static_cast<std::size_t>(part) * kShare,
                        end = std::min(begin + kShare, is_pair_.size());
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

  template <class Lanes, bool kWithNormals>
  CORRAL_INLINE PairLanes<Lanes> eight_pairs(std::size_t first, const AlignedColumn (&places)[3],
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
    double normals[3][kLanes] = {};
    for (std::size_t i = 0; i < kLanes; ++i)
      for (int axis = 0; axis < 3; ++axis)
        if (is_pair_[first + i] != 0) normals[axis][i] = surfaces_.target_normals(pairs_->target_rows[first + i], axis);
    for (int axis = 0; axis < 3; ++axis) pairs.n[axis] = Lanes::load(normals[axis]);
    return pairs;
  }

  /// The last word on a pose: overlap, residual and condition over all points.
  Pairing finish(double limit_pr) {
    take(1);
    const Pairing after = pair(limit_pr);
    result_.after = {after.overlap(), after.rms_pr()};
    result_.condition = condition(after.pairs);
    return after;
  }

  /// Of the point-to-plane equations of the last pairs, taken at their target points.
  double condition(Eigen::Index count) const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    if (count < kFewestPairs) return kInfinity;
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
    const auto equations = sum_of_products<EquationColumns>(pairs_->target, mean, 1 / size);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> eigen(equations, Eigen::EigenvaluesOnly);
    const double least = eigen.eigenvalues()(0), most = eigen.eigenvalues()(5);
    return least > 0 ? most / least : kInfinity;
  }

  /// False, with the reason in the status, if there is nothing to go on with.
  bool refine(const SurfaceLevel& level) {
    take(level.step);
    result_.levels.emplace_back();
    double lowest = std::numeric_limits<double>::infinity();
    int in_vain = 0;
    for (int round = 0; round < level.most_rounds; ++round) {
      const Pairing pairing = pair(level.limit_pr);
      if (!is_enough(pairing)) {
        result_.status = SurfaceStatus::TooLittleOverlap;
        return false;
      }
      const double cost = pairing.cost(level.limit_pr);
      in_vain = cost < lowest ? 0 : in_vain + 1;
      lowest = std::min(lowest, cost);
      if (in_vain == kMostInVain) break;
      const auto fit = minimise(pairing.gram);
      if (!fit) {
        result_.status = SurfaceStatus::Diverged;
        return false;
      }
      result_.levels.back().push_back({pairing.overlap(), cost, fit->squares_before, fit->squares_after});
      pose_ = about_centre(fit->motion) * pose_;
      // No point turns farther than its distance from the centre times the norm of R - I.
      const double turn = (fit->motion.rotation - Eigen::Matrix3d::Identity()).norm();
      if (turn * size_pr_ + fit->motion.translation.norm() < options_.rest_pr) break;
    }
    return true;
  }

  /// A step in pr about the centre, as a motion in mesh units.
  RigidTransform about_centre(const RigidTransform& step) const {
    return {step.rotation, centre_ + unit_ * step.translation - step.rotation * centre_};
  }

  const SurfacePair& surfaces_;
  const SurfaceOptions& options_;
  double unit_;                   // mesh units per pr
  Points source_;                 // in spatial order
  std::vector<char> has_normal_;  // by target point
  RigidTransform pose_;
  const PointPairs* pairs_ = nullptr;  // of the last pose
  AlignedColumn is_pair_;              // 1 or 0 for each of them
  Points taken_, moved_;
  int taken_step_ = 0;
  Eigen::Vector3d taken_mean_ = Eigen::Vector3d::Zero();
  double size_pr_ = 0;                                // root mean square distance of the taken points from their mean
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();  // of the moved points, mesh units
  RefinedSurface result_;
};

void check(const SurfacePair& surfaces, const RigidTransform& start, const SurfaceOptions& options) {
  const std::string who = "refine_surface";
  require_positive(who, "resolution", surfaces.resolution);
  if (surfaces.target.rows() != surfaces.target_normals.rows())
    throw InvalidInput(who, "target_normals", static_cast<double>(surfaces.target_normals.rows()),
                       "one row per target point");
  if (!start.rotation.allFinite() || !start.translation.allFinite())
    throw InvalidInput(who, "start", "a value that is not finite", "a finite motion");
  if (options.levels.empty()) throw InvalidInput(who, "levels", "none", "at least one");
  for (const SurfaceLevel& level : options.levels) {
    require_positive(who, "limit_pr", level.limit_pr);
    if (level.step < 1) throw InvalidInput(who, "step", level.step, "at least 1");
    if (level.most_rounds < 1) throw InvalidInput(who, "most_rounds", level.most_rounds, "at least 1");
  }
  if (!(options.rest_pr >= 0)) throw InvalidInput(who, "rest_pr", options.rest_pr, "at least 0");
  if (!(options.least_overlap >= 0 && options.least_overlap <= 1))
    throw InvalidInput(who, "least_overlap", options.least_overlap, "0 to 1");
  require_positive(who, "largest_condition", options.largest_condition);
}

}  // namespace

const char* to_text(SurfaceStatus status) {
  switch (status) {
    case SurfaceStatus::Refined:
      return "refined";
    case SurfaceStatus::TooLittleOverlap:
      return "too little overlap";
    case SurfaceStatus::DegenerateGeometry:
      return "degenerate geometry";
    case SurfaceStatus::Diverged:
      break;
  }
  return "diverged";
}

RefinedSurface refine_surface(const SurfacePair& surfaces, const RigidTransform& start, const SurfaceOptions& options) {
  check(surfaces, start, options);
  return SurfaceRefiner(surfaces, options).run(start);
}

}  // namespace corral
