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

/// By row, each oriented.
Points turned(const NearestPlanes& fits, const Mesh& mesh, const PointGrid& grid, const NormalOptions& options) {
  const Points sides = options.side_of_faces ? area_weighted_normals(mesh) : Points();
  Points normals(mesh.vertices.rows(), 3);
  for (int slot = 0; slot < grid.size(); ++slot) {
    const int row = grid.row(slot);
    const auto i = static_cast<std::size_t>(slot);
    const Eigen::RowVector3d normal(fits.nx[i], fits.ny[i], fits.nz[i]);
    Eigen::RowVector3d outside = options.sensor.transpose() - mesh.vertices.row(row);
    if (options.side_of_faces && !sides.row(row).isZero(0)) outside = sides.row(row);
    normals.row(row) = normal.dot(outside) < 0 ? Eigen::RowVector3d(-normal) : normal;
  }
  return normals;
}

}  // namespace

Points estimate_normals(const Mesh& mesh, const NormalOptions& options, const ParallelFor& parallel) {
  const PointGrid grid = grid_for(mesh.vertices, options.neighbors);
  const NearestPlanes fits = fit_nearest_planes(mesh.vertices, grid, options.neighbors, parallel);
  return turned(fits, mesh, grid, options);
}

NormalsAndResolution estimate_normals_and_resolution(const Mesh& mesh, const NormalOptions& options,
                                                     const ParallelFor& parallel) {
  const PointGrid grid = grid_for(mesh.vertices, options.neighbors);
  NearestPlanes fits = fit_nearest_planes(mesh.vertices, grid, options.neighbors, parallel);
  const double resolution = mean_nearest(grid, mesh.vertices, std::move(fits.squares));
  return {turned(fits, mesh, grid, options), resolution};
}

}  // namespace corral
