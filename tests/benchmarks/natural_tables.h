// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "kernel/correspondence_set.h"
#include "tests/benchmarks/workload.h"

namespace corral::benchmarks {

/// Matches between a mesh and a scene, all columns filled. The scene is three tenths of the mesh, moved, with noise of
/// 0.3 pr: most matches are wrong, as they are when a model is looked for in a view.
struct NaturalTable {
  std::string mesh;
  CorrespondenceSet matches;
  double inlier_ratio = 0;  ///< share of matches within 4 pr of the truth
};

/// Tables of these sizes (ascending), as far as the mesh has vertices for them. Each holds rows evenly spread over all
/// matches of the coarsest keypoints that give enough: Harris from 3 pr down to 1.5 pr, then uniform ones.
std::vector<NaturalTable> natural_tables(Workload& load, const std::vector<int>& sizes);

}  // namespace corral::benchmarks
