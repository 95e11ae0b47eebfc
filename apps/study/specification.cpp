// SPDX-License-Identifier: MIT
#include "apps/study/specification.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "apps/runtime/embedded_files.h"
#include "grouping/registry.h"
#include "io/file.h"
#include "io/line_reader.h"
#include "io/toml_file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {

const EmbeddedFiles& embedded_experiments();

namespace {

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const Grouper& grouper : groupers()) names.push_back(grouper.name);
  return names;
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

void check_method(const TomlTable& table, const std::string& key, const std::string& method) {
  const std::vector<std::string> known = method_names();
  if (std::find(known.begin(), known.end(), method) != known.end()) return;
  const std::string nearest = nearest_name(method, known);
  table.fail(key, "no grouper is called " + corral::quoted(method) +
                      (nearest.empty() ? ", 'corral groupers' lists them"
                                       : ", did you mean " + corral::quoted(nearest) + "?"));
}

/// Which sweep an attribute asks for. A name that is none of the program's own is a column of pairs.csv.
Sweep sweep_of(const TomlTable& table, const std::string& attribute) {
  static const std::map<std::string, Sweep> kOwn = {{"threshold_pr", Sweep::Threshold},
                                                    {"matches", Sweep::Matches},
                                                    {"keypoint_radius_pr", Sweep::KeypointRadius},
                                                    {"table_size", Sweep::TableSize}};
  const auto own = kOwn.find(attribute);
  if (own != kOwn.end()) return own->second;
  const std::size_t dot = attribute.find('.');
  if (dot == std::string::npos) return Sweep::Column;
  check_method(table, "attribute", attribute.substr(0, dot));
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
      table.fail("bins", "expected bins in order, none in another");
    levels.push_back(
        {labels.empty() ? bin_label(bins[i][0], bins[i][1], i + 1 == bins.size()) : labels[i], bins[i][0], bins[i][1]});
  }
  return levels;
}

std::vector<StudyLevel> read_levels(const TomlTable& table) {
  const std::vector<double> values = table.numbers("levels");
  std::vector<StudyLevel> levels = read_bins(table);
  if (values.empty() == levels.empty())
    table.fail(values.empty() ? "levels" : "bins", "expected either levels = [..] or bins = [[low, high], ..]");
  for (const double value : values) levels.push_back({to_text(value), value, value});
  for (std::size_t i = 0; i < levels.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (levels[i].label == levels[j].label)
        table.fail(values.empty() ? "labels" : "levels", levels[i].label + " stands twice");
  return levels;
}

std::vector<AttributeFilter> read_filters(const TomlTable& table) {
  std::vector<AttributeFilter> filters;
  if (const auto filter = table.table("filter"))
    for (const std::string& attribute : filter->keys()) filters.push_back({attribute, filter->texts(attribute)});
  return filters;
}

void read_matching(const TomlTable& root, Experiment& experiment) {
  const std::optional<TomlTable> table = root.table("matching");
  if (!table) return;
  table->only({"resolution", "detector", "keypoint_radius_pr", "keypoint_radii_pr", "support_radius_pr", "normals",
               "shot", "mutual"});
  MatchSettings& matching = experiment.matching;
  experiment.resolution = table->scalar_text("resolution");
  matching.resolution = experiment.resolution.value_or(matching.resolution);
  matching.detector = table->text("detector").value_or(matching.detector);
  matching.keypoint_radius_pr = table->number("keypoint_radius_pr").value_or(matching.keypoint_radius_pr);
  matching.support_radius_pr = table->number("support_radius_pr").value_or(matching.support_radius_pr);
  matching.normals = table->text("normals").value_or(matching.normals);
  matching.shot = table->text("shot").value_or(matching.shot);
  matching.matching.mutual = table->flag("mutual").value_or(matching.matching.mutual);
  experiment.keypoint_radii_pr = table->numbers("keypoint_radii_pr");
  for (const double radius : experiment.keypoint_radii_pr)
    if (!(radius > 0)) table->fail("keypoint_radii_pr", "expected lengths above zero");
  if (!experiment.keypoint_radii_pr.empty() && experiment.sweep != Sweep::Matches)
    table->fail("keypoint_radii_pr", "is for attribute = \"matches\" only, expected keypoint_radius_pr");
  try {
    matching.validate();
  } catch (const InvalidInput& error) {
    root.fail("matching", error.what());
  }
}

void read_options(const TomlTable& root, Experiment& experiment) {
  const std::optional<TomlTable> table = root.table("options");
  if (!table) return;
  for (const std::string& method : table->keys()) {
    check_method(*table, method, method);
    const TomlTable options = table->table(method).value();
    for (const std::string& name : options.keys())
      if (name == "seed")
        options.fail(name, "expected the key seed of the experiment, from which that of every pair is derived");
      else if (const auto value = options.scalar_text(name))
        experiment.options[method][name] = *value;
  }
}

/// Everything that only the groupers can judge, before any work is done.
void check_experiment(const TomlTable& table, const Experiment& experiment) {
  const ExperimentInfo& info = experiment.info;
  const bool is_positive_sweep = experiment.sweep != Sweep::Column && experiment.sweep != Sweep::Option;
  const bool is_value_sweep = experiment.sweep != Sweep::Column && experiment.sweep != Sweep::Matches;
  for (const StudyLevel& level : info.levels) {
    if (is_value_sweep && level.low != level.high) table.fail("bins", info.attribute + " wants levels = [..]");
    if (is_positive_sweep && !(level.high > 0)) table.fail("levels", "expected numbers above zero");
    if (experiment.sweep == Sweep::TableSize && !(level.low == std::floor(level.low) && level.low <= 1e9))
      table.fail("levels", "found " + level.label + ", expected whole numbers of rows");
    for (const std::string& method : info.methods) try {
        find_grouper(method).configure(method_options(experiment, method, level));
      } catch (const InvalidInput& error) {
        table.fail(experiment.sweep == Sweep::Option ? "attribute" : "options", error.what());
      }
  }
  if (experiment.sweep == Sweep::Option) {
    const std::string method = info.attribute.substr(0, info.attribute.find('.'));
    if (std::find(info.methods.begin(), info.methods.end(), method) == info.methods.end())
      table.fail("attribute", "sweeps an option of " + method + ", which is not among the groupers");
  }
}

}  // namespace

std::string bin_label(double low, double high, bool is_last) {
  return "[" + to_text(low) + "," + to_text(high) + (is_last ? "]" : ")");
}

OptionOverrides method_options(const Experiment& experiment, const std::string& method, const StudyLevel& level) {
  const auto found = experiment.options.find(method);
  OptionOverrides options = found == experiment.options.end() ? OptionOverrides() : found->second;
  const std::string prefix = method + ".";
  if (experiment.sweep == Sweep::Option && experiment.info.attribute.rfind(prefix, 0) == 0)
    options[experiment.info.attribute.substr(prefix.size())] = to_text(level.low);
  return options;
}

Experiment parse_experiment(const std::string& path, const std::string& text) {
  const TomlTable table = TomlTable::parse(path, text);
  table.only({"name",    "title",  "figure", "preset",   "dataset", "attribute", "axis",         "levels",
              "bins",    "labels", "filter", "groupers", "options", "matching",  "threshold_pr", "least_true_matches",
              "repeats", "seed",   "dense",  "tables"});
  if (table.text("preset").value_or("paper") != "paper")
    table.fail("preset", "expected \"paper\": every option at its default, the values of the paper's Table 1");
  Experiment experiment;
  ExperimentInfo& info = experiment.info;
  info.name = required_text(table, "name");
  if (info.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-_") != std::string::npos)
    table.fail("name", "expected small letters, digits, - and _ only");
  info.title = table.text("title").value_or(info.name);
  info.figure = table.text("figure").value_or("");
  info.dataset = required_text(table, "dataset");
  info.attribute = required_text(table, "attribute");
  info.axis = table.text("axis").value_or(info.attribute);
  experiment.sweep = sweep_of(table, info.attribute);
  info.levels = read_levels(table);
  info.methods = table.texts("groupers");
  if (info.methods.empty()) info.methods = method_names();
  for (std::size_t i = 0; i < info.methods.size(); ++i) {
    check_method(table, "groupers", info.methods[i]);
    if (std::count(info.methods.begin(), info.methods.end(), info.methods[i]) > 1)
      table.fail("groupers", info.methods[i] + " stands twice");
  }
  info.threshold_pr = table.number("threshold_pr").value_or(info.threshold_pr);
  if (!(info.threshold_pr >= 0)) table.fail("threshold_pr", "expected a length of at least zero");
  info.least_true_matches = whole_number(table, "least_true_matches", info.least_true_matches, 1);
  experiment.repeats = whole_number(table, "repeats", experiment.repeats, 1);
  experiment.tables = whole_number(table, "tables", experiment.tables, 1);
  experiment.seed = static_cast<std::uint64_t>(whole_number(table, "seed", 1, 0));
  experiment.dense = table.flag("dense").value_or(false);
  experiment.filters = read_filters(table);
  read_matching(table, experiment);
  read_options(table, experiment);
  check_experiment(table, experiment);
  return experiment;
}

Experiment read_experiment(const std::string& name_or_path) {
  std::error_code ignored;
  if (std::filesystem::exists(name_or_path, ignored) && !std::filesystem::is_directory(name_or_path, ignored))
    return parse_experiment(name_or_path, read_file(name_or_path));
  const auto found = embedded_experiments().find(name_or_path + ".toml");
  if (found != embedded_experiments().end()) return parse_experiment(found->first, found->second);
  const std::string nearest = nearest_name(name_or_path, built_in_experiments());
  throw IoError(name_or_path, "",
                "is neither a file nor an experiment of the program" +
                    (nearest.empty() ? ", 'corral evaluate --help' lists those"
                                     : ", did you mean " + corral::quoted(nearest) + "?"));
}

std::vector<std::string> built_in_experiments() {
  std::vector<std::string> names;
  for (const auto& [file, text] : embedded_experiments()) names.push_back(std::filesystem::path(file).stem().string());
  return names;
}

}  // namespace corral
