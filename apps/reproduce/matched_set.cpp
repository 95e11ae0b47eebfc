// SPDX-License-Identifier: MIT
#include "apps/reproduce/matched_set.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "apps/pair/read_surface.h"
#include "apps/reproduce/pair_form.h"
#include "apps/study/assemble.h"
#include "apps/study/experiment_options.h"
#include "grouping/registry.h"

namespace corral {
namespace {

namespace fs = std::filesystem;

bool looks_at_agreement(const ClaimBook& book, const std::string& experiment) {
  for (const Claim& claim : book.claims)
    for (const ClaimPart& part : claim.parts)
      if (part.of.kind == Quantity::Kind::Agreement &&
          std::find(part.experiments.begin(), part.experiments.end(), experiment) != part.experiments.end())
        return true;
  return false;
}

Experiment experiment_of(const MatchedSet& set, const std::string& name) {
  Experiment experiment = read_experiment(name);
  experiment.info.methods = set.book.methods;
  experiment.extent =
      looks_at_agreement(set.book, experiment.info.name) ? StudyExtent::Selections : StudyExtent::Scores;
  const ReadingSettings settings = settings_of(set.points, set.matching);
  for (const auto& [key, value] : settings.matching)
    if (key == "resolution")
      experiment.resolution = experiment.matching.resolution = value;
    else
      set_choice(experiment.matching, key, value);
  OptionsByName of_surfaces;
  for (const auto& [of, options] : settings.options)
    if (!look_up(groupers(), of)) of_surfaces[of] = options;
  override_options(experiment, of_surfaces);
  return experiment;
}

/// The folder of the data: that of the study for another form of the pairs, which is made there.
std::string data_folder(const MatchedSet& set, const std::string& dataset) {
  const PairForm form = settings_of(set.points, set.matching).pairs;
  if (form == PairForm::AsStored) return set.settings.data;
  const std::string word = choice_names(form)[static_cast<std::size_t>(form)];
  const std::string folder = (fs::path(set.settings.folder) / "pairs" / word).string();
  write_pair_form(set.settings.data, dataset, form, folder);
  return folder;
}

OptionOverrides merged(OptionOverrides options, const OptionOverrides& others) {
  for (const auto& [name, value] : others) options[name] = value;
  return options;
}

/// A work list with the variants behind the calls that it has, and where they stand.
class VariantList {
 public:
  VariantList(const MatchedSet& set, WorkList list) : list_(std::move(list)), samples_(list_.samples) {
    for (const std::string& method : set.book.methods) variants_[method] = grouper_variants(set.points, method);
    for (WorkUnit& unit : list_.units) {
      std::vector<int>& first = first_.emplace_back();
      const std::size_t given = unit.tasks.size();
      for (std::size_t task = 0; task < given; ++task) {
        first.push_back(static_cast<int>(unit.tasks.size()) - 1);
        const std::vector<OptionOverrides>& variants = variants_.at(unit.tasks[task].method);
        for (std::size_t i = 1; i < variants.size(); ++i) {
          GroupingTask further = unit.tasks[task];
          further.options = merged(further.options, variants[i]);
          unit.tasks.push_back(std::move(further));
        }
      }
    }
  }

  const WorkList& list() const { return list_; }
  const std::map<std::string, std::vector<OptionOverrides>>& variants() const { return variants_; }

  /// The records of an experiment under one variant of a method, or (0) all methods without variants.
  const WorkList& with(const std::string& method, std::size_t variant) {
    list_.samples = samples_;
    if (variant == 0) return list_;
    for (StudySample& sample : list_.samples) {
      std::vector<int> tasks;
      const auto unit = static_cast<std::size_t>(sample.unit);
      for (const int task : sample.tasks)
        if (list_.units[unit].tasks[static_cast<std::size_t>(task)].method == method)
          tasks.push_back(first_[unit][static_cast<std::size_t>(task)] + static_cast<int>(variant));
      sample.tasks = std::move(tasks);
    }
    return list_;
  }

 private:
  WorkList list_;
  std::vector<StudySample> samples_;
  std::vector<std::vector<int>> first_;  // of each unit and each of its first calls: where its variants begin, minus 1
  std::map<std::string, std::vector<OptionOverrides>> variants_;
};

/// Only the measures that rules look at.
void drop_other_measures(const std::set<std::string>& needed, ExperimentTable& table) {
  for (LevelTable& level : table.levels)
    for (auto& [method, columns] : level.methods)
      for (auto column = columns.numbers.begin(); column != columns.numbers.end();)
        column = needed.count(column->first) ? std::next(column) : columns.numbers.erase(column);
}

std::set<std::string> needed_measures(const ClaimBook& book) {
  std::set<std::string> names = {"precision", "recall", "f1", "precision_nonempty", "correct", "selected"};
  for (const Claim& claim : book.claims)
    for (const ClaimPart& part : claim.parts)
      if (part.of.kind == Quantity::Kind::Measure) names.insert(part.of.measure->name);
  return names;
}

ExperimentTable table_of(const WorkList& list, const std::vector<UnitResult>& results, std::size_t experiment,
                         int least_true_matches) {
  ExperimentInfo info = list.experiments[experiment].info;
  info.least_true_matches = least_true_matches;
  TableBuilder builder(std::move(info), {});
  assemble_records(list, results, static_cast<int>(experiment),
                   [&](int, std::vector<StudyRecord> records) { builder.add(std::move(records)); });
  return std::move(builder).table();
}

/// What claims look at of the pairs: as the manifest of a study describes them.
StudyFolder described_pairs(const WorkList& list, const std::vector<UnitResult>& results, const std::string& folder) {
  StudyFolder run;
  run.folder = folder;
  std::map<std::string, int> vertices;
  for (const StudySample& sample : list.samples) {
    const auto unit_number = static_cast<std::size_t>(sample.unit);
    const WorkUnit& unit = list.units[unit_number];
    const auto [place, is_new] = run.pairs.try_emplace(unit.dataset + "/" + unit.pair.name);
    if (!is_new || !unit.pair.has_surfaces() || !results[unit_number].failure.empty()) continue;
    const auto [count, is_unread] = vertices.try_emplace(unit.pair.source, 0);
    if (is_unread) count->second = static_cast<int>(read_surface(unit.pair.source).vertices.rows());
    place->second.source = unit.pair.source;
    place->second.source_points = count->second;
    place->second.source_keypoints = results[unit_number].source_keypoints;
  }
  return run;
}

}  // namespace

std::vector<OptionOverrides> grouper_variants(const std::vector<OpenPoint>& points, const std::string& grouper) {
  std::vector<OptionOverrides> variants = {{}};
  for (const OpenPoint& point : points) {
    std::vector<OptionOverrides> more;
    for (const OptionOverrides& variant : variants)
      for (const Reading& reading : point.readings) {
        const auto found = reading.options.find(grouper);
        OptionOverrides options = found == reading.options.end() ? variant : merged(variant, found->second);
        if (std::find(more.begin(), more.end(), options) == more.end()) more.push_back(std::move(options));
      }
    variants = std::move(more);
  }
  return variants;
}

std::map<std::pair<std::string, int>, MatchedExperiment> run_matched_set(const MatchedSet& set,
                                                                         const StudyObserver& observer) {
  std::vector<Experiment> experiments;
  for (const std::string& name : set.experiments) experiments.push_back(experiment_of(set, name));
  const std::string data = data_folder(set, experiments.front().info.dataset);
  VariantList variants(set, make_work_list(std::move(experiments), data));
  StudySettings settings;
  settings.run = (fs::path(set.settings.folder) / "studies" / set.name).string();
  settings.cache = set.settings.cache.empty() ? (fs::path(set.settings.folder) / "cache").string() : set.settings.cache;
  settings.cache_limit = set.settings.cache_limit;
  settings.jobs = set.settings.jobs;
  settings.command_line = set.settings.command_line;
  const std::vector<UnitResult> results =
      run_units(variants.list(), study_call(set.experiments, data), settings, observer);
  const StudyFolder run = described_pairs(variants.list(), results, settings.run);
  const std::set<std::string> needed = needed_measures(set.book);
  std::set<int> least = {1};
  for (const OpenPoint& point : set.points)
    for (const Reading& reading : point.readings) least.insert(reading.least_true_matches);
  std::map<std::pair<std::string, int>, MatchedExperiment> made;
  for (std::size_t i = 0; i < variants.list().experiments.size(); ++i)
    for (const int matches : least) {
      MatchedExperiment& matched = made[{variants.list().experiments[i].info.name, matches}];
      const WorkList& list = variants.with("", 0);
      matched.table = table_of(list, results, i, matches);
      ClaimTable beside = claim_table(set.book, run, matched.table);
      matched.agreement = std::move(beside.agreement);
      matched.keypoints = std::move(beside.keypoints);
      drop_other_measures(needed, matched.table);
      for (const auto& [method, options] : variants.variants())
        for (std::size_t variant = 1; variant < options.size(); ++variant) {
          ExperimentTable table = table_of(variants.with(method, variant), results, i, matches);
          drop_other_measures(needed, table);
          auto& columns = matched.variants[{method, options[variant]}];
          for (LevelTable& level : table.levels) columns.push_back(std::move(level.methods[method]));
        }
    }
  return made;
}

}  // namespace corral
