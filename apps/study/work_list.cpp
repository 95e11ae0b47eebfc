// SPDX-License-Identifier: MIT
#include "apps/study/work_list.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <tuple>

#include "apps/pair/methods.h"
#include "apps/study/content_store.h"
#include "apps/study/experiment_options.h"
#include "apps/study/find_dataset.h"
#include "apps/study/methods_file.h"
#include "io/text/line_reader.h"
#include "io/text/toml_file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"
#include "kernel/random.h"

namespace corral {
namespace {

namespace fs = std::filesystem;

bool matches_filter(const Dataset& dataset, const DatasetPair& pair, const AttributeFilter& filter) {
  const std::string cell = filter.attribute == "pair" ? pair.name : attribute_text(dataset, pair, filter.attribute);
  const std::optional<double> number = parse_double(cell);
  return std::any_of(filter.values.begin(), filter.values.end(), [&](const std::string& value) {
    const std::optional<double> wanted = parse_double(value);
    return cell == value || (number && wanted && *number == *wanted);
  });
}

bool is_used(const Experiment& experiment, const Dataset& dataset, const DatasetPair& pair) {
  const auto matches = [&](const AttributeFilter& filter) { return matches_filter(dataset, pair, filter); };
  return std::all_of(experiment.filters.begin(), experiment.filters.end(), matches) &&
         std::none_of(experiment.exceptions.begin(), experiment.exceptions.end(), matches);
}

bool draws(const std::string& method) {
  const auto& options = find_method(method).options;
  return std::any_of(options.begin(), options.end(), [](const OptionValue& option) { return option.name == "seed"; });
}

/// The folder of the selections of one setting of matching and grouping: the paper's has a short name.
std::string setting_label(const Experiment& experiment, const WorkUnit& unit, const StudyLevel& level) {
  std::string text;
  for (const Grouper& grouper : methods())
    for (const auto& [name, value] : options_at(experiment, grouper.name, level))
      text += grouper.name + "." + name + "=" + value + "\n";
  if (experiment.by_surface) text += "by surface\n";
  const MatchSettings& matching = unit.matching;
  const OptionValue length = keypoint_length(matching);
  MatchSettings usual;
  usual.resolution = matching.resolution;
  usual.normals = NormalSide::Mesh;
  const bool is_usual =
      text.empty() && experiment.seed == Experiment().seed && matching.detector == usual.detector &&
      matching_text(matching) == matching_text(with_option(usual, usual.detector + "." + length.name, length.value));
  if (is_usual) return length.value + "pr";
  return matching.detector + "-" + matching.descriptor + "-" +
         content_hash(text + std::to_string(experiment.seed) + matching_text(matching)).substr(0, 8);
}

/// Collects units so that those that several experiments need exist once.
class Collector {
 public:
  Collector(std::vector<Experiment> experiments, std::string data_folder) : data_folder_(std::move(data_folder)) {
    std::sort(experiments.begin(), experiments.end(),
              [](const Experiment& a, const Experiment& b) { return a.info.name < b.info.name; });
    list_.experiments = std::move(experiments);
    for (std::size_t i = 1; i < list_.experiments.size(); ++i)
      if (list_.experiments[i].info.name == list_.experiments[i - 1].info.name)
        throw IoError(list_.experiments[i].info.name, "", "two experiments have this name, expected each name once");
  }

  WorkList collect() {
    for (std::size_t i = 0; i < list_.experiments.size(); ++i) add_experiment(static_cast<int>(i));
    std::vector<int> position(list_.units.size());
    std::vector<WorkUnit> sorted;
    for (const auto& [key, unit] : units_) {
      position[static_cast<std::size_t>(unit)] = static_cast<int>(sorted.size());
      sorted.push_back(std::move(list_.units[static_cast<std::size_t>(unit)]));
    }
    list_.units = std::move(sorted);
    mark_shared();
    for (StudySample& sample : list_.samples) sample.unit = position[static_cast<std::size_t>(sample.unit)];
    std::stable_sort(list_.samples.begin(), list_.samples.end(), [](const StudySample& a, const StudySample& b) {
      return std::tie(a.experiment, a.level, a.unit) < std::tie(b.experiment, b.level, b.unit);
    });
    return std::move(list_);
  }

 private:
  using UnitKey = std::tuple<std::string, int, double, std::string>;  // set, pair, keypoint length, all settings

  /// The features of a mesh depend on the pr of its pair: under the rule mean, every pair has its own.
  void mark_shared() {
    std::map<std::string, int> uses;
    const auto key = [](const WorkUnit& unit, const std::string& file) {
      return file + "\n" + matching_text(unit.matching);
    };
    for (const WorkUnit& unit : list_.units)
      if (unit.pair.matches.empty()) ++uses[key(unit, unit.pair.source)], ++uses[key(unit, unit.pair.target)];
    for (WorkUnit& unit : list_.units) {
      if (!unit.pair.matches.empty()) continue;
      const std::string& rule = unit.matching.resolution;
      unit.shares_source = rule != "mean" && rule != "target" && uses[key(unit, unit.pair.source)] > 1;
      unit.shares_target = rule != "mean" && rule != "source" && uses[key(unit, unit.pair.target)] > 1;
    }
  }

  void add_experiment(int index) {
    Experiment& experiment = list_.experiments[static_cast<std::size_t>(index)];
    const Dataset dataset = find_dataset(data_folder_, experiment.info.dataset, experiment.info.name);
    experiment.info.dataset = dataset.name;
    if (!experiment.resolution) experiment.matching.resolution = dataset.resolution;
    experiment.matching.threads = 1;
    check_columns(experiment, dataset);
    const std::size_t before = list_.samples.size();
    for (std::size_t i = 0; i < dataset.pairs.size(); ++i)
      if (is_used(experiment, dataset, dataset.pairs[i])) add_pair(index, dataset, static_cast<int>(i));
    if (list_.samples.size() == before)
      throw IoError(dataset.path("pairs.csv"), "",
                    "no pair is at any level of the experiment " + experiment.info.name + ", expected some with " +
                        experiment.info.attribute + " from " + experiment.info.levels.front().label + " to " +
                        experiment.info.levels.back().label);
  }

  static void check_columns(const Experiment& experiment, const Dataset& dataset) {
    const auto& known = dataset.attributes;
    const std::string& attribute = experiment.info.attribute;
    if (experiment.sweep != Sweep::Column || std::find(known.begin(), known.end(), attribute) != known.end()) return;
    const std::string nearest = nearest_name(attribute, known);
    throw IoError(dataset.path("pairs.csv"), "header",
                  "has no column " + corral::quoted(attribute) + ", which the experiment " + experiment.info.name +
                      " sweeps" + (nearest.empty() ? "" : ", did you mean " + corral::quoted(nearest) + "?"));
  }

  void add_pair(int index, const Dataset& dataset, int pair) {
    const Experiment& experiment = list_.experiments[static_cast<std::size_t>(index)];
    const auto& levels = experiment.info.levels;
    if (experiment.sweep == Sweep::Column) {
      const auto value =
          attribute_number(dataset, dataset.pairs[static_cast<std::size_t>(pair)], experiment.info.attribute);
      const int level = value ? level_of(levels, *value) : -1;
      if (level >= 0)
        add_sample({index, 0, level, value, experiment.info.threshold_pr, "", {}}, dataset, pair,
                   matching_at(experiment, levels[static_cast<std::size_t>(level)]));
      return;
    }
    if (is_measured(experiment.sweep) || experiment.sweep == Sweep::TableSize) {
      const MatchSettings matching = matching_at(experiment, levels.front());
      const auto add = [&](const MatchSettings& settings) {
        add_sample({index, 0, -1, std::nullopt, experiment.info.threshold_pr, "", {}}, dataset, pair, settings);
      };
      for (const double value : experiment.varied_values) add(with_option(matching, experiment.varied, to_text(value)));
      if (experiment.varied.empty()) add(matching);
      return;
    }
    for (std::size_t level = 0; level < levels.size(); ++level) {
      StudySample sample{index, 0, static_cast<int>(level), levels[level].low, experiment.info.threshold_pr, "", {}};
      if (experiment.sweep == Sweep::Threshold) sample.threshold_pr = levels[level].low;
      add_sample(std::move(sample), dataset, pair, matching_at(experiment, levels[level]));
    }
  }

  void add_sample(StudySample sample, const Dataset& dataset, int pair, const MatchSettings& matching) {
    const Experiment& experiment = list_.experiments[static_cast<std::size_t>(sample.experiment)];
    const auto [place, is_new] =
        units_.try_emplace(UnitKey{dataset.name, pair, parse_double(keypoint_length(matching).value).value_or(0),
                                   matching_text(matching) + (experiment.by_surface ? " by surface" : "")},
                           list_.units.size());
    sample.unit = place->second;
    if (is_new) {
      DatasetPair files = dataset.with_paths(dataset.pairs[static_cast<std::size_t>(pair)]);
      list_.units.push_back({dataset.name, files, matching, {}, {}, false, dataset.units == "m", false, false, {}});
      list_.units.back().scene = scene_of(dataset, files);
    }
    WorkUnit& unit = list_.units[static_cast<std::size_t>(sample.unit)];
    unit.dense = unit.dense || experiment.dense;
    unit.all_rows = unit.all_rows || experiment.all_rows;
    unit.confidence = unit.confidence || experiment.confidence;
    unit.by_surface = experiment.by_surface;
    const auto at = std::lower_bound(unit.thresholds_pr.begin(), unit.thresholds_pr.end(), sample.threshold_pr);
    if (at == unit.thresholds_pr.end() || *at != sample.threshold_pr)
      unit.thresholds_pr.insert(at, sample.threshold_pr);
    const StudyLevel& level = experiment.info.levels[static_cast<std::size_t>(std::max(sample.level, 0))];
    unit.extent = std::min(unit.extent, experiment.extent);
    if (experiment.extent != StudyExtent::Scores)
      sample.selection =
          "selections/" + unit.dataset + "/" + setting_label(experiment, unit, level) + "/" + unit.pair.name + ".csv";
    for (const std::string& method : experiment.info.methods)
      if (look_up(methods(), method))
        for (const GroupingTask& task : tasks_of(experiment, method, level, unit.pair.name))
          add_task(task, unit, sample);
    for (const ForeignMethod& method : experiment.foreign) add_task(task_of(method, dataset, unit.pair), unit, sample);
    list_.samples.push_back(std::move(sample));
  }

  static GroupingTask task_of(const ForeignMethod& method, const Dataset& dataset, const DatasetPair& pair) {
    if (!method.external)
      return {method.name, {}, 0, std::make_shared<ForeignAnswer>(answer_to(method, dataset, pair)), {}};
    GroupingTask task{method.name, {}, 0, {}, method.external};
    for (const OptionValue& option : method.external->options()) task.options[option.name] = option.value;
    return task;
  }

  /// All repeats of a stochastic grouper, one call of any other.
  static std::vector<GroupingTask> tasks_of(const Experiment& experiment, const std::string& method,
                                            const StudyLevel& level, const std::string& pair) {
    const bool is_random = draws(method);
    std::vector<GroupingTask> tasks;
    for (int repeat = 0; repeat < (is_random ? experiment.repeats : 1); ++repeat) {
      tasks.push_back({method, options_at(experiment, method, level), repeat});
      if (is_random)
        tasks.back().options["seed"] =
            std::to_string(derive_seed(experiment.seed, pair + "/" + method + "/" + std::to_string(repeat)));
    }
    return tasks;
  }

  static void add_task(const GroupingTask& task, WorkUnit& unit, StudySample& sample) {
    const auto found = std::find(unit.tasks.begin(), unit.tasks.end(), task);
    const int number = static_cast<int>(found - unit.tasks.begin());
    if (found == unit.tasks.end()) unit.tasks.push_back(task);
    sample.tasks.push_back(number);
    if (sample.selection.empty()) return;
    std::vector<int>& shown = unit.selections[sample.selection];
    if (task.repeat == 0 && std::find(shown.begin(), shown.end(), number) == shown.end()) shown.push_back(number);
  }

  std::string data_folder_;
  WorkList list_;
  std::map<UnitKey, int> units_;
};

}  // namespace

WorkList make_work_list(std::vector<Experiment> experiments, const std::string& data_folder) {
  return Collector(std::move(experiments), data_folder).collect();
}

int level_of(const std::vector<StudyLevel>& levels, double value) {
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const StudyLevel& level = levels[i];
    const bool is_value = level.low == level.high;
    const bool is_last = i + 1 == levels.size();
    if (is_value ? std::abs(value - level.low) <= 1e-9 * std::max(1.0, std::abs(level.low))
                 : value >= level.low && (value < level.high || (is_last && value == level.high)))
      return static_cast<int>(i);
  }
  return -1;
}

std::vector<std::string> GroupingTask::foreign_files() const {
  if (const std::string plugin = plugin_file(method); !plugin.empty()) return {plugin};
  return answer ? answer->files() : external ? external->files() : std::vector<std::string>();
}

std::vector<std::string> WorkUnit::files() const {
  std::vector<std::string> all = pair.files();
  for (const GroupingTask& task : tasks)
    for (const std::string& file : task.foreign_files()) all.push_back(file);
  return all;
}

std::string matching_text(const MatchSettings& matching) { return compact_json(to_json(matching)); }

std::string unit_text(const WorkUnit& unit) {
  Json tasks = Json::array(), selections = Json::object();
  for (const GroupingTask& task : unit.tasks)
    tasks.push_back({{"method", task.method}, {"options", task.options}, {"repeat", task.repeat}});
  for (const auto& [file, shown] : unit.selections) selections[file] = shown;
  return compact_json({{"dataset", unit.dataset},
                       {"pair", unit.pair.name},
                       {"matching", to_json(unit.matching)},
                       {"tasks", tasks},
                       {"thresholds_pr", unit.thresholds_pr},
                       {"dense", unit.dense},
                       {"all_rows", unit.all_rows},
                       {"by_surface", unit.by_surface},
                       {"confidence", unit.confidence},
                       {"extent", static_cast<int>(unit.extent)},
                       {"selections", selections}});
}

}  // namespace corral
