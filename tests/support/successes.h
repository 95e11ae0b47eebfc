// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include "apps/results/study_folder.h"

namespace corral::testing {

/// What a method does on each pair of successes_study().
struct Successes {
  std::vector<bool> registers;    ///< after the refinement
  std::vector<bool> before = {};  ///< and before it; the same if it is empty
  double precision = 0.1, recall = 0.1;
  double time_ms = 1;
};

/// An experiment of one level on pairs p0, p1, ..., which have so many correct ones of 100 matches.
inline StudyFolder successes_study(const std::string& experiment, const std::vector<int>& correct,
                                   const std::map<std::string, Successes>& methods) {
  StudyFolder run;
  run.folder = "run";
  ExperimentInfo info;
  info.name = experiment, info.title = experiment, info.dataset = "set", info.attribute = "inlier_ratio";
  info.levels = {{"[0,100]", 0, 100}};
  for (const auto& [method, successes] : methods)
    if (method != "oracle") info.methods.push_back(method);
  run.experiments = {info};
  for (std::size_t pair = 0; pair < correct.size(); ++pair)
    for (const auto& [method, successes] : methods) {
      StudyRecord record;
      record.experiment = experiment, record.dataset = info.dataset, record.level = "[0,100]", record.method = method;
      record.pair = "p" + std::to_string(pair);
      record.value = correct[pair];
      record.status = {MethodState::Refined, ""};
      record.truth = std::string("fits");
      record.matches = 100, record.true_matches = correct[pair], record.selected = 10, record.correct = 1;
      record.precision = successes.precision, record.recall = successes.recall, record.f1 = 0.1;
      const bool before = successes.before.empty() ? successes.registers[pair] : successes.before[pair];
      record.initial.rotation_error_deg = 0, record.initial.mean_error_pr = before ? 1 : 50;
      record.refined.rotation_error_deg = 0, record.refined.mean_error_pr = successes.registers[pair] ? 1 : 50;
      record.time_ms = successes.time_ms;
      run.records.push_back(record);
    }
  return run;
}

/// So many successes, then failures.
inline std::vector<bool> first_of(int successes, int pairs) {
  std::vector<bool> all(static_cast<std::size_t>(pairs), false);
  for (int i = 0; i < successes; ++i) all[static_cast<std::size_t>(i)] = true;
  return all;
}

}  // namespace corral::testing
