// SPDX-License-Identifier: MIT
#include "apps/pair/methods.h"

#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>
#include <stdexcept>

#include "apps/pair/external_method.h"
#include "apps/pair/portfolio.h"
#include "grouping/plugin.h"
#include "io/text/line_reader.h"
#include "kernel/error.h"

namespace corral {
namespace {

/// What a shared library offers, and where it is.
struct Plugin {
  std::string file;
  std::vector<OptionValue> options;
  decltype(&corral_plugin_group) group = nullptr;
};

struct Methods {
  std::vector<Grouper> table;
  std::vector<std::string> of_plugins;
  std::map<std::string, std::string> files;  ///< of plug-ins, by method
};

Methods& all_methods() {
  static Methods methods = [] {
    Methods own;
    own.table = groupers();
    for (const Grouper& portfolio : portfolios()) own.table.push_back(portfolio);
    return own;
  }();
  return methods;
}

std::string whole_path(const std::string& file) { return std::filesystem::absolute(file).lexically_normal().string(); }

template <class Function>
Function function_of(void* library, const std::string& file, const char* name) {
  void* found = dlsym(library, name);
  if (!found)
    throw IoError(file, "", std::string("has no function ") + name + ", expected a plug-in (grouping/plugin.h)");
  return reinterpret_cast<Function>(found);
}

/// "name=value meaning", one in a line.
std::vector<OptionValue> options_of(const std::string& file, const std::string& text) {
  std::vector<OptionValue> options;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) continue;
    const std::size_t equals = line.find('='), end = std::min(line.find(' '), line.size());
    if (equals == std::string::npos || equals == 0 || equals + 1 >= end)
      throw IoError(file, "option " + std::to_string(options.size() + 1),
                    "is '" + line + "', expected NAME=VALUE MEANING");
    options.push_back({line.substr(0, equals), "", line.substr(equals + 1, end - equals - 1), "", "as the plug-in says",
                       end < line.size() ? line.substr(end + 1) : ""});
  }
  return options;
}

/// Frames, 9 numbers each, row by row; empty where the table has none.
std::vector<double> frame_numbers(const LocalReferenceFrames& frames) {
  std::vector<double> numbers;
  for (const auto& frame : frames)
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) numbers.push_back(frame(row, column));
  return numbers;
}

GroupingResult call_plugin(const Plugin& plugin, const std::string& options, const CorrespondenceSet& matches) {
  matches.validate();
  const auto rows = static_cast<std::size_t>(matches.size());
  const std::vector<double> source_frames = frame_numbers(matches.source_frames),
                            target_frames = frame_numbers(matches.target_frames);
  const auto or_null = [](const auto& column) { return column.size() > 0 ? column.data() : nullptr; };
  corral_table table{};
  table.rows = matches.size();
  for (int axis = 0; axis < 3; ++axis) {
    table.source[axis] = matches.source_points.col(axis).data();
    table.target[axis] = matches.target_points.col(axis).data();
    table.source_centroid[axis] = matches.source_centroid_or_mean()(axis);
  }
  table.resolution = matches.resolution;
  table.feature_distance = or_null(matches.feature_distance);
  table.second_feature_distance = or_null(matches.second_feature_distance);
  table.source_frames = or_null(source_frames), table.target_frames = or_null(target_frames);
  std::vector<unsigned char> selected(rows);
  std::vector<double> scores(rows);
  corral_answer answer{};
  answer.selected = selected.data(), answer.scores = scores.data();
  if (const char* refusal = plugin.group(&table, options.c_str(), &answer)) throw std::runtime_error(refusal);
  GroupingResult result;
  for (std::size_t row = 0; row < rows; ++row)
    if (selected[row] != 0) result.selected.push_back(static_cast<int>(row));
  if (answer.has_scores != 0) {
    for (std::size_t row = 0; row < rows; ++row)
      if (!std::isfinite(scores[row]))
        throw std::runtime_error("its score of row " + std::to_string(row) + " is not finite, expected a number");
    result.scores = std::move(scores);
  }
  if (answer.has_pose == 0) return result;
  RigidTransform pose;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) pose.rotation(row, column) = answer.pose[4 * row + column];
    pose.translation(row) = answer.pose[4 * row + 3];
  }
  constexpr double kRounding = 1e-6;
  if (!is_rotation(pose.rotation, kRounding) || !pose.translation.allFinite())
    throw std::runtime_error("its pose is no rigid transform, expected a rotation and a translation");
  result.target_from_source = pose;
  return result;
}

ConfiguredGrouper configure(const std::string& name, const Plugin& plugin, const OptionOverrides& overrides) {
  std::vector<OptionValue> options = plugin.options;
  for (const auto& [key, value] : overrides) {
    const auto is_it = [&, key = key](const OptionValue& option) { return option.name == key; };
    const auto found = std::find_if(options.begin(), options.end(), is_it);
    if (found == options.end()) detail::reject_unknown_option(name, key, plugin.options);
    found->value = value;
  }
  std::string text;
  for (const OptionValue& option : options) text += option.name + "=" + option.value + "\n";
  return {[plugin, text](const CorrespondenceSet& matches) { return call_plugin(plugin, text, matches); }, options,
          [](int) { return 0.0; }};
}

}  // namespace

const std::vector<Grouper>& methods() { return all_methods().table; }

const Grouper& find_method(const std::string& name) { return find_entry(methods(), "grouper", name); }

std::vector<std::string> plugin_methods() { return all_methods().of_plugins; }

std::string plugin_file(const std::string& method) {
  const auto found = all_methods().files.find(method);
  return found == all_methods().files.end() ? std::string() : found->second;
}

bool is_loaded_plugin(const std::string& file) {
  const std::vector<std::string> names = plugin_methods();
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& method) { return plugin_file(method) == whole_path(file); });
}

void load_plugin(const std::string& given) {
  if (is_loaded_plugin(given)) return;
  const std::string file = whole_path(given);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored))
    throw IoError(given, "", "is not a file, expected a shared library");
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);  // never closed: its functions are in use until the end
  if (!library) throw IoError(given, "", std::string("cannot be loaded: ") + dlerror());
  const int version = function_of<decltype(&corral_plugin_version)>(library, given, "corral_plugin_version")();
  if (version != CORRAL_PLUGIN_VERSION)
    throw IoError(given, "",
                  "is a plug-in of version " + std::to_string(version) + ", expected version " +
                      std::to_string(CORRAL_PLUGIN_VERSION));
  const std::string name = function_of<decltype(&corral_plugin_name)>(library, given, "corral_plugin_name")();
  if (!is_method_name(name))
    throw IoError(given, "",
                  "is named " + corral::quoted(name) +
                      ", expected letters, digits and . _ + - only, and no name of another method");
  Plugin plugin{file, {}, function_of<decltype(&corral_plugin_group)>(library, given, "corral_plugin_group")};
  plugin.options =
      options_of(given, function_of<decltype(&corral_plugin_options)>(library, given, "corral_plugin_options")());
  Methods& all = all_methods();
  all.table.push_back(
      {name, name, "plug-in " + given, "", plugin.options,
       [name, plugin](const OptionOverrides& overrides) { return configure(name, plugin, overrides); }});
  all.of_plugins.push_back(name);
  all.files[name] = file;
}

}  // namespace corral
