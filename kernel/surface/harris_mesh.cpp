// SPDX-License-Identifier: MIT
#include "kernel/surface/harris_mesh.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/bounding_box.h"
#include "kernel/error.h"
#include "kernel/surface/mesh/topology.h"
#include "kernel/surface/surroundings.h"

namespace corral {
namespace {

constexpr char kWho[] = "detect_harris_mesh";
constexpr double kVariance = 2;              // sigma^2 of the Gaussian weight, squared reaches of the neighbourhood
constexpr double kSmallestResponse = 1e-20;  // a radius of curvature of 1e5 reaches
constexpr double kSmallestPivot = 1e-10;     // of the largest: below it the quadratic is open
constexpr double kSmallestGap = 1e-12;       // between variances, of the largest: below it no direction is the least
constexpr std::size_t kFewestPoints = 6;
constexpr std::size_t kLargestMeanNeighborhood = 2000;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::size_t at(int index) { return static_cast<std::size_t>(index); }

/// Columns x, y, z: the axes of the places, z the direction of least variance; zero if no direction is the least.
Eigen::Matrix3d axes_of(const std::vector<Eigen::Vector3d>& places) {
  const auto count = static_cast<double>(places.size());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& place : places) sum += place;
  const Eigen::Vector3d centroid = sum / count;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& place : places) covariance += (place - centroid) * (place - centroid).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance / (count - 1));
  const Eigen::Vector3d& variances = solver.eigenvalues();
  if (!(variances(1) - variances(0) > kSmallestGap * variances(2))) return Eigen::Matrix3d::Zero();
  return solver.eigenvectors().rowwise().reverse();
}

/// The response for the places around a vertex at the origin, which are scaled; NaN if there is none.
double response_of(std::vector<Eigen::Vector3d>& places, double k) {
  if (places.size() < kFewestPoints) return kNone;
  double squared_reach = 0;
  for (const Eigen::Vector3d& place : places) squared_reach = std::max(squared_reach, place.squaredNorm());
  if (!(squared_reach > 0)) return kNone;
  for (Eigen::Vector3d& place : places) place /= std::sqrt(squared_reach);
  const Eigen::Matrix3d axes = axes_of(places);
  if (axes.isZero(0)) return kNone;

  // The shift of z to the centroid only moves p6, which the response does not read.
  Eigen::Matrix<double, Eigen::Dynamic, 6> design(static_cast<Eigen::Index>(places.size()), 6);
  Eigen::VectorXd heights(design.rows());
  for (Eigen::Index row = 0; row < design.rows(); ++row) {
    const Eigen::Vector3d local = axes.transpose() * places[static_cast<std::size_t>(row)];
    const double x = local.x(), y = local.y();
    design.row(row) << x * x / 2, x * y, y * y / 2, x, y, 1;
    heights(row) = local.z();
  }
  // Pivoted QR rather than the normal equations: they would square the condition of narrow neighbourhoods, and the pivots
  // say whether the quadratic is determined at all.
  Eigen::ColPivHouseholderQR<Eigen::Matrix<double, Eigen::Dynamic, 6>> solver(design);
  solver.setThreshold(kSmallestPivot);
  if (solver.rank() < 6) return kNone;
  const Eigen::Matrix<double, 6, 1> fit = solver.solve(heights);
  const double p1 = fit(0), p2 = fit(1), p3 = fit(2), p4 = fit(3), p5 = fit(4);
  const double a = p4 * p4 + kVariance * (p1 * p1 + p2 * p2);
  const double b = p5 * p5 + kVariance * (p2 * p2 + p3 * p3);
  const double c = p4 * p5 + kVariance * (p1 * p2 + p2 * p3);
  return a * b - c * c - k * (a + b) * (a + b);
}

void check(const Mesh& mesh, const HarrisMeshOptions& options) {
  validate_options(options, kWho);
  if (mesh.triangles.rows() == 0)
    throw InvalidInput(kWho, "number of faces", "0",
                       "at least 1: harris-mesh needs the faces of a mesh (the default detector takes a point cloud)");
  mesh.validate(kWho);
}

Eigen::VectorXd response_along(const Mesh& mesh, const std::vector<Indices>& rings, double resolution,
                               const HarrisMeshOptions& options) {
  Reach reach;
  switch (options.neighborhood) {
    case MeshNeighborhood::Ball:
      reach.ball_radius = options.radius_pr * resolution;
      break;
    case MeshNeighborhood::Rings:
      reach.most_rings = options.rings;
      break;
    case MeshNeighborhood::Adaptive:
      reach.longest_path = options.extent * bounding_box(mesh.vertices).diagonal();
      break;
  }
  Surroundings surroundings(mesh, rings, reach);
  Eigen::VectorXd response = Eigen::VectorXd::Constant(mesh.vertices.rows(), kNone);
  std::size_t total = 0;
  for (int vertex = 0; vertex < static_cast<int>(rings.size()); ++vertex) {
    if (rings[at(vertex)].empty()) continue;
    std::vector<Eigen::Vector3d>& places = surroundings.around(vertex);
    total += places.size();
    if (total > kLargestMeanNeighborhood * rings.size())
      throw InvalidInput(
          kWho, "neighborhood",
          choice_text(options.neighborhood) + " of over " + std::to_string(kLargestMeanNeighborhood) +
              " vertices on average",
          "a smaller one: about 30 are usual (is the resolution in the unit of this mesh, and does no far outlier "
          "widen its bounding box?)");
    response(vertex) = response_of(places, options.k);
  }
  return response;
}

bool is_candidate(const Eigen::VectorXd& response, const Indices& ring, int vertex) {
  if (!(response(vertex) >= kSmallestResponse)) return false;
  return std::none_of(ring.begin(), ring.end(), [&](int other) {
    return response(other) > response(vertex) || (response(other) == response(vertex) && other < vertex);
  });
}

/// The candidates, given best first, that are not within `radius` of a better one that is kept.
Indices spread(const Points& vertices, const Indices& candidates, double radius) {
  const PointIndex index(vertices(candidates, Eigen::all));
  std::vector<char> dropped(candidates.size(), 0);
  Indices kept;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (dropped[i]) continue;
    kept.push_back(candidates[i]);
    for (const Neighbor& near : index.within(vertices.row(candidates[i]).transpose(), radius))
      dropped[at(near.index)] = 1;
  }
  return kept;
}

Keypoints select_along(const Mesh& mesh, const std::vector<Indices>& rings, const Eigen::VectorXd& response,
                       const HarrisMeshOptions& options) {
  Keypoints keypoints;
  Indices& chosen = keypoints.vertices;
  for (int vertex = 0; vertex < static_cast<int>(rings.size()); ++vertex)
    if (is_candidate(response, rings[at(vertex)], vertex)) chosen.push_back(vertex);
  keypoints.candidates = static_cast<int>(chosen.size());

  std::stable_sort(chosen.begin(), chosen.end(), [&](int a, int b) { return response(a) > response(b); });
  if (options.selection == MeshSelection::Clustering) {
    chosen = spread(mesh.vertices, chosen, options.separation * bounding_box(mesh.vertices).diagonal());
  } else {
    const auto wanted = std::llround(options.fraction * static_cast<double>(rings.size()));
    chosen.resize(std::min(chosen.size(), static_cast<std::size_t>(wanted)));
  }
  std::sort(chosen.begin(), chosen.end());
  return keypoints;
}

}  // namespace

Eigen::VectorXd harris_mesh_response(const Mesh& mesh, double resolution, const HarrisMeshOptions& options) {
  require_positive(kWho, "resolution", resolution);
  check(mesh, options);
  return response_along(mesh, vertex_rings(mesh), resolution, options);
}

Keypoints select_harris_mesh(const Mesh& mesh, const Eigen::VectorXd& response, const HarrisMeshOptions& options) {
  check(mesh, options);
  if (response.size() != mesh.vertices.rows())
    throw InvalidInput(kWho, "number of responses", std::to_string(response.size()),
                       "one for each of " + std::to_string(mesh.vertices.rows()) + " vertices");
  return select_along(mesh, vertex_rings(mesh), response, options);
}

Keypoints detect_harris_mesh(const Mesh& mesh, double resolution, const HarrisMeshOptions& options) {
  require_positive(kWho, "resolution", resolution);
  check(mesh, options);
  const std::vector<Indices> rings = vertex_rings(mesh);
  return select_along(mesh, rings, response_along(mesh, rings, resolution, options), options);
}

}  // namespace corral
