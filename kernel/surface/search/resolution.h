// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/parallel.h"
#include "kernel/surface/mesh/mesh.h"

namespace corral {

/// The distances of the vertices of a surface to their nearest others. Exact duplicates of a vertex count once.
/// Strays lie alone, or where all strays are few two or three beside each other: joined by steps of at most 20 medians, and
/// further than that from all others. Such a group moves pr little, but is no part of the surface.
struct PointSpacing {
  double resolution = 0;      ///< their mean: pr, mesh units
  double median = 0;          ///< mesh units
  Indices strays = {};        ///< the vertices further than 20 medians from all others, ascending; see below
  double without_strays = 0;  ///< the mean without strays if these are few, at most 2 in 100; else the mean, mesh units
  double stray_distance = 0;  ///< the largest of a stray to all others, mesh units

  /// Whether a few lone vertices decide on pr: they change it by more than 5 %. On surfaces of uneven density, such as CAD
  /// models, many vertices are far from all others.
  bool is_moved_by_strays() const;
};

/// Point resolution pr of a surface in mesh units: the mean distance of a vertex to its nearest other vertex. Exact
/// duplicates of a vertex count once. It is not the mean edge length (about 1.5 pr), and infinite where distances overflow.
///
/// Source    [yang2017evaluation], and the authors' program (k = 2 nearest neighbours, averaged).
/// Cost      O(V) time where vertices lie evenly on a surface. Any number of threads gives the same bits.
/// Throws    InvalidInput for fewer than two distinct vertices.
/// Plain form  tests/support/reference/surface.h
double point_resolution(const Points& vertices, const ParallelFor& parallel = one_by_one);

/// The same with what else the distances tell. Throws what point_resolution throws.
PointSpacing point_spacing(const Points& vertices, const ParallelFor& parallel = one_by_one);

}  // namespace corral
