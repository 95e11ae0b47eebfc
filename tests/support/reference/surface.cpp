// SPDX-License-Identifier: MIT
#include "tests/support/reference/surface.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace corral::testing {
namespace {

Eigen::Vector3d row_of(const Points& points, int row) { return points.row(row).transpose(); }

/// Summed in the order of the axes, so that equal sums are equal to the last bit.
double squared_distance(const Points& points, int row, const Eigen::Vector3d& to) {
  const double x = points(row, 0) - to.x(), y = points(row, 1) - to.y(), z = points(row, 2) - to.z();
  return x * x + y * y + z * z;
}

/// Right singular vectors of the rows, the largest singular value first; all zero if fewer than two are above zero.
Eigen::Matrix3d principal_axes(const Eigen::MatrixXd& rows) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows, Eigen::ComputeFullV);
  const Eigen::VectorXd& values = svd.singularValues();
  if (values.size() < 2 || !(values(1) > 1e-7 * values(0))) return Eigen::Matrix3d::Zero();
  return svd.matrixV();
}

}  // namespace

std::vector<Neighbor> reference_within(const Points& points, const Eigen::Vector3d& center, double radius) {
  std::vector<Neighbor> found;
  for (int row = 0; row < points.rows(); ++row) {
    const double squared = squared_distance(points, row, center);
    if (squared <= radius * radius) found.push_back({row, squared});
  }
  return found;
}

std::vector<Neighbor> reference_nearest(const Points& points, const Eigen::Vector3d& query, int count) {
  std::vector<Neighbor> all;
  for (int row = 0; row < points.rows(); ++row) all.push_back({row, squared_distance(points, row, query)});
  std::stable_sort(all.begin(), all.end(),
                   [](const Neighbor& a, const Neighbor& b) { return a.squared_distance < b.squared_distance; });
  if (all.size() > static_cast<std::size_t>(count)) all.resize(static_cast<std::size_t>(count));
  return all;
}

Indices reference_nearest_rows(const Points& points, const Points& queries, double limit) {
  Indices nearest;
  for (Eigen::Index i = 0; i < queries.rows(); ++i) {
    int best = -1;
    double least = std::numeric_limits<double>::infinity();
    for (Eigen::Index row = 0; row < points.rows(); ++row) {
      const double x = queries(i, 0) - points(row, 0), y = queries(i, 1) - points(row, 1),
                   z = queries(i, 2) - points(row, 2), squared = x * x + y * y + z * z;
      if (!(squared <= limit * limit) || !(squared < least)) continue;
      least = squared;
      best = static_cast<int>(row);
    }
    nearest.push_back(best);
  }
  return nearest;
}

double reference_resolution(const Points& points) {
  std::vector<Eigen::Vector3d> distinct;
  for (int row = 0; row < points.rows(); ++row)
    if (std::find(distinct.begin(), distinct.end(), row_of(points, row)) == distinct.end())
      distinct.push_back(row_of(points, row));
  double sum = 0;
  for (std::size_t i = 0; i < distinct.size(); ++i) {
    double nearest = INFINITY;
    for (std::size_t j = 0; j < distinct.size(); ++j)
      if (j != i) nearest = std::min(nearest, (distinct[i] - distinct[j]).norm());
    sum += nearest;
  }
  return sum / static_cast<double>(distinct.size());
}

PointSpacing reference_spacing(const Points& points) {
  std::vector<Eigen::Vector3d> places;
  for (int row = 0; row < points.rows(); ++row)
    if (std::find(places.begin(), places.end(), row_of(points, row)) == places.end())
      places.push_back(row_of(points, row));
  const auto distance = [&](std::size_t i, std::size_t j) { return (places[i] - places[j]).norm(); };
  std::vector<double> nearest(places.size(), INFINITY);
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t j = 0; j < places.size(); ++j)
      if (j != i) nearest[i] = std::min(nearest[i], distance(i, j));
  std::vector<double> sorted = nearest;
  std::sort(sorted.begin(), sorted.end());
  PointSpacing spacing;
  spacing.resolution = reference_resolution(points);
  spacing.median = sorted[sorted.size() / 2];
  const double limit = 20 * spacing.median;
  std::vector<std::size_t> part(places.size());  // the first place that steps within the limit lead to
  std::iota(part.begin(), part.end(), 0U);
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (distance(i, j) <= limit && part[i] != part[j])
        std::replace(part.begin(), part.end(), std::max(part[i], part[j]), std::min(part[i], part[j]));
  const auto size = [&](std::size_t i) { return std::count(part.begin(), part.end(), part[i]); };
  const auto are_few = [&](std::ptrdiff_t strays) { return 50 * strays <= static_cast<std::ptrdiff_t>(places.size()); };
  std::ptrdiff_t together = 0;
  for (std::size_t i = 0; i < places.size(); ++i) together += size(i) <= 3;
  const auto is_stray = [&](std::size_t i) { return size(i) == 1 || (are_few(together) && size(i) <= 3); };
  double sum = 0;
  std::ptrdiff_t others = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    double outside = INFINITY;
    for (std::size_t j = 0; j < places.size(); ++j)
      if (part[j] != part[i]) outside = std::min(outside, distance(i, j));
    if (is_stray(i))
      spacing.stray_distance = std::max(spacing.stray_distance, outside);
    else
      sum += nearest[i], ++others;
  }
  for (int row = 0; row < points.rows(); ++row)
    if (is_stray(
            static_cast<std::size_t>(std::find(places.begin(), places.end(), row_of(points, row)) - places.begin())))
      spacing.strays.push_back(row);
  const std::ptrdiff_t strays = static_cast<std::ptrdiff_t>(places.size()) - others;
  spacing.without_strays = are_few(strays) ? sum / static_cast<double>(others) : spacing.resolution;
  return spacing;
}

Eigen::Vector3d reference_plane_normal(const Points& points, const std::vector<Neighbor>& rows) {
  if (rows.size() < 3) return Eigen::Vector3d::Zero();
  Eigen::MatrixXd chosen(static_cast<Eigen::Index>(rows.size()), 3);
  for (std::size_t i = 0; i < rows.size(); ++i) chosen.row(static_cast<Eigen::Index>(i)) = points.row(rows[i].index);
  const Eigen::RowVector3d first = chosen.row(0);
  chosen.rowwise() -= first;
  const Eigen::RowVector3d mean = chosen.colwise().mean();
  chosen.rowwise() -= mean;
  return principal_axes(chosen).col(2);
}

Points reference_normals(const Mesh& mesh, int k) {
  Points side = Points::Zero(mesh.vertices.rows(), 3);
  std::vector<bool> has_face(static_cast<std::size_t>(mesh.vertices.rows()), false);
  for (int face = 0; face < mesh.triangles.rows(); ++face) {
    const Eigen::Vector3d a = row_of(mesh.vertices, mesh.triangles(face, 0));
    const Eigen::Vector3d b = row_of(mesh.vertices, mesh.triangles(face, 1));
    const Eigen::Vector3d c = row_of(mesh.vertices, mesh.triangles(face, 2));
    for (int corner = 0; corner < 3; ++corner) {
      side.row(mesh.triangles(face, corner)) += (b - a).cross(c - a).transpose() / 2;
      has_face[static_cast<std::size_t>(mesh.triangles(face, corner))] = true;
    }
  }
  Points normals(mesh.vertices.rows(), 3);
  for (int row = 0; row < mesh.vertices.rows(); ++row) {
    const Eigen::Vector3d here = row_of(mesh.vertices, row);
    const Eigen::Vector3d normal = reference_plane_normal(mesh.vertices, reference_nearest(mesh.vertices, here, k));
    const Eigen::Vector3d towards =
        has_face[static_cast<std::size_t>(row)] ? row_of(side, row) : Eigen::Vector3d(-here);
    normals.row(row) = (normal.dot(towards) < 0 ? -normal : normal).transpose();
  }
  return normals;
}

Eigen::VectorXd reference_harris_response(const Points& vertices, double radius) {
  Points normals(vertices.rows(), 3);
  for (int row = 0; row < vertices.rows(); ++row)
    normals.row(row) =
        reference_plane_normal(vertices, reference_within(vertices, row_of(vertices, row), radius)).transpose();
  Eigen::VectorXd response = Eigen::VectorXd::Zero(vertices.rows());
  for (int row = 0; row < vertices.rows(); ++row) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    int count = 0;
    for (const Neighbor& neighbor : reference_within(vertices, row_of(vertices, row), radius)) {
      const Eigen::Vector3d normal = row_of(normals, neighbor.index);
      if (normal.isZero(0)) continue;
      sum += normal * normal.transpose();
      ++count;
    }
    if (count == 0) continue;
    const Eigen::Matrix3d mean = sum / count;
    response(row) = mean.row(0).dot(mean.row(1).cross(mean.row(2)));
  }
  return response;
}

Keypoints reference_harris(const Points& vertices, double resolution, const HarrisOptions& options) {
  const double radius = options.radius_pr * resolution;
  const Eigen::VectorXd response = reference_harris_response(vertices, radius);
  Keypoints keypoints;
  for (int row = 0; row < vertices.rows(); ++row) {
    if (!(response(row) >= 1e-9)) continue;
    bool largest = true;
    for (const Neighbor& other : reference_within(vertices, row_of(vertices, row), radius))
      if (response(other.index) > response(row) || (response(other.index) == response(row) && other.index < row))
        largest = false;
    if (!largest) continue;
    ++keypoints.candidates;
    keypoints.vertices.push_back(row);
  }
  return keypoints;
}

}  // namespace corral::testing
