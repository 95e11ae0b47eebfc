// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/parallel.h"
#include "kernel/rigid_transform.h"
#include "kernel/surface/mesh/mesh.h"
#include "kernel/surface/search/surface_tree.h"

namespace corral {

/// A surface where it stands in the world.
struct PosedSurface {
  const SurfaceTree* surface;  ///< must outlive this
  RigidTransform world_from_mesh;
};
using PosedSurfaces = std::vector<PosedSurface>;

/// Where a range sensor stands. Its own frame has it at the origin, looking along -z with y up, as real scans have it.
struct RangeSensor {
  Eigen::Vector3d position;  ///< in the world
  Eigen::Vector3d target;    ///< the point it looks at
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();

  /// Throws InvalidInput if it is not finite or looks at itself. If it looks along `up`, any other direction is up.
  RigidTransform sensor_from_world() const;
};

/// The i-th of n sensors around a surface, which all look at the middle of its box from `distance` of its diagonals away:
/// on a ring about its y axis in equal steps that rises to 25 degrees above the middle and falls as far below it twice a
/// turn, each rolled about its own axis by another angle. Throws InvalidInput unless 0 <= i < n.
RangeSensor ring_sensor(const Mesh& mesh, int i, int n, double distance = 3);

/// Approximate pr of the scan of a curved surface, in spacings of its rays: 1.03 to 1.14 for animals and busts.
constexpr double kScanResolution = 1.08;

struct RangeScanOptions {
  double spacing = 0;       ///< between neighbouring rays at the distance of the target, mesh units; required
  double noise = 0;         ///< deviation of normal noise along each ray, mesh units
  double grazing_deg = 80;  ///< largest angle between ray and surface normal; beyond it nothing is returned
  std::uint64_t seed = 1;   ///< of the noise
};

/// One point for each ray that returned, row by row of the image from the top, each row from the left.
struct RangeScan {
  Points points;                    ///< in the frame of the sensor, mesh units
  Indices surfaces;                 ///< which of the posed surfaces each lies on
  Indices triangles;                ///< and on which of its triangles
  Indices image_rows;               ///< where in the image each was seen
  Indices image_columns;            ///
  std::vector<double> patch_areas;  ///< of each surface the area that the sensor sees, squared mesh units
  RigidTransform sensor_from_world;
};

/// A virtual range scanner: a ray through every cell of an image, and the surface that it meets first.
///
///   ray (i, j) = (j h, -i h, -1) / norm,  h = spacing / |target - position|     point = (distance + noise * N(0,1)) ray
///   patch area = sum over its rays of distance^2 h^2 / ((1 + (j h)^2 + (i h)^2)^(3/2) cosine)
///
/// The area of a patch is that of the surface itself behind each cell of the image, so that it has neither holes nor a rim
/// that is half a cell too small; a surface met at more than `grazing_deg` counts as not seen. Without noise each point lies
/// on its triangle under sensor_from_world * world_from_mesh up to rounding: the poses are the truth.
///
/// Cost      one query of each tree whose box the ray may meet; O(rays) memory. Any number of threads gives the same bits.
/// Throws    InvalidInput: an option out of range, no surface, a surface that is not in front of the sensor, more than
///           2^26 rays.
RangeScan scan_range(const PosedSurfaces& scene, const RangeSensor& sensor, const RangeScanOptions& options,
                     const ParallelFor& parallel = one_by_one);

/// The scan with faces (triangulate_view at the pr of its points). Throws InvalidInput for fewer than two points.
Mesh triangulated(const RangeScan& scan);

}  // namespace corral
