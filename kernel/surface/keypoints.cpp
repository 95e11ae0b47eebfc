// SPDX-License-Identifier: MIT
#include "kernel/surface/keypoints.h"

#include <Eigen/LU>
#include <algorithm>

#include "kernel/error.h"
#include "kernel/number_text.h"
#include "kernel/surface/normals.h"

namespace corral {
namespace {

constexpr double kSmallestResponse = 1e-9;
constexpr std::size_t kLargestMeanNeighborhood = 500;
constexpr std::size_t kAlwaysAccepted = 20000000;  // neighbours in all, 320 MB

/// The vertices within `radius` of each vertex. Refuses a radius that holds so many that it cannot be meant.
std::vector<std::vector<Neighbor>> collect_neighborhoods(const Points& vertices, const PointIndex& index,
                                                         double radius) {
  std::vector<std::vector<Neighbor>> neighborhoods;
  std::size_t total = 0;
  const auto most = std::max(kAlwaysAccepted, kLargestMeanNeighborhood * static_cast<std::size_t>(vertices.rows()));
  for (Eigen::Index row = 0; row < vertices.rows(); ++row) {
    neighborhoods.push_back(index.within(vertices.row(row).transpose(), radius));
    total += neighborhoods.back().size();
    if (total > most)
      throw InvalidInput("detect_harris", "keypoint radius",
                         to_text(radius) + " mesh units, which holds over " + std::to_string(kLargestMeanNeighborhood) +
                             " vertices on average",
                         "a radius that holds about 30 (is the resolution in the unit of this mesh, or do many "
                         "vertices share one place?)");
  }
  return neighborhoods;
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
  require_positive("detect_harris", "resolution", resolution);
  require_positive("detect_harris", "radius_pr", options.radius_pr);
  require_positive("detect_harris", "support_radius_pr", options.support_radius_pr);

  const auto neighborhoods = collect_neighborhoods(mesh.vertices, index, options.radius_pr * resolution);
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
