// SPDX-License-Identifier: MIT
#include "kernel/surface/keypoints.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "kernel/error.h"
#include "kernel/surface/normals.h"

namespace corral {
namespace {

constexpr double kSmallestResponse = 1e-9;

void check_length(const char* field, double value) {
  if (!(value > 0) || !std::isfinite(value))
    throw InvalidInput("detect_harris", field, value, "a finite length above zero");
}

bool is_maximum(const Eigen::VectorXd& response, int vertex, const std::vector<Neighbor>& neighborhood) {
  return std::none_of(neighborhood.begin(), neighborhood.end(), [&](const Neighbor& other) {
    return response(other.index) > response(vertex) ||
           (response(other.index) == response(vertex) && other.index < vertex);
  });
}

}  // namespace

Eigen::VectorXd harris_response(const Points& vertices, const std::vector<std::vector<Neighbor>>& neighborhoods) {
  Points normals(vertices.rows(), 3);
  for (Eigen::Index row = 0; row < vertices.rows(); ++row)
    normals.row(row) = plane_normal(vertices, neighborhoods[static_cast<std::size_t>(row)]).transpose();

  Eigen::VectorXd response = Eigen::VectorXd::Zero(vertices.rows());
  for (Eigen::Index row = 0; row < vertices.rows(); ++row) {
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    int count = 0;
    for (const Neighbor& neighbor : neighborhoods[static_cast<std::size_t>(row)]) {
      const Eigen::RowVector3d normal = normals.row(neighbor.index);
      if (normal.isZero(0)) continue;
      moments += normal.transpose() * normal;
      ++count;
    }
    if (count > 0) response(row) = (moments / count).determinant();
  }
  return response;
}

Keypoints detect_harris(const Mesh& mesh, const PointIndex& index, double resolution, const HarrisOptions& options) {
  check_length("resolution", resolution);
  check_length("radius_pr", options.radius_pr);
  check_length("support_radius_pr", options.support_radius_pr);

  std::vector<std::vector<Neighbor>> neighborhoods(static_cast<std::size_t>(mesh.vertices.rows()));
  for (Eigen::Index row = 0; row < mesh.vertices.rows(); ++row)
    neighborhoods[static_cast<std::size_t>(row)] =
        index.within(mesh.vertices.row(row).transpose(), options.radius_pr * resolution);
  const Eigen::VectorXd response = harris_response(mesh.vertices, neighborhoods);

  Keypoints keypoints;
  for (int vertex = 0; vertex < static_cast<int>(mesh.vertices.rows()); ++vertex) {
    if (!(response(vertex) >= kSmallestResponse)) continue;
    if (!is_maximum(response, vertex, neighborhoods[static_cast<std::size_t>(vertex)])) continue;
    ++keypoints.candidates;
    const auto support =
        index.within(mesh.vertices.row(vertex).transpose(), options.support_radius_pr * resolution).size();
    if (static_cast<int>(support) - 1 < options.minimum_support)
      ++keypoints.dropped_small_support;
    else
      keypoints.vertices.push_back(vertex);
  }
  return keypoints;
}

}  // namespace corral
