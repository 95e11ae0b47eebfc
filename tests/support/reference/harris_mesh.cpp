// SPDX-License-Identifier: MIT
#include "tests/support/reference/harris_mesh.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace corral::testing {
namespace {

using Set = std::set<int>;

Eigen::Vector3d place(const Mesh& mesh, int vertex) { return mesh.vertices.row(vertex).transpose(); }

double diagonal(const Mesh& mesh) {
  Eigen::Vector3d low = place(mesh, 0), high = low;
  for (int vertex = 0; vertex < mesh.vertices.rows(); ++vertex) {
    low = low.cwiseMin(place(mesh, vertex));
    high = high.cwiseMax(place(mesh, vertex));
  }
  return std::sqrt((high - low).dot(high - low));
}

std::vector<Set> joined(const Mesh& mesh) {
  std::vector<Set> neighbors(static_cast<std::size_t>(mesh.vertices.rows()));
  for (int face = 0; face < mesh.triangles.rows(); ++face)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (i != j) neighbors[static_cast<std::size_t>(mesh.triangles(face, i))].insert(mesh.triangles(face, j));
  return neighbors;
}

/// The first ring around a vertex, the second, and so on until one ends the list by its number or its longest path.
Set grown(const Mesh& mesh, const std::vector<Set>& neighbors, int vertex, int rings, double longest_path) {
  Set all{vertex};
  std::map<int, double> ring{{vertex, 0.0}};
  for (int number = 1; number <= rings && !ring.empty(); ++number) {
    std::map<int, double> next;
    for (const auto& [here, path] : ring)
      for (const int other : neighbors[static_cast<std::size_t>(here)]) {
        if (all.count(other)) continue;
        const double longer = path + (place(mesh, here) - place(mesh, other)).norm();
        const auto [entry, is_new] = next.try_emplace(other, longer);
        if (!is_new && longer < entry->second) entry->second = longer;
      }
    double longest = 0;
    for (const auto& [other, path] : next) {
      all.insert(other);
      longest = std::max(longest, path);
    }
    if (longest > longest_path) break;
    ring = next;
  }
  return all;
}

Set neighborhood_of(const Mesh& mesh, const std::vector<Set>& neighbors, int vertex, double resolution,
                    const HarrisMeshOptions& options) {
  if (options.neighborhood == MeshNeighborhood::Rings) return grown(mesh, neighbors, vertex, options.rings, INFINITY);
  if (options.neighborhood == MeshNeighborhood::Adaptive)
    return grown(mesh, neighbors, vertex, 1 << 30, options.extent * diagonal(mesh));
  Set ball;
  for (int other = 0; other < mesh.vertices.rows(); ++other)
    if ((place(mesh, other) - place(mesh, vertex)).norm() <= options.radius_pr * resolution) ball.insert(other);
  return ball;
}

/// p1 .. p5 of the patch around a vertex; empty if there is none.
Eigen::VectorXd fitted(const Mesh& mesh, int vertex, const Set& neighborhood) {
  const auto count = static_cast<Eigen::Index>(neighborhood.size());
  if (count < 6) return {};
  Eigen::MatrixXd rows(count, 3);
  Eigen::Index row = 0;
  double reach = 0;
  for (const int other : neighborhood) {
    rows.row(row++) = place(mesh, other).transpose();
    reach = std::max(reach, (place(mesh, other) - place(mesh, vertex)).norm());
  }
  const Eigen::RowVector3d centroid = rows.colwise().mean();
  rows.rowwise() -= centroid;
  const Eigen::JacobiSVD<Eigen::MatrixXd> axes(rows, Eigen::ComputeFullV);
  const Eigen::Vector3d variances = axes.singularValues().array().square();
  if (!(variances(1) - variances(2) > 1e-12 * variances(0))) return {};
  rows = (rows * axes.matrixV()).eval();
  const Eigen::RowVector3d self = (place(mesh, vertex).transpose() - centroid) * axes.matrixV();
  rows.leftCols(2).rowwise() -= self.head(2);
  rows /= reach;

  Eigen::MatrixXd design(count, 6);
  for (row = 0; row < count; ++row) {
    const double x = rows(row, 0), y = rows(row, 1);
    design.row(row) << 0.5 * x * x, x * y, 0.5 * y * y, x, y, 1.0;
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(design, Eigen::ComputeThinU | Eigen::ComputeThinV);
  if (!(svd.singularValues()(5) > 1e-10 * svd.singularValues()(0))) return {};
  return svd.solve(rows.col(2)).head(5);
}

/// Mean of grad f grad f^T under a Gaussian of variance 2. The products are quadratic in x and in y, so the mean over the
/// four places one deviation out along both axes is the integral (Gauss and Hermite's rule of two nodes).
Eigen::Matrix2d weighted_products(const Eigen::VectorXd& p) {
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (const double x : {-std::sqrt(2.0), std::sqrt(2.0)})
    for (const double y : {-std::sqrt(2.0), std::sqrt(2.0)}) {
      const Eigen::Vector2d gradient(p(0) * x + p(1) * y + p(3), p(1) * x + p(2) * y + p(4));
      sum += gradient * gradient.transpose();
    }
  return sum / 4;
}

}  // namespace

Eigen::VectorXd reference_harris_mesh_response(const Mesh& mesh, double resolution, const HarrisMeshOptions& options) {
  const std::vector<Set> neighbors = joined(mesh);
  Eigen::VectorXd response = Eigen::VectorXd::Constant(mesh.vertices.rows(), NAN);
  for (int vertex = 0; vertex < mesh.vertices.rows(); ++vertex) {
    if (neighbors[static_cast<std::size_t>(vertex)].empty()) continue;
    const Eigen::VectorXd patch = fitted(mesh, vertex, neighborhood_of(mesh, neighbors, vertex, resolution, options));
    if (patch.size() == 0) continue;
    const Eigen::Matrix2d products = weighted_products(patch);
    response(vertex) = products.determinant() - options.k * std::pow(products.trace(), 2);
  }
  return response;
}

Keypoints reference_harris_mesh(const Mesh& mesh, double resolution, const HarrisMeshOptions& options) {
  const Eigen::VectorXd response = reference_harris_mesh_response(mesh, resolution, options);
  const std::vector<Set> neighbors = joined(mesh);
  std::vector<std::pair<double, int>> candidates;  // response turned round, so that the best come first
  for (int vertex = 0; vertex < mesh.vertices.rows(); ++vertex) {
    bool largest = response(vertex) >= 1e-20;
    for (const int other : neighbors[static_cast<std::size_t>(vertex)])
      if (response(other) > response(vertex) || (response(other) == response(vertex) && other < vertex))
        largest = false;
    if (largest) candidates.emplace_back(-response(vertex), vertex);
  }
  std::sort(candidates.begin(), candidates.end());

  Keypoints keypoints;
  keypoints.candidates = static_cast<int>(candidates.size());
  const double wanted = std::round(options.fraction * static_cast<double>(mesh.vertices.rows()));
  for (const auto& [turned, vertex] : candidates) {
    bool taken = true;
    if (options.selection == MeshSelection::Fraction) taken = static_cast<double>(keypoints.vertices.size()) < wanted;
    if (options.selection == MeshSelection::Clustering)
      for (const int kept : keypoints.vertices)
        if (!((place(mesh, kept) - place(mesh, vertex)).norm() > options.separation * diagonal(mesh))) taken = false;
    if (taken) keypoints.vertices.push_back(vertex);
  }
  std::sort(keypoints.vertices.begin(), keypoints.vertices.end());
  return keypoints;
}

}  // namespace corral::testing
