// SPDX-License-Identifier: MIT
#include "tests/support/reference_surface.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace corral::testing {
namespace {

constexpr double kPi = 3.14159265358979323846;

double degrees(double radians) { return radians * 180 / kPi; }

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

/// The axis, or its opposite, on whose side more of the neighbours lie. `away` is sorted by distance.
Eigen::Vector3d turned_to_the_majority(const Eigen::Vector3d& axis, const std::vector<Eigen::Vector3d>& away) {
  const int count = static_cast<int>(away.size());
  int in_front = 0;
  for (const Eigen::Vector3d& offset : away)
    if (offset.dot(axis) >= 0) ++in_front;
  if (2 * in_front < count) return -axis;
  if (2 * in_front > count) return axis;
  int middle_in_front = 0;
  for (int i = count / 2 - 2; i <= count / 2 + 2; ++i)
    if (away[static_cast<std::size_t>(i)].dot(axis) > 0) ++middle_in_front;
  return middle_in_front < 3 ? Eigen::Vector3d(-axis) : axis;
}

/// One of the 32 volumes of the SHOT grid: a sector of azimuth, a half of elevation, a shell of radius.
struct Volume {
  int azimuth, elevation, shell;
};

Eigen::Index bin_of(const Volume& volume, int cosine) {
  return ((volume.azimuth * 2 + volume.elevation) * 2 + volume.shell) * 11 + cosine;
}

struct Local {
  double distance, elevation_deg, azimuth_deg;
};

Local spherical(const Eigen::Vector3d& local) {
  const double distance = local.norm();
  return {distance, degrees(std::acos(std::clamp(local.z() / distance, -1.0, 1.0))),
          degrees(std::atan2(local.y(), local.x()))};
}

void add_neighbor(const Local& at, bool above, double cosine, double radius, Eigen::VectorXd& histogram) {
  Volume home{0, above ? 0 : 1, at.distance <= radius / 2 ? 0 : 1};
  double azimuth_delta = 0;
  for (int sector = 0; sector < 8; ++sector) {
    const double from_centre = (at.azimuth_deg - (-157.5 + 45.0 * sector)) / 45;
    if (sector == 0 || std::abs(from_centre) < std::abs(azimuth_delta)) {
      azimuth_delta = from_centre;
      home.azimuth = sector;
    }
  }
  const double position = 10 * (1 + std::clamp(cosine, -1.0, 1.0)) / 2;
  const int step = static_cast<int>(std::lround(position));
  double main = 0;

  const double cosine_delta = position - step;
  if (cosine_delta > 0) histogram(bin_of(home, std::min(step + 1, 10))) += cosine_delta;
  if (cosine_delta < 0) histogram(bin_of(home, std::max(step - 1, 0))) -= cosine_delta;
  main += 1 - std::abs(cosine_delta);

  const double shell_centre = home.shell == 0 ? radius / 4 : 3 * radius / 4;
  const double shell_delta = (at.distance - shell_centre) / (radius / 2);
  if (home.shell == 0 && shell_delta > 0) histogram(bin_of({home.azimuth, home.elevation, 1}, step)) += shell_delta;
  if (home.shell == 1 && shell_delta < 0) histogram(bin_of({home.azimuth, home.elevation, 0}, step)) -= shell_delta;
  main += 1 - std::abs(shell_delta);

  const double half_centre = above ? 45 : 135;
  const double half_delta = (at.elevation_deg - half_centre) / 90;
  if (above && half_delta > 0) histogram(bin_of({home.azimuth, 1, home.shell}, step)) += half_delta;
  if (!above && half_delta < 0) histogram(bin_of({home.azimuth, 0, home.shell}, step)) -= half_delta;
  main += 1 - std::abs(half_delta);

  const int aside = (home.azimuth + (azimuth_delta > 0 ? 1 : 7)) % 8;
  histogram(bin_of({aside, home.elevation, home.shell}, step)) += std::abs(azimuth_delta);
  main += 1 - std::abs(azimuth_delta);

  histogram(bin_of(home, step)) += main;
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
    const auto support = reference_within(vertices, row_of(vertices, row), options.support_radius_pr * resolution);
    if (static_cast<int>(support.size()) - 1 < options.minimum_support)
      ++keypoints.dropped_small_support;
    else
      keypoints.vertices.push_back(row);
  }
  return keypoints;
}

std::optional<LocalReferenceFrame> reference_shot_frame(const Points& vertices, const Eigen::Vector3d& point,
                                                        double radius) {
  std::vector<Eigen::Vector3d> away;
  for (const Neighbor& neighbor : reference_nearest(vertices, point, static_cast<int>(vertices.rows()))) {
    const Eigen::Vector3d offset = row_of(vertices, neighbor.index) - point;
    if (offset.norm() > 0 && offset.norm() <= radius) away.push_back(offset);
  }
  if (away.size() < 5) return std::nullopt;
  Eigen::MatrixXd weighted(static_cast<Eigen::Index>(away.size()), 3);
  for (std::size_t i = 0; i < away.size(); ++i)
    weighted.row(static_cast<Eigen::Index>(i)) = std::sqrt(radius - away[i].norm()) * away[i].transpose();
  const Eigen::Matrix3d axes = Eigen::JacobiSVD<Eigen::MatrixXd>(weighted, Eigen::ComputeFullV).matrixV();
  const Eigen::Vector3d x = turned_to_the_majority(axes.col(0), away);
  const Eigen::Vector3d z = turned_to_the_majority(axes.col(2), away);
  LocalReferenceFrame frame;
  frame << x.transpose(), z.cross(x).transpose(), z.transpose();
  return frame;
}

std::optional<Eigen::VectorXd> reference_shot_histogram(const Points& vertices, const Points& normals,
                                                        const Eigen::Vector3d& point, const LocalReferenceFrame& frame,
                                                        double radius) {
  Eigen::VectorXd histogram = Eigen::VectorXd::Zero(8 * 2 * 2 * 11);
  for (int row = 0; row < vertices.rows(); ++row) {
    const Eigen::Vector3d local = frame * (row_of(vertices, row) - point);
    const Eigen::Vector3d normal = row_of(normals, row);
    if (!(local.norm() > 0) || local.norm() > radius || normal.isZero(0)) continue;
    add_neighbor(spherical(local), local.z() > 0, normal.dot(frame.row(2)), radius, histogram);
  }
  if (histogram.isZero(0)) return std::nullopt;
  return histogram / histogram.norm();
}

}  // namespace corral::testing
