// SPDX-License-Identifier: MIT
#include "tests/support/reference/fpfh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace corral::testing {
namespace {

constexpr double kPi = 3.14159265358979323846;

Eigen::Vector3d row_of(const Points& points, int row) { return points.row(row).transpose(); }
bool is_usable(const Eigen::Vector3d& normal) { return normal.allFinite() && !normal.isZero(0); }

/// The bin of a value in low .. high.
Eigen::Index bin_of(double value, double low, double high) {
  return std::clamp<Eigen::Index>(static_cast<Eigen::Index>(std::floor(11 * (value - low) / (high - low))), 0, 10);
}

/// Those around a vertex, without others in the same place.
Indices support_of(const Points& vertices, int vertex, double radius, FpfhForm form) {
  Indices found;
  for (int other = 0; other < vertices.rows(); ++other) {
    const Eigen::Vector3d offset = row_of(vertices, other) - row_of(vertices, vertex);
    const double squared = offset.x() * offset.x() + offset.y() * offset.y() + offset.z() * offset.z();
    if (squared > 0 && (form == FpfhForm::Paper ? squared <= radius * radius : squared < radius * radius))
      found.push_back(other);
  }
  return found;
}

}  // namespace

std::optional<PairAngles> pair_angles(const Eigen::Vector3d& p, const Eigen::Vector3d& normal_p,
                                      const Eigen::Vector3d& q, const Eigen::Vector3d& normal_q) {
  const Eigen::Vector3d line = (q - p).normalized();
  const bool from_q = std::abs(normal_q.dot(q - p)) > std::abs(normal_p.dot(q - p));
  const Eigen::Vector3d along = from_q ? Eigen::Vector3d(-line) : line;
  const Eigen::Vector3d u = from_q ? normal_q : normal_p, other = from_q ? normal_p : normal_q;
  const Eigen::Vector3d across = along.cross(u);
  if (!(across.norm() > 1e-6)) return std::nullopt;
  const Eigen::Vector3d v = across.normalized(), w = u.cross(v);
  return PairAngles{std::atan2(w.dot(other), u.dot(other)), v.dot(other), u.dot(along)};
}

Eigen::VectorXd reference_simple_histogram(const Points& vertices, const Points& normals, int vertex, double radius,
                                           FpfhForm form) {
  Eigen::VectorXd histogram = Eigen::VectorXd::Zero(kFpfhSize);
  const Eigen::Vector3d normal = row_of(normals, vertex);
  if (!is_usable(normal)) return histogram;
  double pairs = 0;
  for (const int other : support_of(vertices, vertex, radius, form)) {
    if (!is_usable(row_of(normals, other))) continue;
    auto angles = pair_angles(row_of(vertices, vertex), normal, row_of(vertices, other), row_of(normals, other));
    if (!angles && form == FpfhForm::Pcl) angles = PairAngles{0, 0, 0};
    if (!angles) continue;
    histogram(bin_of(angles->theta, -kPi, kPi)) += 1;
    histogram(11 + bin_of(angles->alpha, -1, 1)) += 1;
    histogram(22 + bin_of(angles->phi, -1, 1)) += 1;
    ++pairs;
  }
  return histogram / std::max(pairs, 1.0);
}

std::optional<Eigen::VectorXd> reference_fpfh(const Points& vertices, const Points& normals, int vertex, double radius,
                                              FpfhForm form) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(kFpfhSize);
  int with_histogram = 0;
  for (const int other : support_of(vertices, vertex, radius, form)) {
    const Eigen::VectorXd histogram = reference_simple_histogram(vertices, normals, other, radius, form);
    const double distance = (row_of(vertices, other) - row_of(vertices, vertex)).norm();
    sum += histogram / (form == FpfhForm::Paper ? distance / radius : distance * distance);
    with_histogram += !histogram.isZero(0);
  }
  if (form == FpfhForm::Paper)
    sum = (sum / std::max(with_histogram, 1) + reference_simple_histogram(vertices, normals, vertex, radius, form))
              .eval();
  if (!(sum.sum() > 0)) return std::nullopt;
  for (int first = 0; first < kFpfhSize; first += 11) sum.segment(first, 11) *= 100 / sum.segment(first, 11).sum();
  return sum;
}

}  // namespace corral::testing
