// SPDX-License-Identifier: MIT
// corral calibrate: how far the poses of 'corral register' can be trusted, learned from pairs with a truth.
#include <algorithm>
#include <deque>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>

#include "apps/commands/command_files.h"
#include "apps/commands/command_options.h"
#include "apps/pair/confidence_file.h"
#include "apps/pair/load_pair.h"
#include "apps/runtime/output.h"
#include "apps/runtime/progress.h"
#include "apps/runtime/text_table.h"
#include "apps/runtime/workers.h"
#include "apps/study/find_dataset.h"
#include "apps/study/study_journals.h"
#include "io/disk/file.h"
#include "io/pairs/dataset_file.h"
#include "kernel/error.h"

namespace corral {
namespace {

struct Settings {
  std::vector<std::string> data, tests;
  std::string output;
  int threads = 0;
  bool json = false;
};

/// The best poses of a pair, by the surfaces and by the table alone.
struct JudgedPair {
  std::optional<JudgedPose> surfaces, table;
};

/// A pair with a truth, and how it is matched.
struct PairToJudge {
  const Dataset* dataset;
  DatasetPair pair;
  MatchSettings matching;
};

/// The pairs of a data set, or of a study: those that it was about, each matched in the ways in which it matched them.
class PairsToJudge {
 public:
  explicit PairsToJudge(const std::vector<std::string>& folders) {
    for (const std::string& folder : folders)
      if (std::filesystem::exists(folder + "/manifest.json"))
        add_study(folder);
      else
        add_set(folder);
  }
  const std::vector<PairToJudge>& list() const { return list_; }

 private:
  void add_set(const std::string& folder) {
    const Dataset& dataset = datasets_.emplace_back(read_dataset(folder));
    for (const DatasetPair& pair : dataset.pairs) add(dataset, pair, {});
  }

  void add_study(const std::string& folder) {
    const StudyJournals study = find_study(folder);
    const WorkList work = work_list_of(study);
    std::map<std::string, const Dataset*> known;
    std::set<std::string> seen;  // units differ in their groupers too
    for (const WorkUnit& unit : work.units) {
      const auto [dataset, is_new] = known.try_emplace(unit.dataset, nullptr);
      if (is_new) dataset->second = &datasets_.emplace_back(find_dataset(study.call.data, unit.dataset, folder));
      const auto named = [&](const DatasetPair& pair) { return pair.name == unit.pair.name; };
      const auto pair = std::find_if(dataset->second->pairs.begin(), dataset->second->pairs.end(), named);
      if (pair != dataset->second->pairs.end() &&
          seen.insert(unit.dataset + "/" + pair->name + "\n" + matching_text(unit.matching)).second)
        add(*dataset->second, *pair, unit.matching);
    }
  }

  void add(const Dataset& dataset, const DatasetPair& pair, MatchSettings matching) {
    matching.threads = 1;
    if (!pair.truth.empty()) list_.push_back({&dataset, pair, std::move(matching)});
  }

  std::deque<Dataset> datasets_;  // stay where they are
  std::vector<PairToJudge> list_;
};

JudgedPair judge_pair(const PairToJudge& given) {
  const LoadedPair pair = load_pair(*given.dataset, given.pair, given.matching);
  const auto judged = [&](const Registration& found) -> std::optional<JudgedPose> {
    if (found.poses.empty()) return std::nullopt;
    const auto errors = pose_errors(found.poses.front().target_from_source, *pair.truth, pair.matches.resolution);
    return JudgedPose{*found.signals, is_registered(errors), group_of(*given.dataset, given.pair)};
  };
  JudgedPair result;
  if (pair.meshes) result.surfaces = judged(register_pair(pair.matches, pair.surfaces()));
  result.table = judged(register_pair(pair.matches, std::nullopt));
  return result;
}

struct JudgedSet {
  std::vector<JudgedPose> surfaces, table;
};

/// Every pair with a truth; those that cannot be read or matched are named on stderr.
JudgedSet judge_sets(const std::vector<std::string>& folders, int threads) {
  const PairsToJudge pairs(folders);
  const std::vector<PairToJudge>& work = pairs.list();
  std::vector<JudgedPair> judged(work.size());
  std::vector<std::string> failures(work.size());
  Progress progress(static_cast<double>(work.size()));
  std::mutex talking;
  workers(threads)(static_cast<int>(work.size()), [&](int i) {
    const PairToJudge& given = work[static_cast<std::size_t>(i)];
    {
      const std::lock_guard<std::mutex> lock(talking);
      progress.begin(given.dataset->name + " " + given.pair.name);
    }
    try {
      judged[static_cast<std::size_t>(i)] = judge_pair(given);
    } catch (const std::runtime_error& error) {
      failures[static_cast<std::size_t>(i)] = error.what();
    } catch (const std::invalid_argument& error) {
      failures[static_cast<std::size_t>(i)] = error.what();
    }
  });
  JudgedSet set;
  for (std::size_t i = 0; i < judged.size(); ++i) {
    if (!failures[i].empty()) say("warning: " + work[i].pair.name + ": " + failures[i]);
    if (judged[i].surfaces) set.surfaces.push_back(std::move(*judged[i].surfaces));
    if (judged[i].table) set.table.push_back(std::move(*judged[i].table));
  }
  return set;
}

Json row(const std::string& set, const std::string& by, const Reliability& found) {
  return {{"set", set},
          {"poses", by},
          {"pairs", found.pairs},
          {"right", found.right},
          {"brier", found.brier},
          {"area", found.area},
          {"calibration_error", found.calibration_error},
          {"kept", found.kept},
          {"kept_right", found.kept_right}};
}

std::vector<double> probabilities(const ConfidenceModel& model, const std::vector<JudgedPose>& poses) {
  std::vector<double> found;
  for (const JudgedPose& pose : poses) found.push_back(model.probability(pose.signals));
  return found;
}

int calibrate(const Settings& settings) {
  if (!settings.output.empty()) check_writable(settings.output);
  const JudgedSet set = judge_sets(settings.data, settings.threads);
  ConfidenceModels models = built_in_confidence();  // that of surfaces stays where there are none
  std::vector<Json> rows;
  if (!set.surfaces.empty()) {
    models.surfaces = fit_confidence(set.surfaces);
    rows.push_back(row("held out", "surfaces", reliability(held_out_probabilities(set.surfaces), set.surfaces)));
  }
  models.table = fit_confidence(set.table);
  rows.push_back(row("held out", "table", reliability(held_out_probabilities(set.table), set.table)));
  for (const std::string& folder : settings.tests) {
    const JudgedSet test = judge_sets({folder}, settings.threads);
    if (!test.surfaces.empty())
      rows.push_back(
          row(folder, "surfaces", reliability(probabilities(models.surfaces, test.surfaces), test.surfaces)));
    rows.push_back(row(folder, "table", reliability(probabilities(models.table, test.table), test.table)));
  }
  if (!settings.output.empty()) write_file(settings.output, confidence_text(models));
  if (settings.json)
    put("", Json(rows));
  else
    put("", table_text(rows, {{"set", "set"},
                              {"poses by", "poses"},
                              {"pairs", "pairs"},
                              {"right", "right"},
                              {"Brier", "brier", 3},
                              {"area under ROC", "area", 3},
                              {"calibration error", "calibration_error", 3},
                              {"at 0.9: kept", "kept"},
                              {"right", "kept_right"}}));
  return kOk;
}

}  // namespace

void add_calibrate(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "calibrate", "How far the poses of 'corral register' can be trusted, learned from pairs with a truth");
  auto settings = std::make_shared<Settings>();
  command
      ->add_option("data", settings->data,
                   "Studies, or data sets, whose pairs have truths; ten poses must be right and ten wrong, at least")
      ->type_name("STUDY")
      ->required();
  command->add_option("--test", settings->tests, "Studies, or data sets, on which the model is then tested")
      ->type_name("STUDY");
  command->add_option("-o,--output", settings->output, "The model, for 'corral register --confidence'")
      ->type_name("FILE");
  add_threads(*command, settings->threads);
  command->add_flag("--json", settings->json, "The table as JSON");
  command->footer(
      "Every pair is registered as 'corral register' does, with its surfaces and by its table of matches alone; a pose is right if its\n"
      "mean error is at most 5 pr. A logistic model of what speaks for a pose is fitted; the row 'held out' judges the pairs of\n"
      "every object by a model of the others. The pairs of a study are matched as the study matched them, so the\n"
      "model applies to its detector and descriptor. The study must have been made by this version of the program.\n"
      "Examples:\n"
      "  corral calibrate runs/overlap runs/clutter -o confidence.toml\n"
      "  corral calibrate data/u3m data/u3or --test my-scans -o confidence.toml");
  command->callback([settings, &action] { action = [settings] { return calibrate(*settings); }; });
}

}  // namespace corral
