// SPDX-License-Identifier: MIT
#include "tests/support/study_run.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/pair/evaluate_pair.h"
#include "apps/pair/match_pair.h"
#include "io/disk/file.h"
#include "io/mesh/mesh_file.h"
#include "io/pose/transform_file.h"
#include "io/text/csv_file.h"
#include "kernel/number_text.h"

namespace corral::testing {
namespace {

using Json = nlohmann::ordered_json;

PoseScores scores_of(const std::optional<PoseErrors>& errors) {
  PoseScores scores;
  if (!errors) return scores;
  scores.rotation_error_deg = errors->rotation_error_deg;
  scores.translation_error_pr = errors->translation_error_pr;
  if (errors->points) scores.mean_error_pr = errors->points->mean_pr;
  return scores;
}

StudyRecord record_of(const MethodRecord& method) {
  StudyRecord record;
  record.method = method.method;
  record.status = method.status();
  record.matches = method.score->matches;
  record.true_matches = method.score->true_matches;
  record.selected = method.score->selected;
  record.correct = method.score->correct;
  record.precision = method.score->precision;
  record.recall = method.score->recall;
  record.f1 = method.score->f1;
  record.initial = scores_of(method.initial_errors);
  record.refined = scores_of(method.errors);
  record.time_ms = method.time_ms;
  return record;
}

/// Everything of one pair; writes its meshes and selections.
std::vector<StudyRecord> run_case(const std::string& folder, const ExperimentInfo& experiment, const StudyCase& pair,
                                  StudyPair& files) {
  make_folder(folder + "/meshes");
  make_folder(folder + "/selections");
  files = {folder + "/meshes/" + pair.name + "-source.ply",
           folder + "/meshes/" + pair.name + "-target.ply",
           folder + "/meshes/" + pair.name + ".txt",
           1,
           {},
           {}};
  write_mesh(files.source, pair.source);
  write_mesh(files.target, pair.target);
  write_file(files.truth, transform_text(pair.truth));
  const MatchedPair matched = match_pair(pair.source, pair.target, {});
  files.resolution = matched.matches.resolution;
  const PairTruth truth =
      pair_truth(pair.source, pair.target, pair.truth, matched.matches.resolution, experiment.threshold_pr);
  std::vector<MethodRecord> answers;
  for (const std::string& name : experiment.methods)
    answers.push_back(evaluate_method(name, find_grouper(name).configure({}), matched.matches, truth, 1));
  for (MethodRecord& bound : evaluate_bounds(matched.matches, truth)) answers.push_back(std::move(bound));

  PairSelections selections{matched.matches.source_keypoints, matched.matches.target_keypoints, {}, {}};
  const Points moved = pair.truth.apply(matched.matches.source_points);
  for (Eigen::Index row = 0; row < moved.rows(); ++row)
    selections.residual_pr.push_back((moved.row(row) - matched.matches.target_points.row(row)).norm() /
                                     matched.matches.resolution);
  std::vector<StudyPose> poses;
  std::vector<StudyRecord> records;
  std::vector<std::string> names;
  for (const MethodRecord& answer : answers) {
    names.push_back(answer.method);
    selections.selected[answer.method] = answer.found.selected;
    if (answer.pose.initial) poses.push_back({answer.method, "initial", *answer.pose.initial});
    if (answer.pose.target_from_source) poses.push_back({answer.method, "refined", *answer.pose.target_from_source});
    records.push_back(record_of(answer));
    records.back().selection = "selections/" + pair.name + ".csv";
  }
  write_file(folder + "/selections/" + pair.name + ".csv", selections_text(selections, names));
  write_file(folder + "/selections/" + pair.name + ".poses.csv", poses_text(poses));
  return records;
}

}  // namespace

void put_run(const std::string& folder, const ExperimentInfo& experiment, const std::vector<StudyCase>& cases) {
  Json pairs = Json::object(), levels = Json::array();
  for (const StudyLevel& level : experiment.levels)
    levels.push_back({{"label", level.label}, {"low", level.low}, {"high", level.high}});
  std::vector<StudyRecord> records;
  for (const StudyCase& pair : cases) {
    StudyPair files{"missing.ply", "missing.ply", "", 0, {}, {}};
    std::vector<StudyRecord> found(experiment.methods.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      found[i].method = experiment.methods[i];
      found[i].status = {MethodState::Failed, "no vertices"};
    }
    if (pair.source.vertices.rows() > 0) found = run_case(folder, experiment, pair, files);
    pairs[experiment.dataset + "/" + pair.name] = {
        {"source", files.source}, {"target", files.target}, {"truth", files.truth}, {"resolution", files.resolution}};
    for (StudyRecord& record : found) {
      record.experiment = experiment.name;
      record.dataset = experiment.dataset;
      record.level = pair.level;
      record.pair = pair.name;
      records.push_back(record);
    }
  }
  std::string table = csv_line(record_columns());
  for (const StudyRecord& record : records) table += record_line(record);
  const Json manifest = {{"version", "0.2.0"},
                         {"command", "corral evaluate " + experiment.name + " --data data -o run"},
                         {"machine", {{"processor", "test"}, {"cores", 2}}},
                         {"experiments",
                          {{{"name", experiment.name},
                            {"title", experiment.title},
                            {"figure", experiment.figure},
                            {"dataset", experiment.dataset},
                            {"attribute", experiment.attribute},
                            {"axis", experiment.axis},
                            {"levels", levels},
                            {"methods", experiment.methods},
                            {"foreign_methods", Json::array()},
                            {"threshold_pr", experiment.threshold_pr},
                            {"least_true_matches", experiment.least_true_matches}}}},
                         {"pairs", pairs}};
  write_files({{folder + "/manifest.json", manifest.dump(1)}, {folder + "/records.csv", table}});
}

}  // namespace corral::testing
