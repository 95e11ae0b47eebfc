// SPDX-License-Identifier: MIT
#include "kernel/surface/descriptor.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kernel/error.h"

namespace corral {
namespace {

constexpr double kDegreesPerRadian = 180.0 / 3.141592653589793;
constexpr int kAzimuths = 8, kElevations = 2, kShells = 2, kCosines = 11;
constexpr std::size_t kSmallestNeighborhood = 5;

/// Turns an axis to the side where most neighbours lie. `offsets`: N x 3, nearest first.
Eigen::Vector3d towards_majority(const Eigen::Vector3d& axis, const Points& offsets) {
  const Eigen::VectorXd along = offsets * axis;
  const Eigen::Index count = along.size();
  const Eigen::Index ahead = (along.array() >= 0).count();
  if (2 * ahead != count) return 2 * ahead < count ? Eigen::Vector3d(-axis) : axis;
  const Eigen::Index median = std::clamp<Eigen::Index>(count / 2, 2, count - 3);
  return (along.segment(median - 2, 5).array() > 0).count() < 3 ? Eigen::Vector3d(-axis) : axis;
}

/// A bin and what the value gives to the bin beside it along one axis.
struct Share {
  int bin;      ///< where the value lies
  int beside;   ///< the nearer neighbour along the axis, or -1 at the end of the axis
  double away;  ///< distance from the centre of `bin` in bins, 0 .. 0.5
};

/// `position`: coordinate in which bin b is centred at b. `count` bins, `circular` or ending at both sides.
Share share_of(double position, int count, bool circular) {
  const int nearest = static_cast<int>(std::floor(position + 0.5));
  const int bin = circular ? (nearest + count) % count : std::clamp(nearest, 0, count - 1);
  const double delta = position - (circular ? nearest : bin);
  int beside = delta > 0 ? bin + 1 : bin - 1;
  if (circular)
    beside = (beside + count) % count;
  else if (beside >= count)
    beside = -1;
  return {bin, beside, std::abs(delta)};
}

int flat_bin(int azimuth, int elevation, int shell, int cosine) {
  return ((azimuth * kElevations + elevation) * kShells + shell) * kCosines + cosine;
}

void vote(Eigen::VectorXd& histogram, const Eigen::Vector3d& local, double distance, double cosine, double radius) {
  const double azimuth_deg = std::atan2(local.y(), local.x()) * kDegreesPerRadian;  // -180 .. 180
  const double polar_deg = std::acos(std::clamp(local.z() / distance, -1.0, 1.0)) * kDegreesPerRadian;
  // Bin b of an axis is centred at position b: cosine bins sit on whole numbers, the others halfway between their
  // edges.
  const Share c = share_of((1 + std::clamp(cosine, -1.0, 1.0)) * (kCosines - 1) / 2, kCosines, false);
  const Share a = share_of((azimuth_deg + 180) / 45 - 0.5, kAzimuths, true);
  const Share e = share_of(polar_deg / 90 - 0.5, kElevations, false);
  const Share s = share_of(distance / (radius / 2) - 0.5, kShells, false);

  double own = 1 - c.away;
  if (c.beside >= 0) histogram(flat_bin(a.bin, e.bin, s.bin, c.beside)) += c.away;
  own += 1 - s.away;
  if (s.beside >= 0) histogram(flat_bin(a.bin, e.bin, s.beside, c.bin)) += s.away;
  own += 1 - e.away;
  if (e.beside >= 0) histogram(flat_bin(a.bin, e.beside, s.bin, c.bin)) += e.away;
  own += 1 - a.away;
  histogram(flat_bin(a.beside, e.bin, s.bin, c.bin)) += a.away;
  histogram(flat_bin(a.bin, e.bin, s.bin, c.bin)) += own;
}

}  // namespace

std::optional<LocalReferenceFrame> shot_frame(const Points& vertices, const Eigen::Vector3d& point,
                                              const std::vector<Neighbor>& neighbors, double radius) {
  std::vector<Neighbor> around;
  for (const Neighbor& neighbor : neighbors)
    if (neighbor.squared_distance > 0) around.push_back(neighbor);
  if (around.size() < kSmallestNeighborhood) return std::nullopt;
  std::sort(around.begin(), around.end(), [](const Neighbor& a, const Neighbor& b) {
    return a.squared_distance < b.squared_distance || (a.squared_distance == b.squared_distance && a.index < b.index);
  });

  Points offsets(static_cast<Eigen::Index>(around.size()), 3);
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  double weights = 0;
  for (std::size_t i = 0; i < around.size(); ++i) {
    const Eigen::RowVector3d offset = vertices.row(around[i].index) - point.transpose();
    const double weight = radius - std::sqrt(around[i].squared_distance);
    offsets.row(static_cast<Eigen::Index>(i)) = offset;
    moments += weight * offset.transpose() * offset;
    weights += weight;
  }
  moments /= weights;
  if (!moments.allFinite()) return std::nullopt;                         // every neighbour exactly at the rim
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments);  // ascending eigenvalues
  const Eigen::Vector3d x = towards_majority(solver.eigenvectors().col(2), offsets);
  const Eigen::Vector3d z = towards_majority(solver.eigenvectors().col(0), offsets);
  LocalReferenceFrame frame;
  frame.row(0) = x;
  frame.row(1) = z.cross(x);
  frame.row(2) = z;
  return frame;
}

std::optional<Eigen::VectorXd> shot_histogram(const Points& vertices, const Points& normals,
                                              const Eigen::Vector3d& point, const LocalReferenceFrame& frame,
                                              const std::vector<Neighbor>& neighbors, double radius) {
  Eigen::VectorXd histogram = Eigen::VectorXd::Zero(kShotSize);
  for (const Neighbor& neighbor : neighbors) {
    const Eigen::Vector3d normal = normals.row(neighbor.index).transpose();
    if (!(neighbor.squared_distance > 0) || normal.isZero(0)) continue;
    const Eigen::Vector3d local = frame * (vertices.row(neighbor.index).transpose() - point);
    vote(histogram, local, std::sqrt(neighbor.squared_distance), normal.dot(frame.row(2)), radius);
  }
  const double norm = histogram.norm();
  if (!(norm > 0)) return std::nullopt;
  return histogram / norm;
}

Descriptors describe_shot(const Mesh& mesh, const Points& normals, const PointIndex& index, const Indices& keypoints,
                          double resolution, double radius_pr) {
  require_positive("describe_shot", "resolution", resolution);
  require_positive("describe_shot", "radius_pr", radius_pr);
  const double radius = radius_pr * resolution;
  Descriptors descriptors;
  std::vector<Eigen::VectorXd> columns;
  for (const int vertex : keypoints) {
    const Eigen::Vector3d point = mesh.vertices.row(vertex).transpose();
    const auto neighbors = index.within(point, radius);
    const auto frame = shot_frame(mesh.vertices, point, neighbors, radius);
    if (!frame) {
      ++descriptors.dropped_no_frame;
      continue;
    }
    auto histogram = shot_histogram(mesh.vertices, normals, point, *frame, neighbors, radius);
    if (!histogram) {
      ++descriptors.dropped_no_histogram;
      continue;
    }
    descriptors.vertices.push_back(vertex);
    descriptors.frames.push_back(*frame);
    columns.push_back(std::move(*histogram));
  }
  descriptors.features.resize(kShotSize, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) descriptors.features.col(static_cast<Eigen::Index>(i)) = columns[i];
  return descriptors;
}

}  // namespace corral
