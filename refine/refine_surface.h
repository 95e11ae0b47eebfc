// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "kernel/parallel.h"
#include "kernel/point_pairs.h"
#include "kernel/rigid_transform.h"
#include "kernel/types.h"

namespace corral {

/// Pairs each query (N x 3, in the target, neighbours next to each other) with the nearest target point, if one lies within
/// the limit (mesh units). NearestTracker::pair is one.
using NearestPairs = std::function<const PointPairs&(const Points& queries, double limit)>;

/// A surface as points. What is referred to must outlive the call.
struct SurfacePoints {
  const Points& points;   ///< N x 3, mesh units
  const Points& normals;  ///< N x 3, unit length; a point without one (zero or NaN) is ignored
};

struct SurfacePair {
  SurfacePoints source, target;
  double resolution;                  ///< mesh units per pr
  NearestPairs pair;                  ///< with the target points
  ParallelFor parallel = one_by_one;  ///< for the sums; results do not depend on it
};

enum class SurfaceResidual {
  PointToPlane,  ///< r = n . (T p_i - q_j), n the mean of both normals  [chen1992object], [rusinkiewicz2019symmetric]
  PointToPoint,  ///< r = T p_i - q_j                                    [besl1992method]
};

struct SurfaceLevel {
  double limit_pr;                                    ///< points farther apart are not paired
  int most_points = std::numeric_limits<int>::max();  ///< most source points used, evenly spread over the surface
  int most_rounds = 50;                               ///< of pairing and fitting
};

struct SurfaceOptions {
  SurfaceResidual residual = SurfaceResidual::PointToPlane;
  std::vector<SurfaceLevel> levels = {{20, 1000, 10}, {4, 1000, 10}, {4, 20000}, {4}};  ///< coarse to fine
  double largest_angle_deg = 30;    ///< between the normals of a pair, for points to planes
  double rest_pr = 1e-4;            ///< a round that moves the source by less (root mean square, at most), times the
                                    ///< number of source points per point used, ends a level
  double least_overlap = 0.05;      ///< share of source points that must find a partner
  double largest_condition = 1000;  ///< of the point-to-plane normal equations
};

enum class SurfaceStatus {
  Refined,             ///< a pose was found
  TooLittleOverlap,    ///< fewer pairs than `least_overlap`, or than 6: no pose
  DegenerateGeometry,  ///< the paired surface can slide on itself, as a plane or a sphere can: no pose
  Diverged,            ///< the optimisation found no usable pose: no pose
};

/// "refined", "too little overlap", "degenerate geometry", "diverged".
const char* to_text(SurfaceStatus status);

/// How well a pose aligns source points with the target, within the limit of the last level.
struct SurfaceFit {
  double overlap = 0;  ///< share of source points with a partner
  double rms_pr = 0;   ///< root mean square residual over the pairs, pr; 0 if there are none
};

/// One round of pairing and fitting; squares are sums over its pairs, pr^2.
struct SurfaceRound {
  double overlap;                        ///< share of the points of the level that found a partner
  double cost;                           ///< E at the pose of the pairing, pr^2
  double squares_before, squares_after;  ///< of the residuals of these pairs, after with the damping; never raised
};

struct RefinedSurface {
  SurfaceStatus status = SurfaceStatus::TooLittleOverlap;
  std::optional<RigidTransform> target_from_source;  ///< absent unless the status is Refined
  SurfaceFit before;                                 ///< at the start, over the points of the first level
  SurfaceFit after;                                  ///< at the last pose, over all points
  double condition = 0;                              ///< of the normal equations there; infinite if singular
  std::vector<std::vector<SurfaceRound>> levels;     ///< the rounds of each level, and of a last fit of points
};

/// Aligns one surface with another from an approximate pose: iterative closest points, coarse to fine.
///
///   E(T) = 1/N sum_i min( |r_i|^2, limit^2 )   with q_j the target point nearest to T p_i, limit^2 where there is no partner
///
/// Each round pairs every point with the nearest and then minimises the sum over those pairs (Ceres, one thread). A residual
/// is linear in (R, t), so that the sum depends on the pairs only through the Gram matrix of 13 columns: Ceres minimises its
/// square root. For points to points, E never increases. For points to planes it may, because the nearest point is not the
/// one with the least residual. A level ends when the pose no longer moves, or after three rounds without a lower E. A
/// damping term of n / 1000 squares of the step (of its translation and, for R - I, a third of those of size |R - I|, size
/// the root mean square distance from the centre) is added to the sum over n pairs, so that a step stays small where no pair
/// constrains it; it vanishes at the solution.
///
/// Planes    n = (n_j + s R n_i) / |n_j + s R n_i|, R that of the pairing, s = -1 if the normals of most pairs are opposite
///           (a surface may be inside out), else 1. Points whose normals differ by more than an angle are not paired: at rims
///           and where one surface hides another, the nearest point belongs to another part.
/// Levels    A level with a smaller limit than the one before is tried from the pose found so far and from the start,
///           because pairs within the larger limit may have been misleading; the lower E counts.
/// Points    Where the same points are seen twice, as in a scene that is a copy with noise, a last fit of points to points
///           gives the maximum likelihood pose. This is assumed if distances between partners are as large along the surface
///           as across it (within a factor 1.5 of their squares) and 15 % less than after a shift of 0.6 pr along each axis.
/// Normal equations: sum a a^T over the pairs, a = ( (q - c) x n_j / s, n_j ) with c the mean of the q and s their root mean
/// square distance from it; the condition is the ratio of their largest to their smallest eigenvalue.
///
/// Source    [besl1992method], [chen1992object]; both normals after [rusinkiewicz2019symmetric], compatible ones after
///           [pulli1999multiview]; degenerate surfaces after [gelfand2003geometrically].
/// Cost      one search and about 200 multiplications per point and round. Deterministic: same input, same bytes.
/// Throws    InvalidInput: option out of range, no level, normals and points differ in length, a start that is not finite.
/// Departs   The levels are fixed multiples of pr, not shares of the sorted distances. The rotation between both normals is
///           that of the last round, not shared between the sides. Degenerate surfaces are judged by the point-to-plane
///           equations for both residuals: those of points to points are regular on a plane too, because each point is bound
///           to an arbitrary partner.
RefinedSurface refine_surface(const SurfacePair& surfaces, const RigidTransform& start,
                              const SurfaceOptions& options = {});

}  // namespace corral
