// SPDX-License-Identifier: MIT
#include "kernel/surface/normals.h"

#include <utility>

#include "kernel/error.h"
#include "kernel/surface/nearest_planes.h"
#include "kernel/surface/search/mean_nearest.h"

namespace corral {
namespace {

/// The grid for a search for so many.
PointGrid grid_for(const Points& points, int k) {
  if (k < 3) throw InvalidInput("estimate_normals", "neighbors", std::to_string(k), "at least 3");
  // Cells a little wider than the k nearest reach, so that the next cells around nearly always hold them.
  return PointGrid::with_occupancy(points, 0.65 * k);
}

/// Vectors to the side that normals belong to, by row; no rows: towards the sensor.
Points sides_of(const Mesh& mesh, NormalGuide guide) {
  if (guide == NormalGuide::Faces) return area_weighted_normals(mesh);
  return guide == NormalGuide::Normals ? mesh.normals : Points();
}

/// The sensor of the mesh is not among the ways of Mesh and Origin.
Eigen::RowVector3d sensor_of(const Mesh& mesh, const NormalOptions& options) {
  const bool may_be_own = options.side == NormalSide::Auto || options.side == NormalSide::File;
  if (!options.sensor && may_be_own && mesh.sensor) return mesh.sensor->transpose();
  return options.sensor.value_or(Eigen::Vector3d::Zero()).transpose();
}

/// By row, each oriented.
Points turned(const NearestPlanes& fits, const Mesh& mesh, const PointGrid& grid, const NormalOptions& options) {
  const NormalGuide guide = normal_guide(mesh, options);
  const Points sides = sides_of(mesh, guide);
  const Eigen::RowVector3d sensor = sensor_of(mesh, options);
  Points normals(mesh.vertices.rows(), 3);
  for (int slot = 0; slot < grid.size(); ++slot) {
    const int row = grid.row(slot);
    const auto i = static_cast<std::size_t>(slot);
    const Eigen::RowVector3d normal(fits.nx[i], fits.ny[i], fits.nz[i]);
    Eigen::RowVector3d outside = sensor - mesh.vertices.row(row);
    if (sides.rows() > 0 && !sides.row(row).isZero(0)) outside = sides.row(row);
    normals.row(row) = normal.dot(outside) < 0 ? Eigen::RowVector3d(-normal) : normal;
  }
  return normals;
}

}  // namespace

NormalGuide normal_guide(const Mesh& mesh, const NormalOptions& options) {
  const bool has_faces = mesh.triangles.rows() > 0, has_normals = mesh.normals.rows() > 0;
  const NormalGuide sensor = options.sensor ? NormalGuide::NamedSensor : NormalGuide::Origin;
  switch (options.side) {
    case NormalSide::Mesh:
      return has_faces ? NormalGuide::Faces : sensor;
    case NormalSide::Origin:
      return sensor;
    case NormalSide::File:
      if (!has_normals) throw InvalidInput("normals", "file", "a mesh without normals", "one whose file has them");
      return NormalGuide::Normals;
    case NormalSide::Auto:
      break;
  }
  if (options.sensor) return NormalGuide::NamedSensor;
  if (has_faces) return NormalGuide::Faces;
  if (has_normals) return NormalGuide::Normals;
  return mesh.sensor ? NormalGuide::OwnSensor : NormalGuide::Origin;
}

Points estimate_normals(const Mesh& mesh, const NormalOptions& options, const ParallelFor& parallel) {
  const PointGrid grid = grid_for(mesh.vertices, options.neighbors);
  const NearestPlanes fits = fit_nearest_planes(mesh.vertices, grid, options.neighbors, parallel);
  return turned(fits, mesh, grid, options);
}

NormalsAndResolution estimate_normals_and_resolution(const Mesh& mesh, const NormalOptions& options,
                                                     const ParallelFor& parallel) {
  const PointGrid grid = grid_for(mesh.vertices, options.neighbors);
  NearestPlanes fits = fit_nearest_planes(mesh.vertices, grid, options.neighbors, parallel);
  PointSpacing spacing = mean_nearest(grid, mesh.vertices, std::move(fits.squares));
  return {turned(fits, mesh, grid, options), std::move(spacing)};
}

}  // namespace corral
