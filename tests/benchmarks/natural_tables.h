// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "kernel/correspondence_set.h"
#include "tests/benchmarks/workload.h"

namespace corral::benchmarks {

/// Matches between a mesh and a scene, all columns filled. The scene is the mesh, moved, with noise of 0.3 pr: many matches
/// are right, as they are in the noise experiment of the paper. Or it is three tenths of that: most are wrong, as they are
/// when a model is looked for in a view.
struct NaturalTable {
  std::string scene;  ///< the name of the mesh, and ":part"
  CorrespondenceSet matches;
  double inlier_ratio = 0;  ///< share of matches within 4 pr of the truth
};

/// Tables of both scenes and of these sizes (ascending), as far as the mesh has vertices for them. Each holds rows evenly spread over all
/// matches of the coarsest keypoints that give enough: Harris from 3 pr down to 1.5 pr, then uniform ones.
std::vector<NaturalTable> natural_tables(Workload& load, const std::vector<int>& sizes);

/// Uses the same rows in another order with each call, some 16,000 rows in all: of one small table that is seen again and
/// again a processor learns by heart which way each comparison of a sort goes.
std::function<void()> in_turn(const CorrespondenceSet& matches, std::function<void(const CorrespondenceSet&)> use);

}  // namespace corral::benchmarks
