// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "kernel/rigid_transform.h"

namespace corral {

/// What a view contributes to an alignment: where its points are and how far they extend. With both, errors in rotation and
/// in translation become one length: how far the points of the view are moved.
struct View {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< mean of its points, in its own coordinates, mesh units
  double radius = 1;                                 ///< root mean square distance of its points from the center
};

/// The center and radius of the points of a view. Throws InvalidInput if they all coincide, or if there are none.
View view_of(const Points& points);

/// A measured pose between two views.
struct ViewPair {
  int a = 0, b = 0;
  RigidTransform b_from_a;
  double weight = 1;  ///< above 0; its confidence relative to others, such as the overlap
};

struct MultiviewOptions {
  double limit_pr = 3;  ///< a pair agrees if it moves the points of its first view by at most this (root mean square)
  int maximum_iterations = 200;  ///< of each call of Ceres
};

/// Whether the alignment of all views confirms a pair.
enum class PairVerdict {
  Agrees,       ///< within the limit, and other pairs connect a and b too
  Contradicts,  ///< beyond the limit
  Unchecked,    ///< no other pairs connect a and b
};

/// "agrees", "contradicts", "unchecked".
const char* to_text(PairVerdict verdict);

struct PairJudgement {
  PairVerdict verdict = PairVerdict::Unchecked;
  double error_pr = 0;   ///< how far it moves the points of view a from where the alignment puts them
  int loops = 0;         ///< loops of three pairs that it is part of
  int closed_loops = 0;  ///< of these, loops whose motion is the identity, within the limit of three pairs
};

struct MultiviewAlignment {
  std::vector<RigidTransform> world_from_view;  ///< per view; the first view of each part defines the world of the part
  std::vector<int> part;             ///< per view: views that no pair connects are in different parts, from 0
  std::vector<PairJudgement> pairs;  ///< per pair, in the order given
  bool converged = true;
};

/// Aligns views from poses between pairs of them, some of which may be wrong.
///
///   minimise  sum over pairs  w rho( (|r theta|^2 + |d|^2) / limit^2 )
///
/// over one pose per view. The pair (a, b) predicts where the points of a lie in b; theta is the angle between prediction
/// and alignment, d the offset between the two images of the center of a, r the radius of a, rho(s) = log(1 + s).
///
/// The start is, of 500 spanning trees of pairs, the one with which pairs of the largest total weight agree: the tree of the
/// pairs with the most closed loops of three, and random trees that prefer such pairs. Pairs beyond the limit are excluded,
/// and the rest are aligned again, until no verdict changes.
/// Source    [govindu2006robustness] for random trees, [huber2003fully] for verdicts by consistency, [choi2015robust] for a
///           pose graph with switched pairs.
/// Cost      O(pairs^2) for the loops, 500 trees. Ceres, one thread. Deterministic: same input, same bytes.
/// Throws    InvalidInput: option or weight out of range, a pair of no or of one view, a pose that is not rigid.
/// Departs   A pair is judged by one length, not by an angle and a distance; a pair that fails is left out, not switched off
///           by a variable.
MultiviewAlignment align_views(const std::vector<View>& views, const std::vector<ViewPair>& pairs, double resolution,
                               const MultiviewOptions& options = {});

}  // namespace corral
