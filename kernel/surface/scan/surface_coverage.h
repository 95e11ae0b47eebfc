// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/rigid_transform.h"
#include "kernel/surface/search/coincidence.h"
#include "kernel/surface/search/nearest_points.h"

namespace corral {

/// How well two surfaces lie on each other under a pose T, 0 .. 1, without any ground truth:
///
///   c(X, Y) = 1/|X| sum over x in X of max(0, 1 - d(x, Y) / reach) |n_x . n_y|,   y the nearest point of Y
///   coverage = (c(T source, target) + c(T^-1 target, source)) / 2
///
/// d is the distance to the nearest vertex; a zero row is a point without a normal. At most `most_asked` vertices of a
/// surface are asked, at even steps through their list.
///
/// Source    the truncated distances of [chen2023sc2pcr], divided by the number of points that are asked (there: that are
///           covered, so that a single covered point is full marks), times the agreement of the normals up to their side.
/// Cost      O((|X| + |Y|) log) for each pose.
class SurfaceCoverage {
 public:
  SurfaceCoverage(const OrientedPoints& source, const OrientedPoints& target, int most_asked = 20000);

  /// `reach` in mesh units, above 0.
  double operator()(const RigidTransform& target_from_source, double reach) const;

 private:
  struct Side {
    Side(const OrientedPoints& surface, int most_asked);
    Points normals;                      ///< of all points
    Points asked_points, asked_normals;  ///< of those that are asked
    PointTree tree;
    Points points;
  };
  static double covered(const Side& from, const Side& onto, const RigidTransform& onto_from_from, double reach);

  Side source_, target_;
};

}  // namespace corral
