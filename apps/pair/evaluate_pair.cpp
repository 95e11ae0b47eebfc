// SPDX-License-Identifier: MIT
#include "apps/pair/evaluate_pair.h"

#include <algorithm>
#include <numeric>

#include "apps/runtime/stopwatch.h"
#include "apps/runtime/text_table.h"
#include "kernel/missing_column.h"
#include "kernel/surface/scan/visibility.h"
#include "kernel/surface/search/diameter.h"
#include "kernel/surface/search/nearest_error.h"
#include "kernel/surface/search/nearest_points.h"

namespace corral {
namespace {

/// The errors of an estimate against one of the poses that are right.
PoseErrors errors_against(const RigidTransform& right, const RigidTransform& estimate, const PairTruth& truth,
                          double resolution) {
  PoseErrors errors{rotation_error_deg(estimate, right),
                    translation_error_pr(estimate, right, resolution),
                    point_error(estimate, right, truth.overlap, resolution),
                    {},
                    {}};
  if (errors.points && truth.rmse_points.rows() > 0)
    errors.points->rmse_pr = point_error(estimate, right, truth.rmse_points, resolution)->rmse_pr;
  if (truth.diameter > 0) {
    const PointError whole = *point_error(estimate, right, truth.vertices, truth.diameter);
    errors.add_share = whole.mean_pr;
    errors.mssd_share = whole.max_pr;
    if (truth.tree)
      errors.add_s_share =
          std::min(whole.mean_pr, nearest_error(estimate, right, truth.vertices, *truth.tree) / truth.diameter);
  }
  return errors;
}

}  // namespace

PairTruth pair_truth(const Mesh& source, const Mesh& target, const RigidTransform& target_from_source,
                     double resolution, double threshold_pr) {
  PairTruth truth{target_from_source, points_in_overlap(source.vertices, target, target_from_source, resolution),
                  threshold_pr, source.vertices, corral::diameter(source.vertices)};
  truth.tree = std::make_shared<PointTree>(source.vertices);
  return truth;
}

PairTruth table_truth(const CorrespondenceSet& matches, const RigidTransform& target_from_source, double threshold_pr) {
  const std::vector<bool> labels = label_correct(matches, target_from_source, threshold_pr);
  Points correct(std::count(labels.begin(), labels.end(), true), 3);
  Eigen::Index next = 0;
  for (std::size_t row = 0; row < labels.size(); ++row)
    if (labels[row]) correct.row(next++) = matches.source_points.row(static_cast<Eigen::Index>(row));
  PairTruth truth{target_from_source, std::move(correct), threshold_pr};
  truth.rmse_points = matches.source_points;
  return truth;
}

Points points_in_overlap(const Points& source, const Mesh& target, const RigidTransform& target_from_source,
                         double resolution) {
  return overlap_points(source, PointIndex(target.vertices), target_from_source, kOverlapPointsPr * resolution);
}

PoseErrors pose_errors(const RigidTransform& estimate, const PairTruth& truth, double resolution) {
  const auto distance = [](const PoseErrors& errors) {
    return errors.points ? errors.points->mean_pr : errors.rotation_error_deg;
  };
  PoseErrors nearest = errors_against(truth.target_from_source, estimate, truth, resolution);
  for (const RigidTransform& equal : truth.equals) {
    PoseErrors errors = errors_against(equal, estimate, truth, resolution);
    if (errors.mssd_share) errors.mssd_share = nearest.mssd_share = std::min(*errors.mssd_share, *nearest.mssd_share);
    if (distance(errors) < distance(nearest)) nearest = std::move(errors);
  }
  return nearest;
}

std::vector<RigidTransform> PairTruth::poses() const {
  std::vector<RigidTransform> all = {target_from_source};
  all.insert(all.end(), equals.begin(), equals.end());
  return all;
}

std::vector<std::vector<bool>> labels_of(const CorrespondenceSet& matches, const std::vector<RigidTransform>& poses,
                                         double threshold_pr) {
  std::vector<std::vector<bool>> labels;
  for (const RigidTransform& pose : poses) labels.push_back(label_correct(matches, pose, threshold_pr));
  return labels;
}

std::size_t best_truth(const std::vector<std::vector<bool>>& labels, const Indices& selected) {
  std::size_t best = 0;
  int most = -1;
  for (std::size_t pose = 0; pose < labels.size(); ++pose) {
    const int correct = score_grouping(labels[pose], selected).correct;
    if (correct > most) most = correct, best = pose;
  }
  return best;
}

bool is_registered(const std::optional<PoseErrors>& errors) {
  return errors && errors->points && errors->points->mean_pr <= kSuccessPr;
}

std::string MethodRecord::outcome() const {
  if (!score || !failure.empty()) return "";
  const bool at_first = is_registered(initial_errors), in_the_end = is_registered(errors);
  return in_the_end ? (at_first ? "found" : "saved") : (at_first ? "spoiled" : "lost");
}

MethodStatus MethodRecord::status() const {
  if (!failure.empty()) return {failure_state, failure};
  return status_of(pose);
}

void judge(MethodRecord& record, const CorrespondenceSet& matches, const std::optional<PairTruth>& truth,
           bool is_stated) {
  const GroupingResult& found = record.found;
  if (truth) {
    const auto labels = labels_of(matches, truth->poses(), truth->threshold_pr);
    record.score = score_grouping(labels[best_truth(labels, found.selected)], found.selected);
  }
  const std::optional<RigidTransform> start = is_stated ? found.target_from_source : std::nullopt;
  record.pose = refine_rigid(matches, found.selected, {}, start);
  if (start) {
    record.pose.initial = start;
    if (!record.pose.target_from_source) record.pose.target_from_source = start;
  }
  if (truth) judge_pose(record, *truth, matches.resolution);
}

void judge_pose(MethodRecord& record, const PairTruth& truth, double resolution) {
  if (record.pose.initial) record.initial_errors = pose_errors(*record.pose.initial, truth, resolution);
  if (record.pose.target_from_source) record.errors = pose_errors(*record.pose.target_from_source, truth, resolution);
}

TimedGrouping time_grouping(const GroupFunction& group, const CorrespondenceSet& matches, int repeat) {
  TimedGrouping timed;
  std::vector<double> times;
  for (int call = 0; call < std::max(repeat, 1); ++call) {
    Stopwatch watch;
    GroupingResult found = group(matches);
    times.push_back(watch.lap_ms());
    if (call == 0) timed.found = std::move(found);
  }
  std::sort(times.begin(), times.end());
  timed.time_ms = (times[(times.size() - 1) / 2] + times[times.size() / 2]) / 2;
  return timed;
}

std::string too_large(const ConfiguredGrouper& grouper, int matches, double memory_limit) {
  const double needed = grouper.working_memory ? grouper.working_memory(matches) : 0;
  if (!(needed > memory_limit)) return "";
  return "needs " + fixed(needed / 1e6, 1) + " MB, the limit is " + fixed(memory_limit / 1e6, 1) + " MB";
}

void refine_all_rows(std::vector<MethodRecord>& records, const CorrespondenceSet& matches,
                     const std::optional<PairTruth>& truth) {
  for (MethodRecord& record : records) {
    if (!record.pose.target_from_source) continue;
    record.all_rows = refine_over_all(matches, *record.pose.target_from_source);
    if (truth && record.all_rows->target_from_source)
      record.all_rows_errors = pose_errors(*record.all_rows->target_from_source, *truth, matches.resolution);
  }
}

std::vector<MethodRecord> evaluate_bounds(const CorrespondenceSet& matches, const PairTruth& truth) {
  Indices all(static_cast<std::size_t>(matches.size()));
  std::iota(all.begin(), all.end(), 0);
  const auto each = labels_of(matches, truth.poses(), truth.threshold_pr);
  const std::vector<bool>& labels = each[best_truth(each, all)];
  std::vector<MethodRecord> bounds(2);
  bounds[0].method = "oracle";
  bounds[1].method = "baseline";
  for (const int row : all)
    if (labels[static_cast<std::size_t>(row)]) bounds[0].found.selected.push_back(row);
  bounds[1].found.selected = std::move(all);
  for (MethodRecord& bound : bounds) judge(bound, matches, truth);
  return bounds;
}

MethodRecord evaluate_method(const std::string& name, const ConfiguredGrouper& grouper,
                             const CorrespondenceSet& matches, const std::optional<PairTruth>& truth, int repeat,
                             double memory_limit) {
  MethodRecord record;
  record.method = name;
  record.failure = too_large(grouper, matches.size(), memory_limit);
  if (!record.failure.empty()) {
    record.failure_state = MethodState::TooLarge;
    return record;
  }
  try {
    TimedGrouping timed = time_grouping(grouper.group, matches, repeat);
    record.found = std::move(timed.found);
    record.time_ms = timed.time_ms;
    record.confidence = record.found.confidence;
    judge(record, matches, truth);
  } catch (const MissingColumn& error) {
    record.failure = error.what();
    record.failure_state = MethodState::NotApplicable;
  } catch (const std::exception& error) {
    record.failure = *error.what() ? error.what() : "no reason given";
  }
  return record;
}

}  // namespace corral
