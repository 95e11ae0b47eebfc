// SPDX-License-Identifier: MIT
// simulate_study FOLDER PAIRS GROUPERS [EXPERIMENT...]: the folder of a study that nobody ran, to measure what comes behind
// one: `corral compare`, `claims` and `report`. The pairs are spread over the levels of the paper's experiments, or of those
// that are named; the records have as many digits, gaps and failures as real ones. Same arguments, same bytes.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>

#include "io/disk/file.h"
#include "io/mesh/mesh_file.h"
#include "io/pose/transform_file.h"
#include "io/text/csv_file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"
#include "kernel/random.h"
#include "tests/support/meshes.h"
#include "tests/support/simulated_run.h"

namespace corral::testing {
namespace {

constexpr int kScenes = 64;  // pairs share so many surfaces and selections: more than a page shows in 3D

std::string name_of(int scene) { return "simulated-" + std::to_string(100 + scene); }
std::string selection_of(int scene) { return "selections/simulated/harris-shot-07434393/" + name_of(scene) + ".csv"; }

void write_scenes(const std::string& folder, const std::vector<std::string>& methods) {
  constexpr int kMatches = 3000;
  make_folder(folder + "/meshes");
  make_folder(folder + "/selections/simulated/harris-shot-07434393");
  RandomStream stream(1);
  for (int scene = 0; scene < kScenes; ++scene) {
    const Mesh mesh = bumpy_sphere(5, static_cast<std::uint64_t>(scene));
    for (const char* side : {"source", "target"})
      write_mesh(folder + "/meshes/" + name_of(scene) + "-" + side + ".ply", mesh);
    PairSelections pair;
    for (int row = 0; row < kMatches; ++row) {
      for (Indices* keypoints : {&pair.source_keypoints, &pair.target_keypoints})
        keypoints->push_back(static_cast<int>(stream.below(static_cast<std::uint64_t>(mesh.vertices.rows()))));
      pair.residual_pr.push_back(20 * stream.uniform());
      for (const std::string& method : methods)
        if (stream.uniform() < 0.2) pair.selected[method].push_back(row);
    }
    const std::string selection = folder + "/" + selection_of(scene);
    write_file(selection, selections_text(pair, methods));
    write_file(selection.substr(0, selection.size() - 4) + ".poses.csv", poses_text({}));
  }
  write_file(folder + "/meshes/truth.txt", transform_text(RigidTransform()));
}

PoseScores random_pose(RandomStream& stream) {
  const double error = std::exp(2.5 * stream.normal());
  return {error * (0.5 + stream.uniform()),
          error * (1 + stream.uniform()),
          error,
          error * 1.1,
          error / 300,
          error / 120,
          error / 400};
}

/// The record of a grouper on a pair; `common` is what all of its groupers share.
StudyRecord record_of(StudyRecord common, const std::string& method, RandomStream& stream) {
  StudyRecord record = std::move(common);
  record.method = method;
  if (!record.matches) return record;
  record.time_ms = std::exp(stream.normal());
  if (stream.uniform() < 0.01) {
    record.status = {MethodState::Failed, "the table is too small"};
    return record;
  }
  const int matches = *record.matches, right = *record.true_matches;
  const int correct = static_cast<int>(stream.below(static_cast<std::uint64_t>(right) + 1));
  const int selected = stream.uniform() < 0.02
                           ? 0
                           : correct + static_cast<int>(stream.below(static_cast<std::uint64_t>(matches - right) + 1));
  record.selected = selected;
  record.correct = std::min(selected, correct);
  record.status = {selected < 3 ? MethodState::TooFewRows : MethodState::Refined};
  if (selected > 0) record.precision = static_cast<double>(*record.correct) / selected;
  if (right > 0)
    record.recall = static_cast<double>(*record.correct) / right,
    record.f1 = 2.0 * *record.correct / (selected + right);
  if (selected >= 3) record.initial = random_pose(stream), record.refined = random_pose(stream);
  return record;
}

/// What the records of a pair at a level share.
StudyRecord common_part(const ExperimentInfo& info, const StudyLevel& level, int number, RandomStream& stream) {
  StudyRecord record;
  record.experiment = info.name, record.dataset = info.dataset, record.level = level.label;
  record.pair = info.name + "-" + level.label + "-" + std::to_string(number);
  record.value = level.low + stream.uniform() * (level.high - level.low);
  if (stream.uniform() < 0.005) {
    record.status = {MethodState::Failed, "no keypoints on the source"};
    return record;
  }
  record.truth = stream.uniform() < 0.005 ? "inverted" : "fits";
  record.matches = 200 + static_cast<int>(stream.below(2000));
  record.true_matches = static_cast<int>(*record.matches * std::pow(stream.uniform(), 3));
  record.frame_share = stream.uniform();
  record.selection = selection_of(number % kScenes);
  return record;
}

/// Writes records.csv and fills the pairs of the study.
void write_records(StudyFolder& run, std::int64_t pairs, std::vector<std::string> methods) {
  methods.insert(methods.end(), {"oracle", "baseline"});
  std::int64_t levels = 0, before = 0;
  for (const ExperimentInfo& info : run.experiments) levels += static_cast<std::int64_t>(info.levels.size());
  std::ofstream records(run.folder + "/records.csv");
  records << csv_line(record_columns());
  RandomStream stream(2);
  for (const ExperimentInfo& info : run.experiments)
    for (const StudyLevel& level : info.levels) {
      const auto count = static_cast<int>(pairs * (before + 1) / levels - pairs * before / levels);
      ++before;
      for (int number = 0; number < count; ++number) {
        const StudyRecord common = common_part(info, level, number, stream);
        for (const std::string& method : methods) records << record_line(record_of(common, method, stream));
        const std::string meshes = run.folder + "/meshes/" + name_of(number % kScenes);
        run.pairs[info.dataset + "/" + common.pair] = {
            meshes + "-source.ply", meshes + "-target.ply", run.folder + "/meshes/truth.txt", 0.02, 50000, 500};
      }
    }
  records.flush();
  if (!records) throw IoError(run.folder + "/records.csv", "", "cannot be written");
}

void simulate(const std::string& folder, int pairs, int groupers, const std::vector<std::string>& experiments) {
  StudyFolder run = simulated_study(1, 0);  // the paper's experiments and levels
  run.folder = folder;
  std::vector<std::string> methods = all_methods();
  for (int i = 1; static_cast<int>(methods.size()) < groupers; ++i) methods.push_back("further" + std::to_string(i));
  methods.resize(static_cast<std::size_t>(groupers));
  std::vector<ExperimentInfo> chosen;
  for (ExperimentInfo& info : run.experiments) {
    info.methods = methods;
    const bool is_named = std::count(experiments.begin(), experiments.end(), info.name) > 0;
    if (is_named || (experiments.empty() && info.name != "time")) chosen.push_back(info);
  }
  run.experiments = chosen;
  write_scenes(folder, methods);
  write_records(run, pairs, methods);
  write_file(folder + "/manifest.json", manifest_text(run));
}

}  // namespace
}  // namespace corral::testing

int main(int argc, char** argv) {
  const auto number = [&](int place) { return argc > place ? corral::parse_int(argv[place]).value_or(0) : 0; };
  if (number(2) < 1 || number(3) < 1)
    return std::fprintf(stderr, "usage: simulate_study FOLDER PAIRS GROUPERS [EXPERIMENT...]\n"), 2;
  try {
    corral::testing::simulate(argv[1], static_cast<int>(number(2)), static_cast<int>(number(3)),
                              {argv + 4, argv + argc});
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "simulate_study: %s\n", error.what()), 3;
  }
}
