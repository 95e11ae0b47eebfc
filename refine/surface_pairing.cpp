// SPDX-License-Identifier: MIT
#include "refine/surface_pairing.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>

#include "kernel/spatial_order.h"

namespace corral {
namespace {

constexpr std::size_t kShare = 4096;  // pairs that one thread sums at a time

/// The equations of point pairs, from what their three residuals share: r_axis = sum_j (R - I)(axis, j) m_j + t_axis + d_axis.
Gram gram_of_points(const Eigen::MatrixXd& sums) {
  Gram gram = Gram::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    for (int j = 0; j < 4; ++j) {
      for (int k = 0; k < 4; ++k) gram(3 * j + axis, 3 * k + axis) = sums(j, k);
      gram(3 * j + axis, 12) = gram(12, 3 * j + axis) = sums(j, 4 + axis);
    }
    gram(12, 12) += sums(4 + axis, 4 + axis);
  }
  return gram;
}

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
  agreement_.resize(is_pair_.size());
  agree({{taken_normals_[0].data(), taken_normals_[1].data(), taken_normals_[2].data()},
         {normals_[0].data(), normals_[1].data(), normals_[2].data()},
         agreement_.data(),
         is_pair_.data(),
         is_pair_.size()},
        pose.rotation, least_cosine_);
}

/// sum f f^T over the pairs, f their columns; m are some places about a centre, all is scaled.
Eigen::MatrixXd SurfacePairing::sum_of_products(PairProducts products, const AlignedColumn (&places)[3],
                                                const Eigen::Vector3d& centre, double scale) const {
  const PairColumns pairs{places, pairs_->source, pairs_->target, normals_, is_pair_.data(), centre, scale};
  std::vector<Eigen::MatrixXd> parts((is_pair_.size() + kShare - 1) / kShare);
  surfaces_.parallel(static_cast<int>(parts.size()), [&](int part) {
    const std::size_t begin = static_cast<std::size_t>(part) * kShare, end = std::min(begin + kShare, is_pair_.size());
    parts[static_cast<std::size_t>(part)] = add_products(products, pairs, begin, end);
  });
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(width_of(products), width_of(products));
  for (const Eigen::MatrixXd& part : parts) result += part;
  return result;
}

Gram SurfacePairing::plane_gram() const {
  return sum_of_products(PairProducts::OfPlanes, pairs_->source, centre_, 1 / unit_);
}

Gram SurfacePairing::point_gram() const {
  return gram_of_points(sum_of_products(PairProducts::OfPoints, pairs_->source, centre_, 1 / unit_));
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
  pairing.gram = by_planes ? plane_gram() : point_gram();
  return pairing;
}

Spread SurfacePairing::spread(const Pairing& last) const {
  const double all = point_gram()(12, 12), count = static_cast<double>(last.pairs);
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
  const Eigen::Matrix<double, 6, 6> equations =
      sum_of_products(PairProducts::OfEquations, pairs_->target, mean, 1 / size);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> eigen(equations, Eigen::EigenvaluesOnly);
  const double least = eigen.eigenvalues()(0), most = eigen.eigenvalues()(5);
  return least > 0 ? most / least : kInfinity;
}

}  // namespace corral
