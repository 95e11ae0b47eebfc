// SPDX-License-Identifier: MIT
#include "tests/support/reference/shot.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "tests/support/reference/surface.h"

namespace corral::testing {
namespace {

constexpr double kPi = 3.14159265358979323846;

double degrees(double radians) { return radians * 180 / kPi; }

Eigen::Vector3d row_of(const Points& points, int row) { return points.row(row).transpose(); }

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

/// A vertex on the axes of the grid, a unit per bin, the first bin at 0.
struct Place {
  double azimuth, shell, above, cosine;
};

/// Absent azimuth: NaN.
Place place_of(const Eigen::Vector3d& local, double cosine, double radius) {
  const double around = degrees(std::atan2(local.y() + 0.0, local.x()));  // +180 for either sign of zero
  const double down = degrees(std::acos(std::clamp(local.z() / local.norm(), -1.0, 1.0)));
  return {local.head<2>().isZero(0) ? NAN : (around + 157.5) / 45, (local.norm() - radius / 4) / (radius / 2),
          (135 - down) / 90, 5 * (1 + std::clamp(cosine, -1.0, 1.0))};
}

/// The way along the circle of the sectors, -4 .. 4.
double around_circle(double sectors) { return std::remainder(sectors, 8); }

/// What a bin gets from a vertex at a distance from its centre.
double tent(double distance) { return std::max(0.0, 1 - std::abs(distance)); }

/// Adds to the bin that holds the vertex what each axis leaves there, and to the two beside it along each axis the rest.
void add_axis_by_axis(const Eigen::Vector3d& local, const Place& place, bool wraps, double radius,
                      Eigen::VectorXd& histogram) {
  const int shell = local.norm() <= radius / 2 ? 0 : 1, above = local.z() > 0 ? 1 : 0;
  const int cosine = static_cast<int>(std::lround(place.cosine));
  int azimuth = 0;
  for (int sector = 1; sector < 8; ++sector)  // the first of two equally near ones: it holds its upper border
    if (std::abs(around_circle(place.azimuth - sector)) < std::abs(around_circle(place.azimuth - azimuth)))
      azimuth = sector;
  if (std::abs(around_circle(place.azimuth - azimuth)) == 0.5 && azimuth == 0 && place.azimuth > 4) azimuth = 7;
  double& own = histogram(shot_bin(azimuth, shell, above, cosine));
  double left = 0;
  if (!std::isnan(place.azimuth)) {
    for (const int beside : {(azimuth + 1) % 8, (azimuth + 7) % 8})
      histogram(shot_bin(beside, shell, above, cosine)) += tent(around_circle(place.azimuth - beside));
    left += tent(around_circle(place.azimuth - azimuth));
  }
  histogram(shot_bin(azimuth, 1 - shell, above, cosine)) += tent(place.shell - (1 - shell));
  left += tent(place.shell - shell);
  histogram(shot_bin(azimuth, shell, 1 - above, cosine)) += tent(place.above - (1 - above));
  left += tent(place.above - above);
  for (const int beside : {cosine - 1, cosine + 1}) {
    const double share = tent(place.cosine - beside);
    if (share > 0) histogram(shot_bin(azimuth, shell, above, wraps && beside == 10 ? 0 : beside)) += share;
  }
  left += tent(place.cosine - cosine);
  own += left;
}

/// Adds to every bin the product of what the axes say.
void add_product(const Place& place, Eigen::VectorXd& histogram) {
  const bool on_axis = std::isnan(place.azimuth);
  for (int azimuth = 0; azimuth < 8; ++azimuth)
    for (int shell = 0; shell < 2; ++shell)
      for (int above = 0; above < 2; ++above)
        for (int cosine = 0; cosine < 11; ++cosine)
          histogram(shot_bin(azimuth, shell, above, cosine)) +=
              (on_axis ? azimuth == 0 : tent(around_circle(place.azimuth - azimuth))) * tent(place.shell - shell) *
              tent(place.above - above) * tent(place.cosine - cosine);
}

}  // namespace

Eigen::Index shot_bin(int azimuth, int shell, int above, int cosine) {
  return ((azimuth * 2 + shell) * 2 + above) * 11 + cosine;
}

Support support_of(const Points& vertices, const Points& normals, const Eigen::Vector3d& point, double radius) {
  Support support;
  for (const Neighbor& neighbor : reference_within(vertices, point, radius))
    support.add(row_of(vertices, neighbor.index) - point, row_of(normals, neighbor.index));
  return support;
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

Eigen::VectorXd reference_shot_votes(const Points& vertices, const Points& normals, const Eigen::Vector3d& point,
                                     const LocalReferenceFrame& frame, double radius, ShotForm form) {
  Eigen::VectorXd histogram = Eigen::VectorXd::Zero(8 * 2 * 2 * 11);
  for (int row = 0; row < vertices.rows(); ++row) {
    const Eigen::Vector3d away = row_of(vertices, row) - point, local = frame * away;
    const Eigen::Vector3d normal = row_of(normals, row);
    if (!(away.norm() > 0) || away.norm() > radius || normal.isZero(0)) continue;
    const Place place = place_of(local, normal.dot(frame.row(2)), radius);
    if (form == ShotForm::Product)
      add_product(place, histogram);
    else
      add_axis_by_axis(local, place, form == ShotForm::PclBug, radius, histogram);
  }
  return histogram;
}

std::optional<Eigen::VectorXd> reference_shot_histogram(const Points& vertices, const Points& normals,
                                                        const Eigen::Vector3d& point, const LocalReferenceFrame& frame,
                                                        double radius, ShotForm form) {
  const Eigen::VectorXd votes = reference_shot_votes(vertices, normals, point, frame, radius, form);
  if (votes.isZero(0)) return std::nullopt;
  return votes / votes.norm();
}

}  // namespace corral::testing
