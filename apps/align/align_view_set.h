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
  double most_in_front = 0.015;  ///< largest share of a view's points that the other may contradict
  MultiviewOptions graph;
};

/// A pose between two views and the evidence for it.
struct AlignedPair {
  ViewPair pose;
  ViewAgreement agreement;  ///< under this pose
  bool predicted = false;   ///< found from the pose of the alignment, not from matches
  PairJudgement judgement;
  std::optional<double> confidence;  ///< probability that a pose found from matches registers the pair (confidence.h)
};

struct AlignedViews {
  std::vector<RigidTransform> world_from_view;  ///< the first view of each part defines the world of the part
  std::vector<int> part;                        ///< per view: views that no pair connects are in different parts
  std::vector<AlignedPair> pairs;               ///< in the order of a, b
  bool converged = true;

  RigidTransform between(int a, int b) const;  ///< b_from_a
};

/// Called when a step begins, with its name and its share of the work.
using AlignObserver = std::function<void(const std::string& what, double steps)>;
double align_steps(int views);  ///< approximate sum of all shares

/// Aligns views of one object without any knowledge of where they were taken.
///
/// Every pair is matched as in the paper and registered as by register_pair; the pose is kept if it is more
/// probable than not, its overlap reaches `least_overlap` and no view contradicts it (it puts points in front of what the view saw). A pose graph (align_views) judges these pairs,
/// each weighted by its overlap. Then pairs that do not agree, or had no pose, are aligned from the poses of the graph, and
/// the graph is solved again with the added pairs, until none is added.
///
/// Source    [huber2003fully] for visibility and a pose graph; the groupers are those of grouping/registry.h.
/// Returns   contradicting pairs too, for inspection. Deterministic for any number of threads.
AlignedViews align_view_set(const ViewSet& views, const AlignOptions& options, const ParallelFor& parallel,
                            const AlignObserver& observer = {});

/// The same with given poses between the views; no others are searched for.
AlignedViews align_view_set(const ViewSet& views, const std::vector<ViewPair>& poses, const AlignOptions& options);

}  // namespace corral
