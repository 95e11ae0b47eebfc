// SPDX-License-Identifier: MIT
#include "apps/reproduce/reading_tables.h"

#include <algorithm>
#include <set>

#include "apps/reproduce/matched_set.h"
#include "apps/reproduce/pair_form.h"
#include "io/pairs/dataset_file.h"

namespace corral {
namespace {

/// What decides on the half of a row.
const std::string& key_of(const LevelTable& level, std::size_t row) {
  return level.scenes[row].empty() ? level.pairs[row] : level.scenes[row];
}

template <class Column>
void keep(const std::vector<std::size_t>& rows, Column& column) {
  if (column.empty()) return;
  Column kept;
  for (const std::size_t row : rows) kept.push_back(std::move(column[row]));
  column = std::move(kept);
}

void keep_rows(const std::vector<std::size_t>& rows, LevelTable& level) {
  keep(rows, level.pairs);
  keep(rows, level.scenes);
  keep(rows, level.selections);
  keep(rows, level.roles);
  keep(rows, level.value);
  for (auto& [name, column] : level.of_pairs) keep(rows, column);
  for (auto& [method, columns] : level.methods)
    for (auto& [name, column] : columns.numbers) keep(rows, column);
}

std::string folder_word(const std::string& text) {
  std::string word = text;
  std::replace(word.begin(), word.end(), ' ', '+');
  std::replace(word.begin(), word.end(), '=', '-');
  return word;
}

}  // namespace

class ReadingTables::State {
 public:
  State(std::vector<OpenPoint> points, const ClaimBook& book, ReproduceSettings settings, Progress progress)
      : points_(std::move(points)), book_(book), settings_(std::move(settings)), progress_(std::move(progress)) {
    for (const std::string& name : settings_.experiments) {
      const Experiment experiment = read_experiment(name);
      sets_[name] = experiment.info.dataset + (experiment.varied.empty() ? "" : "-" + experiment.info.attribute);
    }
  }

  JudgedTables of(const Combination& combination, Half half) {
    const ReadingSettings settings = settings_of(points_, combination);
    JudgedTables judged;
    for (const std::string& experiment : settings_.experiments) {
      const MatchedExperiment& matched =
          matched_experiment(matching_part(points_, combination, experiment), experiment, settings.least_true_matches);
      judged.tables.push_back(matched.table);
      judged.agreement.push_back(matched.agreement);
      judged.keypoints.push_back(matched.keypoints);
      for (const std::string& method : book_.methods) {
        const auto options = settings.options.find(method);
        if (options == settings.options.end()) continue;
        const auto& columns = matched.variants.at({method, options->second});
        for (std::size_t level = 0; level < columns.size(); ++level)
          if (!columns[level].numbers.empty())  // a level without pairs has none
            judged.tables.back().levels[level].methods[method] = columns[level];
      }
      if (half != Half::All)
        for (std::size_t level = 0; level < judged.tables.back().levels.size(); ++level)
          keep_half(half, judged.tables.back().info.dataset, judged.tables.back().levels[level],
                    judged.agreement.back()[level], judged.keypoints.back()[level]);
    }
    return judged;
  }

 private:
  using Key = std::pair<Combination, std::string>;

  const MatchedExperiment& matched_experiment(const Combination& part, const std::string& experiment, int least) {
    auto& of_part = matched_[part];
    if (!of_part.count({experiment, least})) run(part, sets_.at(experiment));
    return of_part.at({experiment, least});
  }

  /// All experiments of the same set of pairs that are matched in this way, together.
  void run(const Combination& part, const std::string& set_name) {
    std::vector<std::string> experiments;
    for (const std::string& name : settings_.experiments)
      if (sets_.at(name) == set_name && matching_part(points_, part, name) == part) experiments.push_back(name);
    const std::string name = folder_word(to_text(points_, part)) + "/" + set_name;
    StudyObserver observer;
    observer.progress = [&](const StudyProgress& now) { progress_(name, now); };
    observer.stopped = [](const StudyProgress&) {};
    auto made = run_matched_set({points_, book_, settings_, part, experiments, name}, observer);
    matched_[part].merge(made);
  }

  void keep_half(Half half, const std::string& dataset, LevelTable& level, RowNumbers& agreement,
                 RowNumbers& keypoints) {
    const std::map<std::string, bool>& chosen = chosen_keys(dataset);
    std::vector<std::size_t> rows;
    for (std::size_t row = 0; row < level.pairs.size(); ++row)
      if (chosen.at(key_of(level, row)) == (half == Half::Chosen)) rows.push_back(row);
    keep_rows(rows, level);
    keep(rows, agreement);
    keep(rows, keypoints);
  }

  const std::map<std::string, bool>& chosen_keys(const std::string& dataset) {
    std::map<std::string, bool>& chosen = chosen_[dataset];
    if (!chosen.empty()) return chosen;
    const Dataset set = read_dataset(set_folder(settings_.data, dataset));
    for (const DatasetPair& pair : set.pairs) {
      const std::string scene = scene_of(set, pair);
      chosen[scene.empty() ? pair.name : scene] = false;
    }
    bool is_chosen = true;
    for (auto& [key, value] : chosen) value = std::exchange(is_chosen, !is_chosen);
    return chosen;
  }

  const std::vector<OpenPoint> points_;
  const ClaimBook& book_;
  const ReproduceSettings settings_;
  const Progress progress_;
  std::map<std::string, std::string>
      sets_;  // of each experiment: its data set, apart where tables of many sizes are made
  std::map<Combination, std::map<std::pair<std::string, int>, MatchedExperiment>> matched_;
  std::map<std::string, std::map<std::string, bool>>
      chosen_;  // by data set: whether a scene or pair is in the chosen half
};

ReadingTables::ReadingTables(std::vector<OpenPoint> points, const ClaimBook& book, ReproduceSettings settings,
                             Progress progress)
    : state_(std::make_unique<State>(std::move(points), book, std::move(settings), std::move(progress))) {}
ReadingTables::~ReadingTables() = default;
JudgedTables ReadingTables::of(const Combination& combination, Half half) { return state_->of(combination, half); }

}  // namespace corral
