// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "kernel/rigid_transform.h"
#include "kernel/surface/mesh/mesh.h"
#include "kernel/surface/scan/range_scan.h"
#include "kernel/surface/search/neighborhood.h"

namespace corral {

/// The field's thresholds of the two overlaps below, in pr.
constexpr double kOverlapPointsPr = 4;  ///< of overlap_points, over which a pose is judged
constexpr double kOverlapSharePr = 2;   ///< of overlap_share, by which pairs are sorted and views chosen

/// The source vertices that the two surfaces share: those whose true image has a target vertex within `threshold` (mesh
/// units; kOverlapPointsPr). Registration errors are averaged over them.
///
/// Source    the evaluation programs behind [yang2017evaluation]'s successors (RMSE on U3M).
Points overlap_points(const Points& source, const PointIndex& target_index, const RigidTransform& target_from_source,
                      double threshold);

/// How much two surfaces share, 0 .. 1: the vertices with one of the other surface within `threshold` (mesh units;
/// kOverlapSharePr), counted on both, the smaller count over the smaller number of vertices. 0 if one has none.
///
/// Source    [yang2017evaluation] for the ratio; it leaves the threshold and the direction open.
double overlap_share(const Points& source, const Points& target, const RigidTransform& target_from_source,
                     double threshold);

/// Area of all triangles in squared mesh units.
double surface_area(const Mesh& mesh);

/// How much of a model a scene hides, and how much of the scene is something else; shares of 1.
struct Visibility {
  double occlusion, clutter;
};

/// Of each surface before the sensor
///
///   occlusion = 1 - area of its patch / area of its triangles     clutter = 1 - area of its patch / area of all patches
///
/// with the areas of the surfaces that the sensor sees (RangeScan::patch_areas). One view of a whole convex object hides
/// half of it, and a little more for what is met flatter than the scan's grazing_deg. The faces of a scan cover less than
/// that, by a rim of half a ray's spacing around each patch: occlusion measured from them is some hundredths higher.
///
/// Source    [mian2006recognition], [mian2010repeatability].
/// Returns   clutter 1 where nothing at all is seen.
std::vector<Visibility> measure_visibility(const PosedSurfaces& scene, const RangeScan& scan);

/// The part of a surface's area that another shares, 0 .. 1: triangles whose three corners have a point of the other within
/// `threshold` (mesh units). Absent for a surface without area. Of a model and the scene that it stands in,
///
///   occlusion = 1 - shared_area(model, scene)     clutter = 1 - shared_area(scene, model)
///
/// Source    [mian2006recognition] for both ratios.
std::optional<double> shared_area(const Mesh& surface, const Points& other, const RigidTransform& other_from_surface,
                                  double threshold);

}  // namespace corral
