// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/report/figure/panel.h"
#include "apps/results/study_record.h"

namespace corral {

/// The poses of one method that have a probability and a truth.
struct RatedPoses {
  std::string method;
  std::vector<double> probabilities;
  std::vector<bool> right;  ///< one each: whether the refined pose registers the pair
};

/// Of these records of one method, in their order.
RatedPoses rated_poses(const std::string& method, const std::vector<const StudyRecord*>& records);

/// Fills in the reliability curve: the share of right poses, with its Wilson interval of 95 %, for probabilities in tenths; a
/// perfect model has the middle of each tenth. Beside it Brier score, area under the ROC curve, and the calibration error
/// (confidence.h). Methods without a rated pose are left out.
void draw_reliability(const std::vector<RatedPoses>& methods, Panel& panel);

/// Fills in success against coverage: the share of right poses among the most probable tenth, two tenths, ... of all; equal
/// probabilities in the order of the records.
void draw_coverage(const std::vector<RatedPoses>& methods, Panel& panel);

}  // namespace corral
