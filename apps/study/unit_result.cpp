// SPDX-License-Identifier: MIT
// The answer of a unit as JSON: numbers read back as the same doubles.
#include "apps/results/measures.h"
#include "apps/runtime/json.h"
#include "apps/study/evaluate_unit.h"
#include "kernel/error.h"

namespace corral {
namespace {

std::optional<double> number_of(const Json& json) {
  return json.is_null() ? std::nullopt : std::optional<double>(json.get<double>());
}

int count_of(const Json& json) {
  constexpr std::int64_t kMost = 1'000'000'000;  // what records.csv takes
  const std::int64_t count = json.is_number_integer() ? json.get<std::int64_t>() : -1;
  if (count < 0 || count > kMost) throw InvalidInput("unit_result", "count", json.dump(), "0 .. 1000000000");
  return static_cast<int>(count);
}

std::vector<int> counts_of(const Json& json) {
  std::vector<int> counts;
  counts.reserve(json.size());
  for (const Json& count : json) counts.push_back(count_of(count));
  return counts;
}

Json to_json(const PoseScores& scores) {
  Json json = Json::array();
  for (const PoseMeasure& measure : pose_measures()) json.push_back(json_or_null<double>(scores.*measure.score));
  return json;
}

PoseScores pose_scores_of(const Json& json) {
  PoseScores scores;
  std::size_t place = 0;
  for (const PoseMeasure& measure : pose_measures()) scores.*measure.score = number_of(json.at(place++));
  return scores;
}

Json to_json(const TaskResult& task) {
  return {{"status", to_text(task.status)},
          {"selected", json_or_null(task.selected)},
          {"correct", task.correct},
          {"true_matches", task.true_matches},
          {"initial", to_json(task.initial)},
          {"refined", to_json(task.refined)},
          {"all_rows", to_json(task.all_rows)},
          {"dense", to_json(task.dense)},
          {"time_ms", json_or_null(task.time_ms)},
          {"stated_time_ms", json_or_null(task.stated_time_ms)},
          {"confidence", json_or_null(task.confidence)}};
}

TaskResult task_of(const Json& json) {
  TaskResult task;
  const std::string status = json.at("status");
  const std::optional<MethodStatus> known = parse_status(status);
  if (!known) throw InvalidInput("unit_result", "status", status, "a status of a grouper");
  task.status = *known;
  if (!json.at("selected").is_null()) task.selected = count_of(json.at("selected"));
  task.correct = counts_of(json.at("correct"));
  task.true_matches = counts_of(json.at("true_matches"));
  task.initial = pose_scores_of(json.at("initial"));
  task.refined = pose_scores_of(json.at("refined"));
  task.all_rows = pose_scores_of(json.at("all_rows"));
  task.dense = pose_scores_of(json.at("dense"));
  task.time_ms = number_of(json.at("time_ms"));
  task.stated_time_ms = number_of(json.at("stated_time_ms"));
  task.confidence = number_of(json.at("confidence"));
  return task;
}

}  // namespace

UnitResult unit_result_of(const Json& json) {
  UnitResult result;
  result.failure = json.at("failure");
  result.resolution = json.at("resolution");
  result.source_points = count_of(json.at("source_points"));
  result.source_keypoints = count_of(json.at("source_keypoints"));
  result.matches = count_of(json.at("matches"));
  const Json& seen = json.at("keypoints_in_overlap");
  if (!seen.is_null()) result.keypoints_in_overlap = count_of(seen);
  result.has_truth = json.at("has_truth");
  result.truth = json.at("truth");
  result.truth_text = json.at("truth_text");
  result.warnings = json.at("warnings").get<std::vector<std::string>>();
  result.true_matches = counts_of(json.at("true_matches"));
  for (const Json& share : json.at("frame_share")) result.frame_share.push_back(number_of(share));
  result.tasks.reserve(json.at("tasks").size());
  for (const Json& task : json.at("tasks")) result.tasks.push_back(task_of(task));
  for (const Json& oracle : json.at("oracles")) result.oracles.push_back(task_of(oracle));
  if (!json.at("baseline").is_null()) result.baseline = task_of(json.at("baseline"));
  return result;
}

Json to_json(const UnitResult& result) {
  Json tasks = Json::array(), oracles = Json::array(), frames = Json::array();
  for (const TaskResult& task : result.tasks) tasks.push_back(to_json(task));
  for (const TaskResult& oracle : result.oracles) oracles.push_back(to_json(oracle));
  for (const auto& share : result.frame_share) frames.push_back(json_or_null(share));
  return Json{{"failure", result.failure},
              {"resolution", result.resolution},
              {"source_points", result.source_points},
              {"source_keypoints", result.source_keypoints},
              {"matches", result.matches},
              {"keypoints_in_overlap", json_or_null(result.keypoints_in_overlap)},
              {"has_truth", result.has_truth},
              {"truth", result.truth},
              {"truth_text", result.truth_text},
              {"warnings", result.warnings},
              {"true_matches", result.true_matches},
              {"frame_share", frames},
              {"tasks", tasks},
              {"oracles", oracles},
              {"baseline", result.baseline ? to_json(*result.baseline) : Json(nullptr)}};
}

}  // namespace corral
