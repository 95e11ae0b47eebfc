// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/align/view_set.h"
#include "refine/multiview.h"

namespace corral {

struct AlignOptions {
  double least_overlap = 0.2;    ///< of two views that are paired
  double most_in_front = 0.015;  ///< share of a view's points that the other may contradict
  MultiviewOptions graph;
};

/// A pose between two views and what speaks for it.
struct AlignedPair {
  ViewPair pose;
  ViewAgreement agreement;  ///< under this pose
  bool predicted = false;   ///< laid from where the alignment has the views, not from matches
  PairJudgement judgement;
};

struct AlignedViews {
  std::vector<RigidTransform> world_from_view;  ///< the first view of each part is the world of the part
  std::vector<int> part;                        ///< per view: views that no pair connects are in different parts
  std::vector<AlignedPair> pairs;               ///< in the order of a, b
  bool converged = true;

  RigidTransform between(int a, int b) const;  ///< b_from_a
};

/// Called when a step begins: what it is, and its share of the whole.
using AlignObserver = std::function<void(const std::string& what, double steps)>;
double align_steps(int views);  ///< all shares together, about

/// Aligns views of one object without any knowledge of where they were taken.
///
/// Every pair is matched as the paper does; the poses of several groupers are refined, and lay the whole surfaces on each
/// other. What one view contradicts (points in front of what it saw) is no pose; of the others the one with the largest
/// overlap counts, if it reaches `least_overlap`. A pose graph (align_views) judges these pairs, each weighted by its
/// overlap. Then pairs that do not agree, or had no pose, are laid on each other from where the graph has them, and the
/// graph is solved again with what that adds, until nothing is added.
///
/// Source    [huber2003fully] for visibility and a pose graph; the groupers are those of grouping/registry.h.
/// Returns   pairs that contradict too, for somebody to look at. Deterministic for any number of threads.
AlignedViews align_view_set(const ViewSet& views, const AlignOptions& options, const ParallelFor& parallel,
                            const AlignObserver& observer = {});

/// The same with poses between the views that are given: no other is looked for.
AlignedViews align_view_set(const ViewSet& views, const std::vector<ViewPair>& poses, const AlignOptions& options);

}  // namespace corral
