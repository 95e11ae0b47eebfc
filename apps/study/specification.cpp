// SPDX-License-Identifier: MIT
#include "apps/study/specification.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "apps/pair/evaluate_pair.h"
#include "apps/pair/methods.h"
#include "apps/pair/option_names.h"
#include "apps/runtime/embedded_files.h"
#include "apps/study/experiment_options.h"
#include "grouping/registry.h"
#include "io/disk/file.h"
#include "io/text/line_reader.h"
#include "io/text/toml_file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {

const EmbeddedFiles& embedded_experiments();
const EmbeddedFiles& embedded_presets();

namespace {

/// Whether an option takes one of several words.
bool is_choice(const std::string& option) {
  const auto [name, field] = split_option(option);
  for (const OptionValue& each : *default_options(name))
    if (each.name == field) return each.accepted.find('|') != std::string::npos;
  return false;
}

std::string required_text(const TomlTable& table, const std::string& key) {
  const std::string text = table.text(key).value_or("");
  if (text.empty()) table.fail(key, "expected " + key + " = \"...\"");
  return text;
}

int whole_number(const TomlTable& table, const std::string& key, int otherwise, int least) {
  const std::int64_t value = table.integer(key).value_or(otherwise);
  if (value < least || value > 1'000'000)
    table.fail(key, "found " + std::to_string(value) + ", expected " + std::to_string(least) + " .. 1000000");
  return static_cast<int>(value);
}

[[noreturn]] void fail_unknown(const TomlTable& table, const std::string& key, const std::string& name,
                               const std::vector<std::string>& known) {
  const std::string nearest = nearest_name(name, known);
  std::string list;
  for (const std::string& each : known) list += (list.empty() ? "" : ", ") + each;
  table.fail(key, "nothing is named " + corral::quoted(name) + ", " +
                      (nearest.empty() ? "expected one of " + list : "did you mean " + corral::quoted(nearest) + "?"));
}

void check_method(const TomlTable& table, const std::string& key, const std::string& method) {
  std::vector<std::string> known;
  for (const Grouper& entry : methods()) known.push_back(entry.name);
  if (!look_up(methods(), method)) fail_unknown(table, key, method, known);
}

/// A grouper, detector or descriptor.
void check_name(const TomlTable& table, const std::string& key, const std::string& name) {
  if (!default_options(name)) fail_unknown(table, key, name, option_names());
}

/// The sweep of an attribute. A name that is not built in is a column of pairs.csv.
Sweep sweep_of(const TomlTable& table, const std::string& attribute) {
  static const std::map<std::string, Sweep> kOwn = {
      {"threshold_pr", Sweep::Threshold}, {"matches", Sweep::Matches},     {"inlier_ratio", Sweep::Ratio},
      {"detector", Sweep::Choice},        {"descriptor", Sweep::Choice},   {"frames", Sweep::Choice},
      {"normals", Sweep::Choice},         {"table_size", Sweep::TableSize}};
  const auto own = kOwn.find(attribute);
  if (own != kOwn.end()) return own->second;
  const std::size_t dot = attribute.find('.');
  if (dot == std::string::npos) return Sweep::Column;
  check_name(table, "attribute", attribute.substr(0, dot));
  return Sweep::Option;
}

std::vector<StudyLevel> read_bins(const TomlTable& table) {
  const auto bins = table.number_lists("bins");
  const auto labels = table.texts("labels");
  if (!labels.empty() && labels.size() != bins.size())
    table.fail("labels", "found " + std::to_string(labels.size()) + ", expected one for each of the " +
                             std::to_string(bins.size()) + " bins");
  std::vector<StudyLevel> levels;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    if (bins[i].size() != 2 || !(bins[i][0] < bins[i][1])) table.fail("bins", "expected [low, high] with low < high");
    if (!levels.empty() && bins[i][0] < levels.back().high)
      table.fail("bins", "expected ascending bins that do not overlap");
    levels.push_back(
        {labels.empty() ? bin_label(bins[i][0], bins[i][1], i + 1 == bins.size()) : labels[i], bins[i][0], bins[i][1]});
  }
  return levels;
}

/// Words, which stand at 0, 1, 2 ..
std::vector<StudyLevel> read_words(const TomlTable& table) {
  std::vector<StudyLevel> levels;
  for (const std::string& word : table.texts("levels")) {
    const auto place = static_cast<double>(levels.size());
    levels.push_back({word, place, place});
  }
  if (levels.empty()) table.fail("levels", "expected levels = [\"..\", ..]");
  return levels;
}

std::vector<StudyLevel> read_numbers(const TomlTable& table) {
  const std::vector<double> values = table.numbers("levels");
  std::vector<StudyLevel> levels = read_bins(table);
  if (values.empty() == levels.empty())
    table.fail(values.empty() ? "levels" : "bins", "expected either levels = [..] or bins = [[low, high], ..]");
  for (const double value : values) levels.push_back({to_text(value), value, value});
  return levels;
}

std::vector<StudyLevel> read_levels(const TomlTable& table, const Experiment& experiment) {
  const bool has_words =
      experiment.sweep == Sweep::Choice || (experiment.sweep == Sweep::Option && is_choice(experiment.info.attribute));
  const std::vector<StudyLevel> levels = has_words ? read_words(table) : read_numbers(table);
  for (std::size_t i = 0; i < levels.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (levels[i].label == levels[j].label)
        table.fail(table.texts("labels").empty() ? "levels" : "labels", levels[i].label + " occurs twice");
  return levels;
}

std::vector<AttributeFilter> read_filters(const TomlTable& table, const std::string& key) {
  std::vector<AttributeFilter> filters;
  if (const auto filter = table.table(key))
    for (const std::string& attribute : filter->keys()) filters.push_back({attribute, filter->texts(attribute)});
  return filters;
}

void read_matching(const TomlTable& root, Experiment& experiment) {
  const std::optional<TomlTable> table = root.table("matching");
  if (!table) return;
  std::vector<std::string> known = {"resolution", "detector", "descriptor"};
  for (const OptionValue& field : describe_options(experiment.matching)) known.push_back(field.name);
  table->only(known);
  experiment.resolution = table->scalar_text("resolution");
  experiment.matching.resolution = experiment.resolution.value_or(experiment.matching.resolution);
  for (const std::string& name : known) {
    const auto value = table->scalar_text(name);
    if (name == "resolution" || !value) continue;
    try {
      set_choice(experiment.matching, name, *value);
    } catch (const InvalidInput& error) {
      table->fail(name, error.what());
    }
  }
}

void read_options(const TomlTable& root, Experiment& experiment) {
  const std::optional<TomlTable> table = root.table("options");
  if (!table) return;
  for (const std::string& name : table->keys()) {
    check_name(*table, name, name);
    const TomlTable options = table->table(name).value();
    for (const std::string& option : options.keys())
      if (option == "seed")
        options.fail(option, "expected the key seed of the experiment, from which that of every pair is derived");
      else if (const auto value = options.scalar_text(option))
        experiment.options[name][option] = *value;
  }
}

/// The names of built-in files, without ".toml".
std::vector<std::string> names_of(const EmbeddedFiles& files) {
  std::vector<std::string> names;
  for (const auto& [file, text] : files) names.push_back(std::filesystem::path(file).stem().string());
  return names;
}

/// The file of a preset; "paper" has none: every option is at its default, the values of the paper's Table 1.
std::optional<TomlTable> read_preset(const TomlTable& root) {
  const std::string name = root.text("preset").value_or("paper");
  if (name == "paper") return std::nullopt;
  const auto found = embedded_presets().find(name + ".toml");
  std::vector<std::string> known = names_of(embedded_presets());
  known.push_back("paper");
  if (found == embedded_presets().end()) fail_unknown(root, "preset", name, known);
  TomlTable preset = TomlTable::parse("the preset " + name, found->second);
  preset.only({"options"});
  return preset;
}

/// Options of a preset, where the experiment uses what they belong to and does not give them itself.
void add_preset(const TomlTable& preset, Experiment& experiment) {
  Experiment given;
  read_options(preset, given);
  for (const auto& [name, options] : given.options)
    if (is_in_use(experiment, name)) experiment.options[name].insert(options.begin(), options.end());
}

/// [vary.harris] radius_pr = [..]
void read_varied(const TomlTable& root, Experiment& experiment) {
  const std::optional<TomlTable> table = root.table("vary");
  if (!table) return;
  if (!is_measured(experiment.sweep)) root.fail("vary", "is for attribute = \"matches\" or \"inlier_ratio\" only");
  for (const std::string& name : table->keys())
    for (const std::string& option : table->table(name).value().keys()) {
      if (!experiment.varied.empty()) table->fail(name, "expected one option to vary");
      if (!look_up(detectors(), name) && !look_up(descriptors(), name))
        table->fail(name, "expected the name of a detector or a descriptor");
      experiment.varied = name + "." + option;
      experiment.varied_values = table->table(name)->numbers(option);
    }
  if (experiment.varied_values.empty()) root.fail("vary", "expected [vary.NAME] with an option = [..]");
}

/// Everything that can be judged before any work is done.
void check_experiment(const TomlTable& table, const Experiment& experiment) {
  const ExperimentInfo& info = experiment.info;
  const bool is_positive_sweep = experiment.sweep == Sweep::Threshold || experiment.sweep == Sweep::Matches ||
                                 experiment.sweep == Sweep::TableSize;
  const bool is_value_sweep = experiment.sweep != Sweep::Column && !is_measured(experiment.sweep);
  for (const StudyLevel& level : info.levels) {
    if (is_value_sweep && level.low != level.high) table.fail("bins", info.attribute + " needs levels = [..]");
    if (is_positive_sweep && !(level.high > 0)) table.fail("levels", "expected numbers above zero");
    if (experiment.sweep == Sweep::TableSize && !(level.low == std::floor(level.low) && level.low <= 1e9))
      table.fail("levels", "found " + level.label + ", expected whole numbers of rows");
  }
  try {
    check_options(experiment);
  } catch (const InvalidInput& error) {
    const bool is_swept = experiment.sweep == Sweep::Option || experiment.sweep == Sweep::Choice;
    table.fail(is_swept ? "levels" : experiment.varied.empty() ? "options" : "vary", error.what());
  }
  if (experiment.sweep == Sweep::Option && !is_in_use(experiment, split_option(info.attribute).first))
    table.fail("attribute", "sweeps an option of " + split_option(info.attribute).first + ", which is not in use");
  if (!experiment.varied.empty() && !is_in_use(experiment, split_option(experiment.varied).first))
    table.fail("vary", experiment.varied + " is an option of what is not in use");
}

/// Whether a key has the second of two words; the first is the default.
bool is_second(const TomlTable& table, const std::string& key, const std::array<const char*, 2>& words) {
  const std::string word = table.text(key).value_or(words[0]);
  if (word != words[0] && word != words[1])
    table.fail(key, "found " + corral::quoted(word) + ", expected " + words[0] + " or " + words[1]);
  return word == words[1];
}

}  // namespace

std::string bin_label(double low, double high, bool is_last) {
  return "[" + to_text(low) + "," + to_text(high) + (is_last ? "]" : ")");
}

Experiment parse_experiment(const std::string& path, const std::string& text) {
  const TomlTable table = TomlTable::parse(path, text);
  table.only({"name",      "title",  "figure", "preset",   "dataset", "attribute", "axis",         "levels",
              "bins",      "labels", "filter", "groupers", "options", "matching",  "threshold_pr", "least_true_matches",
              "repeats",   "seed",   "dense",  "tables",   "vary",    "rows",      "select",       "except",
              "confidence"});
  Experiment experiment;
  ExperimentInfo& info = experiment.info;
  info.name = required_text(table, "name");
  if (info.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-_") != std::string::npos)
    table.fail("name", "expected lower-case letters, digits, - and _ only");
  info.title = table.text("title").value_or(info.name);
  info.figure = table.text("figure").value_or("");
  info.dataset = required_text(table, "dataset");
  info.attribute = required_text(table, "attribute");
  info.axis = table.text("axis").value_or(info.attribute);
  experiment.sweep = sweep_of(table, info.attribute);
  info.levels = read_levels(table, experiment);
  info.methods = expand_groupers(table.texts("groupers"));
  if (!table.has("groupers")) info.methods = expand_groupers({"paper"});
  for (std::size_t i = 0; i < info.methods.size(); ++i) {
    check_method(table, "groupers", info.methods[i]);
    if (std::count(info.methods.begin(), info.methods.end(), info.methods[i]) > 1)
      table.fail("groupers", info.methods[i] + " occurs twice");
  }
  info.threshold_pr = table.number("threshold_pr").value_or(info.threshold_pr);
  if (!(info.threshold_pr >= 0)) table.fail("threshold_pr", "expected a length of at least zero");
  info.least_true_matches = whole_number(table, "least_true_matches", info.least_true_matches, 1);
  experiment.repeats = whole_number(table, "repeats", experiment.repeats, 1);
  experiment.tables = whole_number(table, "tables", experiment.tables, 1);
  experiment.seed = static_cast<std::uint64_t>(whole_number(table, "seed", 1, 0));
  experiment.dense = table.flag("dense").value_or(false);
  experiment.all_rows = is_second(table, "rows", kRows);
  experiment.confidence = table.flag("confidence").value_or(false);
  experiment.by_surface = is_second(table, "select", kSelect);
  experiment.filters = read_filters(table, "filter");
  experiment.exceptions = read_filters(table, "except");
  read_matching(table, experiment);
  read_options(table, experiment);
  if (const auto preset = read_preset(table)) add_preset(*preset, experiment);
  read_varied(table, experiment);
  check_experiment(table, experiment);
  return experiment;
}

Experiment read_experiment(const std::string& name_or_path) {
  return parse_experiment(name_or_path, experiment_text(name_or_path));
}

std::string experiment_text(const std::string& name_or_path) {
  std::error_code ignored;
  if (std::filesystem::exists(name_or_path, ignored) && !std::filesystem::is_directory(name_or_path, ignored))
    return read_file(name_or_path);
  const auto found = embedded_experiments().find(name_or_path + ".toml");
  if (found != embedded_experiments().end()) return found->second;
  const std::string nearest = nearest_name(name_or_path, built_in_experiments());
  throw IoError(name_or_path, "",
                "is neither a file nor a built-in experiment" +
                    (nearest.empty() ? ", 'corral evaluate --help' lists those"
                                     : ", did you mean " + corral::quoted(nearest) + "?"));
}

std::vector<std::string> built_in_experiments() { return names_of(embedded_experiments()); }

}  // namespace corral
