// SPDX-License-Identifier: MIT
#include <cstdio>

#include "grouping/geometric_consistency.h"
#include "kernel/synthetic.h"
#include "refine/refine_rigid.h"

int main() {
  corral::SyntheticOptions options;
  options.noise_pr = 0;
  const corral::SyntheticProblem problem = corral::make_synthetic_problem(options);
  const corral::GroupingResult found = corral::group_by_geometric_consistency(problem.matches);
  const corral::RefinedPose pose = corral::refine_rigid(problem.matches, found.selected);
  if (!pose.target_from_source) return 1;
  const double error = (pose.target_from_source->rotation - problem.truth.rotation).norm();
  std::printf("%zu selected, rotation off by %.3g\n", found.selected.size(), error);
  return error < 1e-3 ? 0 : 1;
}
