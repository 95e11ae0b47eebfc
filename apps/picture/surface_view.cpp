// SPDX-License-Identifier: MIT
#include "apps/picture/surface_view.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernel/surface/normals.h"
#include "kernel/surface/search/resolution.h"

namespace corral {
namespace {

/// The brightness of a surface with this normal in view axes: a key light from above on the left, a weak one from the right,
/// and less light where it turns away. Both sides of a surface look the same.
float brightness(Eigen::Vector3d normal) {
  if (normal.z() < 0) normal = -normal;
  static const Eigen::Vector3d key = Eigen::Vector3d(-0.45, 0.6, 0.75).normalized();
  static const Eigen::Vector3d fill = Eigen::Vector3d(0.8, -0.1, 0.5).normalized();
  const double light = 0.32 + 0.66 * std::max(0.0, normal.dot(key)) + 0.2 * std::max(0.0, normal.dot(fill));
  return static_cast<float>(light * (0.8 + 0.25 * normal.z()));
}

Eigen::Matrix3d view_of(const Eigen::Vector3d& to_viewer, const Eigen::Vector3d& up) {
  const Eigen::Vector3d toward = to_viewer.normalized(), right = up.cross(toward).normalized();
  Eigen::Matrix3d view;
  view << right.transpose(), toward.cross(right).transpose(), toward.transpose();
  return view;
}

/// Oriented area: the area-weighted normals of the faces around every vertex, or the normals of the points of a cloud.
Points area_sums(const PaintedSurface& surface) {
  return surface.mesh.triangles.rows() == 0 ? surface.normals : area_weighted_normals(surface.mesh);
}

}  // namespace

PaintedSurface painted_surface(Mesh mesh) {
  PaintedSurface surface{std::move(mesh), {}, 0};
  surface.resolution = point_resolution(surface.mesh.vertices);
  if (surface.mesh.triangles.rows() == 0)
    surface.normals = estimate_normals(surface.mesh);
  else
    surface.normals = area_weighted_normals(surface.mesh).rowwise().normalized();
  return surface;
}

PaintedSurface moved(const PaintedSurface& surface, const RigidTransform& motion) {
  return {{motion.apply(surface.mesh.vertices), surface.mesh.triangles},
          surface.normals * motion.rotation.transpose(),
          surface.resolution};
}

Eigen::Vector3d Projection::operator()(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d seen = scale * (view_from_mesh * point - middle);
  return {place.x() + seen.x(), place.y() - seen.y(), seen.z()};
}

Eigen::AlignedBox3d view_box(const Points& points, const Eigen::Matrix3d& view_from_mesh) {
  Eigen::AlignedBox3d box;
  for (Eigen::Index i = 0; i < points.rows(); ++i) box.extend(view_from_mesh * points.row(i).transpose());
  return box;
}

ChosenView choose_view(const PaintedSurface& surface) {
  const double half = std::sqrt(0.5);
  const std::vector<Eigen::Vector3d> sides = {{0, 0, 1},       {0, 0, -1},       {1, 0, 0},        {-1, 0, 0},
                                              {half, 0, half}, {-half, 0, half}, {half, 0, -half}, {-half, 0, -half}};
  const Points sums = area_sums(surface);
  const auto facing = [&](const Eigen::Vector3d& to_viewer) { return (sums * to_viewer).cwiseMax(0).sum(); };
  const double total = std::max(sums.rowwise().norm().sum(), 1e-300);
  double most = 0;
  for (const Eigen::Vector3d& side : sides) most = std::max(most, facing(side));
  for (const double y : {1.0, -1.0})
    if (facing({0, y, 0}) > 1.5 * most) return {view_of({0, y, 0}, {0, 0, -y}), facing({0, y, 0}) / total};
  const auto is_good = [&](const Eigen::Vector3d& side) { return facing(side) >= 0.9 * most; };
  const Eigen::Vector3d chosen = *std::find_if(sides.begin(), sides.end(), is_good);
  return {view_of(chosen, {0, 1, 0}), facing(chosen) / total};
}

void paint(Raster& raster, const PaintedSurface& surface, const Projection& projection, const Color& color) {
  const Mesh& mesh = surface.mesh;
  std::vector<Corner> corners(static_cast<std::size_t>(mesh.vertices.rows()));
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    corners[i] = {projection(mesh.vertices.row(row).transpose()),
                  color * brightness(projection.view_from_mesh * surface.normals.row(row).transpose())};
  }
  const auto corner = [&](int vertex) { return corners[static_cast<std::size_t>(vertex)]; };
  for (Eigen::Index i = 0; i < mesh.triangles.rows(); ++i)
    raster.draw_triangle(corner(mesh.triangles(i, 0)), corner(mesh.triangles(i, 1)), corner(mesh.triangles(i, 2)));
  if (mesh.triangles.rows() == 0)
    for (const Corner& point : corners) raster.draw_disc(point, 0.8 * projection.scale * surface.resolution);
}

}  // namespace corral
