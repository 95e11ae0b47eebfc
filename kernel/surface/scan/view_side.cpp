// SPDX-License-Identifier: MIT
#include "kernel/surface/scan/view_side.h"

namespace corral {
namespace {

/// Normals weighted by area, or those that the mesh has; no rows if it has none.
Points outside_of(const Mesh& mesh) { return mesh.triangles.rows() > 0 ? area_weighted_normals(mesh) : mesh.normals; }

}  // namespace

std::optional<double> front_share(const Mesh& mesh, const ViewOptions& sensor) {
  const Points outside = outside_of(mesh);
  double front = 0, whole = 0;
  for (Eigen::Index row = 0; row < outside.rows(); ++row) {
    const Eigen::Vector3d normal = outside.row(row).transpose();
    const Eigen::Vector3d to_sensor =
        sensor.direction ? Eigen::Vector3d(-*sensor.direction) : sensor.sensor - mesh.vertices.row(row).transpose();
    whole += normal.norm();
    if (normal.dot(to_sensor) > 0) front += normal.norm();
  }
  return whole > 0 ? std::optional<double>(front / whole) : std::nullopt;
}

ViewOptions view_side(const Mesh& mesh) {
  ViewOptions view;
  if (mesh.sensor) view.sensor = *mesh.sensor;
  const auto front = front_share(mesh, view);
  if (mesh.sensor || !front || *front >= 0.5) return view;
  constexpr double kOneSided = 0.1;  // the normals of a closed surface add up to nothing
  const Points outside = outside_of(mesh);
  const Eigen::Vector3d sum = outside.colwise().sum().transpose();
  if (sum.norm() > kOneSided * outside.rowwise().norm().sum()) view.direction = -sum.stableNormalized();
  return view;
}

}  // namespace corral
