// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "kernel/correspondence_set.h"
#include "kernel/rigid_transform.h"

namespace corral {

/// Which matches are correct: label i is true iff |T p_i - q_i| <= threshold, T the ground truth (inclusive).
///
/// Source    [yang2017evaluation], threshold 4 pr.
/// Throws    InvalidInput: invalid table, or a threshold that is not finite and >= 0.
std::vector<bool> label_correct(const CorrespondenceSet& matches, const RigidTransform& target_from_source,
                                double threshold_pr);

/// Precision and recall of one selection; a ratio whose denominator is zero is absent, never 0.
struct GroupingScore {
  int matches = 0;
  int selected = 0;
  int correct = 0;                  ///< correct matches among the selected
  int true_matches = 0;             ///< correct matches in the table
  std::optional<double> precision;  ///< correct / selected
  std::optional<double> recall;     ///< correct / true_matches
  std::optional<double> f1;         ///< 2 correct / (selected + true_matches), their harmonic mean; absent as recall is
};

/// Throws    InvalidInput if a selected row is out of range or the rows do not ascend strictly.
GroupingScore score_grouping(const std::vector<bool>& labels, const Indices& selected);

/// How repeatable the local frames of correct matches are: groupers that use frames depend on it.
struct FrameRepeatability {
  int compared = 0;  ///< correct matches with a frame on both sides
  int agreeing = 0;  ///< of these, matches whose frames agree within the limit under the true rotation
  std::optional<double> share() const;
};

/// The limit is on the angle between the frames, in degrees (10 in the field). Nothing is compared without frame columns.
FrameRepeatability frame_repeatability(const CorrespondenceSet& matches, const RigidTransform& target_from_source,
                                       const std::vector<bool>& labels, double limit_deg = 10);

/// Angle of estimate * truth^-1 in degrees, 0 .. 180; accurate near both ends (no arc cosine of a trace).
double rotation_error_deg(const RigidTransform& estimate, const RigidTransform& truth);

/// |t_estimate - t_truth| in pr.
double translation_error_pr(const RigidTransform& estimate, const RigidTransform& truth, double resolution);

/// How far an estimate carries points from where the truth carries them: |T_estimate x - T_truth x| in pr.
struct PointError {
  double rmse_pr = 0;  ///< root mean square over the points
  double mean_pr = 0;  ///< mean over the points (what published "RMSE" curves of the field show)
  double max_pr = 0;   ///< over the points
};

/// Over N points in the source (rows); absent if there are none.
std::optional<PointError> point_error(const RigidTransform& estimate, const RigidTransform& truth, const Points& points,
                                      double resolution);

/// The thresholds of success curves: 0.5, 1.0 .. 5.0 pr. A pair is registered if its error is at most the last.
const std::vector<double>& success_thresholds_pr();

/// One point of the success curve per threshold: the share of pairs whose error is at most the threshold (inclusive). An
/// absent error (no pose) or NaN is a failure at every threshold.
///
/// Source    U3M's success curves; errors are PointError::mean_pr, as the published ones are.
/// Throws    InvalidInput if there is no pair: the share is then undefined.
std::vector<double> success_curve(const std::vector<std::optional<double>>& errors_pr,
                                  const std::vector<double>& thresholds_pr = success_thresholds_pr());

/// The area under the success curve, 0 (no pair registered) .. 1 (every error is 0): the trapezoid rule on its points at
/// 0 and at success_thresholds_pr(), over the 5 pr that they span. Throws as success_curve.
double success_area(const std::vector<std::optional<double>>& errors_pr);

}  // namespace corral
