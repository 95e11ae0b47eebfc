// SPDX-License-Identifier: MIT
#include "tests/support/simulated_run.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/disk/file.h"
#include "io/text/csv_file.h"
#include "kernel/number_text.h"
#include "kernel/random.h"

namespace corral::testing {
namespace {

std::vector<StudyLevel> steps(double first, double last, int count) {
  std::vector<StudyLevel> levels;
  for (int i = 0; i < count; ++i)
    levels.push_back(step(std::round(1000 * (first + (last - first) * i / (count - 1))) / 1000));
  return levels;
}

std::vector<StudyLevel> bins(const std::vector<double>& edges) {
  std::vector<StudyLevel> levels;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) levels.push_back(bin(edges[i], edges[i + 1]));
  return levels;
}

ExperimentInfo& add_info(StudyFolder& run, const std::string& name, const std::string& dataset) {
  ExperimentInfo& info = run.experiments.emplace_back();
  info.name = info.title = info.axis = name;
  info.attribute = name;
  info.dataset = dataset;
  info.figure = std::string(1, static_cast<char>('a' + static_cast<int>(run.experiments.size()) - 1));
  info.methods = all_methods();
  return info;
}

}  // namespace

const std::vector<std::string>& all_methods() {
  static const std::vector<std::string> methods = {"ss", "nnsr", "ransac", "st", "gc", "hough", "si"};
  return methods;
}

StudyLevel step(double value) { return {to_text(value), value, value}; }

StudyLevel bin(double low, double high) { return {"[" + to_text(low) + "," + to_text(high) + ")", low, high}; }

void add_experiment(StudyFolder& run, const SimulatedExperiment& experiment) {
  add_info(run, experiment.name, experiment.dataset).levels = experiment.levels;
  for (const StudyLevel& level : experiment.levels)
    for (int pair = 0; pair < experiment.pairs; ++pair)
      for (const std::string& method : all_methods()) {
        StudyRecord& record = run.records.emplace_back();
        record.experiment = experiment.name;
        record.dataset = experiment.dataset;
        record.level = level.label;
        record.pair = "pair" + std::to_string(pair) + (experiment.same_pairs ? "" : " at " + level.label);
        record.method = method;
        record.status = {MethodState::Refined};
        record.value = level.middle();
        record.matches = 1000;
        record.true_matches = std::max(1, static_cast<int>(std::lround(1000 * experiment.inlier_ratio)));
        const Scores scores = experiment.scores(method, level, pair);
        record.precision = scores.precision;
        record.recall = scores.recall;
        record.f1 = scores.f1();
        record.selected = 100;
        record.correct = static_cast<int>(std::lround(100 * scores.precision));
        record.frame_share = 0.5;
        record.refined.mean_error_pr = scores.precision > 0.5 ? 1.0 : 20.0;
        record.selection = "selections/" + experiment.dataset + "/" + std::to_string(pair) + ".csv";
        StudyPair& files = run.pairs[experiment.dataset + "/" + record.pair];
        files.source = "model" + std::to_string(pair % 4) + ".ply";
        files.source_points = 50000;
        files.source_keypoints = 500 + 10 * pair;
      }
}

void add_times(StudyFolder& run, const std::vector<double>& sizes,
               const std::function<double(const std::string& method, double size)>& time_ms) {
  ExperimentInfo& info = add_info(run, "time", "u3or");
  for (const double size : sizes) info.levels.push_back(step(size));
  for (const StudyLevel& level : info.levels)
    for (const std::string& method : all_methods())
      for (int repeat = 0; repeat < 3; ++repeat) {
        StudyRecord& record = run.records.emplace_back();
        record.experiment = "time";
        record.dataset = info.dataset;
        record.level = level.label;
        record.pair = "pair0";
        record.method = method;
        record.repeat = repeat;
        record.value = level.low;
        record.matches = static_cast<int>(level.low);
        record.time_ms = time_ms(method, level.low);
      }
}

StudyFolder simulated_study(std::uint64_t seed, int pairs) {
  StudyFolder run;
  const auto add = [&](const std::string& name, const std::string& dataset, const std::vector<StudyLevel>& levels,
                       double inlier_ratio) {
    SimulatedExperiment experiment{name, dataset, levels, pairs, name == "threshold", inlier_ratio, {}};
    experiment.scores = [&, name](const std::string& method, const StudyLevel& level, int pair) {
      // A threshold only lets more matches count as right: one draw for all of its levels.
      RandomStream stream(
          derive_seed(seed, name + method + std::to_string(pair) + (name == "threshold" ? "" : level.label)));
      const double precision = stream.uniform(), recall = stream.uniform();
      return Scores{name == "threshold" ? precision * level.middle() / 10 : precision, recall};
    };
    add_experiment(run, experiment);
  };
  add("noise", "b3r", steps(0.05, 0.45, 9), 0.6);
  add("density", "b3r", steps(0.9, 0.1, 9), 0.4);
  add("clutter", "u3or", bins({65, 70, 75, 80, 85, 90, 95}), 0.05);
  add("occlusion", "u3or", bins({60, 65, 70, 75, 80, 85, 95}), 0.05);
  add("overlap", "u3m", bins({30, 40, 50, 60, 70, 80, 90}), 0.1);
  add("threshold", "u3or", steps(1, 10, 10), 0.05);
  add("matches", "u3or", bins({0, 500, 1000, 1500, 2000, 3000, 100000}), 0.05);
  add_times(run, {250, 500, 1000, 1500, 2000, 3000}, [](const std::string& method, double size) {
    const auto place = std::find(all_methods().begin(), all_methods().end(), method) - all_methods().begin();
    return (1.0 + static_cast<double>(place)) * size * size * 1e-6;
  });
  return run;
}

std::string manifest_text(const StudyFolder& run) {
  nlohmann::json manifest = {{"experiments", nlohmann::json::array()}, {"pairs", nlohmann::json::object()}};
  for (const ExperimentInfo& info : run.experiments) {
    nlohmann::json levels = nlohmann::json::array();
    for (const StudyLevel& level : info.levels)
      levels.push_back({{"label", level.label}, {"low", level.low}, {"high", level.high}});
    manifest["experiments"].push_back({{"name", info.name},
                                       {"title", info.title},
                                       {"figure", info.figure},
                                       {"dataset", info.dataset},
                                       {"attribute", info.attribute},
                                       {"axis", info.axis},
                                       {"levels", levels},
                                       {"methods", info.methods},
                                       {"foreign_methods", nlohmann::json::array()},
                                       {"threshold_pr", info.threshold_pr},
                                       {"least_true_matches", info.least_true_matches}});
  }
  for (const auto& [name, pair] : run.pairs) {
    manifest["pairs"][name] = {
        {"source", pair.source}, {"target", pair.target}, {"truth", pair.truth}, {"resolution", pair.resolution}};
    if (pair.source_points) manifest["pairs"][name]["source_points"] = *pair.source_points;
    if (pair.source_keypoints) manifest["pairs"][name]["source_keypoints"] = *pair.source_keypoints;
  }
  return manifest.dump();
}

void write_run(const StudyFolder& run) {
  std::string records = csv_line(record_columns());
  std::map<std::string, std::string> selections;
  for (const StudyRecord& record : run.records) {
    records += record_line(record);
    if (record.selection.empty()) continue;
    PairSelections pair{{0, 1, 2}, {0, 1, 2}, {}, {}};
    for (const std::string& method : all_methods()) pair.selected[method] = {0, 1};
    selections[record.selection] = selections_text(pair, all_methods());
  }
  std::vector<FileContent> files = {{run.folder + "/manifest.json", manifest_text(run)},
                                    {run.folder + "/records.csv", records}};
  for (const auto& [path, text] : selections) files.push_back({run.folder + "/" + path, text});
  for (const FileContent& file : files) make_folder(file.path.substr(0, file.path.rfind('/')));
  write_files(files);
}

}  // namespace corral::testing
