// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/pair/method_status.h"
#include "grouping/registry.h"
#include "kernel/evaluation.h"
#include "kernel/surface/mesh/mesh.h"
#include "refine/refine_rigid.h"
#include "refine/refine_surface.h"

namespace corral {

class PointTree;

/// The ground truth of a pair.
struct PairTruth {
  RigidTransform target_from_source;
  Points overlap;                           ///< source points over which a pose is judged; may be empty
  double threshold_pr = 4;                  ///< largest residual of a correct match
  Points vertices{};                        ///< all source vertices; empty where the mesh is not available
  double diameter = 0;                      ///< of these, mesh units
  Points rmse_points{};                     ///< over which the RMSE is taken, if not over the overlap
  std::vector<RigidTransform> equals{};     ///< further poses that are as right as the first
  std::shared_ptr<const PointTree> tree{};  ///< of the vertices; null where the mesh is not available

  /// The first, then its equals.
  std::vector<RigidTransform> poses() const;
};

/// Which matches each of these poses makes correct.
std::vector<std::vector<bool>> labels_of(const CorrespondenceSet& matches, const std::vector<RigidTransform>& poses,
                                         double threshold_pr);

/// The place of the pose under which most of the selected rows are correct, the first of several.
std::size_t best_truth(const std::vector<std::vector<bool>>& labels, const Indices& selected);
/// The same with the overlap of the two surfaces and the extent of the source. `resolution`: mesh units per pr.
PairTruth pair_truth(const Mesh& source, const Mesh& target, const RigidTransform& target_from_source,
                     double resolution, double threshold_pr);

/// Of a table without surfaces: a pose is judged over the source points of the correct matches, its RMSE over those of all.
PairTruth table_truth(const CorrespondenceSet& matches, const RigidTransform& target_from_source, double threshold_pr);

/// The source points whose true image has a target vertex within 4 pr.
Points points_in_overlap(const Points& source, const Mesh& target, const RigidTransform& target_from_source,
                         double resolution);

/// The errors of a pose; those without points to average over are absent.
struct PoseErrors {
  double rotation_error_deg = 0, translation_error_pr = 0;
  std::optional<PointError> points;  ///< over the overlap
  std::optional<double> add_share;   ///< mean distance of all source vertices, in diameters of the source (ADD)
  std::optional<double> mssd_share;  ///< the largest of these distances, over the poses that are right the least (MSSD)
  std::optional<double> add_s_share = {};  ///< as ADD, with the distance to the nearest vertex (ADD-S, nearest_error.h)
};
/// Against the nearest of the poses that are right: that with the least mean error, or without points the least rotation error.
PoseErrors pose_errors(const RigidTransform& estimate, const PairTruth& truth, double resolution);

constexpr double kSuccessPr = 5;          ///< most mean error over the overlap of a pose that registers a pair
constexpr double kSuccessAddShare = 0.1;  ///< a pose recognises an object if its ADD, or ADD-S, is below this

/// Whether a pose registers the pair: it exists, and its PointError::mean_pr is at most kSuccessPr.
bool is_registered(const std::optional<PoseErrors>& errors);

/// One grouper on one pair. What could not be computed is absent.
struct MethodRecord {
  std::string method;
  std::string failure;                              ///< why the grouper gave no answer; empty if it did
  MethodState failure_state = MethodState::Failed;  ///< or TooLarge: it was not called; or NotApplicable
  GroupingResult found;
  std::optional<double> time_ms;         ///< median of the timed calls, the grouping alone
  std::optional<double> stated_time_ms;  ///< what another program says that it took
  std::optional<double> confidence;    ///< probability that the refined pose registers the pair, where it was asked for
  std::optional<GroupingScore> score;  ///< with a truth
  RefinedPose pose;
  std::optional<PoseErrors> initial_errors;   ///< of the least-squares fit to the selection, with a truth
  std::optional<PoseErrors> errors;           ///< of the refined pose, with a truth
  std::optional<RefinedPose> all_rows;        ///< from the refined pose over all matches, where it was asked for
  std::optional<PoseErrors> all_rows_errors;  ///< of its pose, with a truth
  std::optional<RefinedSurface> dense;        ///< from the refined pose, where it was asked for
  std::optional<PoseErrors> dense_errors;     ///< of its pose, with a truth

  /// "found": both the fit to the selection and the refined pose register the pair. "saved": only the refined pose does.
  /// "spoiled": only the fit does. "lost": neither does. Empty without a truth or an answer.
  std::string outcome() const;

  MethodStatus status() const;
};

/// The median wall time of `repeat` calls (at least 1) and the result of the first.
struct TimedGrouping {
  GroupingResult found;
  double time_ms = 0;
};
TimedGrouping time_grouping(const GroupFunction& group, const CorrespondenceSet& matches, int repeat);

/// Why a grouper may not be called with this many matches: "needs 800.0 MB, the limit is 512.0 MB". Empty if it may.
std::string too_large(const ConfiguredGrouper& grouper, int matches, double memory_limit);

/// Scores what was found, refines its pose and judges it. A pose in `found` that `is_stated` by another program is the start
/// of the refinement in place of the fit, and stands where the refinement has none.
void judge(MethodRecord& record, const CorrespondenceSet& matches, const std::optional<PairTruth>& truth,
           bool is_stated = false);

/// Fills in the errors of the refined pose and of its start.
void judge_pose(MethodRecord& record, const PairTruth& truth, double resolution);

/// The words of --rows and --select; the first is the default.
constexpr std::array<const char*, 2> kRows = {"selected", "all"}, kSelect = {"score", "surface"};

/// Fills `all_rows` of every record that has a refined pose (refine_over_all), and with a truth its errors.
void refine_all_rows(std::vector<MethodRecord>& records, const CorrespondenceSet& matches,
                     const std::optional<PairTruth>& truth);

/// The selections of a perfect grouper and of none: "oracle" selects all correct matches, "baseline" all matches. Scored,
/// refined and judged as those of the groupers, without a time.
std::vector<MethodRecord> evaluate_bounds(const CorrespondenceSet& matches, const PairTruth& truth);

/// Groups, scores, refines and judges. If the grouper refuses the table, or needs more bytes than the limit, the record says
/// so.
MethodRecord evaluate_method(const std::string& name, const ConfiguredGrouper& grouper,
                             const CorrespondenceSet& matches, const std::optional<PairTruth>& truth, int repeat,
                             double memory_limit = std::numeric_limits<double>::infinity());

}  // namespace corral
