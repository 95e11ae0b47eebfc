// SPDX-License-Identifier: MIT
#include "tests/support/reference/iss.h"

#include <Eigen/SVD>
#include <cmath>

namespace corral::testing {
namespace {

/// The vertices nearer to one of them than a radius, itself included.
Indices nearer_than(const Points& vertices, int row, double radius) {
  Indices found;
  for (int other = 0; other < vertices.rows(); ++other) {
    const Eigen::RowVector3d offset = vertices.row(other) - vertices.row(row);
    if (offset.x() * offset.x() + offset.y() * offset.y() + offset.z() * offset.z() < radius * radius)
      found.push_back(other);
  }
  return found;
}

/// Descending.
Eigen::Vector3d eigenvalues(const Points& vertices, int row, const Indices& neighbors, const Eigen::VectorXd& weights,
                            double total) {
  Eigen::Matrix3Xd offsets(3, static_cast<Eigen::Index>(std::max<std::size_t>(neighbors.size(), 3)));
  offsets.setZero();
  for (std::size_t i = 0; i < neighbors.size(); ++i)
    offsets.col(static_cast<Eigen::Index>(i)) =
        std::sqrt(weights(neighbors[i]) / total) * (vertices.row(neighbors[i]) - vertices.row(row)).transpose();
  return Eigen::JacobiSVD<Eigen::Matrix3Xd>(offsets).singularValues().cwiseAbs2();
}

}  // namespace

Eigen::VectorXd reference_iss_saliency(const Points& vertices, double resolution, const IssOptions& options) {
  const auto count = static_cast<int>(vertices.rows());
  const bool weighted = options.weights == IssWeights::Density;
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(count), saliency = Eigen::VectorXd::Zero(count);
  for (int row = 0; row < count && weighted; ++row)
    weights(row) /= static_cast<double>(nearer_than(vertices, row, options.density_radius_pr * resolution).size());
  for (int row = 0; row < count; ++row) {
    const Indices neighbors = nearer_than(vertices, row, options.salient_radius_pr * resolution);
    if (static_cast<int>(neighbors.size()) < options.minimum_neighbors) continue;
    double total = 0;
    for (const int neighbor : neighbors) total += weights(neighbor);
    const Eigen::Vector3d e = eigenvalues(vertices, row, neighbors, weights, weighted ? total : 1);
    if (e(1) / e(0) < options.gamma_21 && e(2) / e(1) < options.gamma_32 && e(2) > 1e-9 * e(0)) saliency(row) = e(2);
  }
  return saliency;
}

Keypoints reference_iss(const Points& vertices, double resolution, const IssOptions& options) {
  const Eigen::VectorXd saliency = reference_iss_saliency(vertices, resolution, options);
  Keypoints keypoints;
  for (int row = 0; row < vertices.rows(); ++row) {
    if (!(saliency(row) > 0)) continue;
    const Indices around = nearer_than(vertices, row, options.non_max_radius_pr * resolution);
    bool largest = true;
    for (const int other : around)
      if (saliency(other) > saliency(row) || (saliency(other) == saliency(row) && other < row)) largest = false;
    keypoints.candidates += largest;
    if (largest && static_cast<int>(around.size()) >= options.minimum_neighbors) keypoints.vertices.push_back(row);
  }
  return keypoints;
}

}  // namespace corral::testing
