// SPDX-License-Identifier: MIT
#include "kernel/weighted_fit.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <cmath>

namespace corral {
namespace {

constexpr double kThinnestPr = 1e-3;

struct Moments {
  double weight = 0;
  int rows = 0;  ///< of positive weight
  Eigen::Vector3d source_mean = Eigen::Vector3d::Zero(), target_mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d source = Eigen::Matrix3d::Zero(), target = Eigen::Matrix3d::Zero(), cross = Eigen::Matrix3d::Zero();
};

Moments moments_of(const CorrespondenceSet& matches, const Indices& rows, const std::vector<double>& weights) {
  Moments m;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!(weights[i] > 0)) continue;
    ++m.rows;
    m.weight += weights[i];
    m.source_mean += weights[i] * matches.source_points.row(rows[i]).transpose();
    m.target_mean += weights[i] * matches.target_points.row(rows[i]).transpose();
  }
  m.source_mean /= m.weight;
  m.target_mean /= m.weight;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!(weights[i] > 0)) continue;
    const Eigen::Vector3d p = matches.source_points.row(rows[i]).transpose() - m.source_mean,
                          q = matches.target_points.row(rows[i]).transpose() - m.target_mean, weighted = weights[i] * p;
    m.source += weighted * p.transpose();
    m.target += (weights[i] * q) * q.transpose();
    m.cross += weighted * q.transpose();
  }
  return m;
}

/// The squared second singular value of the points behind this scatter is its second eigenvalue.
bool is_thin(const Eigen::Matrix3d& scatter, double weight, double resolution) {
  const double second =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter, Eigen::EigenvaluesOnly).eigenvalues()(1);
  return !(std::sqrt(second / weight) > kThinnestPr * resolution);
}

}  // namespace

std::optional<RigidTransform> fit_weighted(const CorrespondenceSet& matches, const Indices& rows,
                                           const std::vector<double>& weights) {
  const Moments m = moments_of(matches, rows, weights);
  if (m.rows < 3 || !m.cross.allFinite() || !m.source.allFinite() || !m.target.allFinite()) return std::nullopt;
  if (is_thin(m.source, m.weight, matches.resolution) || is_thin(m.target, m.weight, matches.resolution))
    return std::nullopt;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m.cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d v = svd.matrixV();
  if ((v * svd.matrixU().transpose()).determinant() < 0) v.col(2) = -v.col(2);  // the reflection case
  RigidTransform target_from_source;
  target_from_source.rotation = v * svd.matrixU().transpose();
  target_from_source.translation = m.target_mean - target_from_source.rotation * m.source_mean;
  return target_from_source;
}

}  // namespace corral
