// SPDX-License-Identifier: MIT
#include "apps/commands/command_options.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "apps/pair/evaluate_pair.h"
#include "apps/pair/methods.h"
#include "apps/pair/option_names.h"
#include "apps/runtime/memory.h"
#include "apps/runtime/output.h"
#include "io/pose/transform_file.h"
#include "io/text/toml_file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

/// What is called, with InvalidInput as UsageError.
template <class Call>
auto as_usage(const Call& call) -> decltype(call()) {
  try {
    return call();
  } catch (const InvalidInput& error) {
    throw UsageError(error.what());
  }
}

/// One flag or option for each field of an options struct.
template <class Options>
void add_fields(CLI::App& command, Options& options, const std::string& group) {
  Options::visit_fields(options, [&](const OptionField& field, auto& value) {
    using Value = std::decay_t<decltype(value)>;
    const std::string flag = "--" + std::string(field.name);
    std::string meaning = field.meaning;
    meaning[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(meaning[0])));
    if constexpr (std::is_same_v<Value, bool>) {
      command.add_flag(flag, value, meaning)->group(group);
    } else {
      const std::string accepted = detail::accepted_values<Value>(field);
      const auto parse = [&value, flag, accepted](const std::string& text) {
        if (!detail::parse_value(text, value))
          throw CLI::ValidationError(flag, "found '" + text + "', expected " + accepted);
      };
      command.add_option_function<std::string>(flag, parse, meaning)
          ->type_name(accepted)
          ->default_str(detail::value_text(value))
          ->group(group);
    }
  });
}

}  // namespace

void add_detector_and_descriptor(CLI::App& command, MatchSettings& settings) {
  command.add_option("--detector", settings.detector, "Keypoints; 'corral detectors' has their options")
      ->capture_default_str()
      ->type_name(names_of(detectors()))
      ->group("Matching");
  command.add_option("--descriptor", settings.descriptor, "Features; 'corral descriptors' has their options")
      ->capture_default_str()
      ->type_name(names_of(descriptors()))
      ->group("Matching");
}

void add_match_options(CLI::App& command, MatchSettings& settings) {
  const auto option = [&](const std::string& name, auto& value, const std::string& text) {
    return command.add_option(name, value, text)->capture_default_str()->group("Matching");
  };
  option("--resolution", settings.resolution, "pr of the pair: mean, source, target, or a length in mesh units");
  add_detector_and_descriptor(command, settings);
  add_fields(command, settings, "Matching");
  option("--sensor", settings.sensor, "Where the sensor stood, in mesh units: normals point to it")
      ->delimiter(',')
      ->expected(3)
      ->type_name("X,Y,Z");
  option("--threads", settings.threads, "0: as many as there are processors; results do not depend on it");
}

void add_drop_stray(CLI::App& command, bool& drop_stray) {
  command
      .add_flag("--drop-stray", drop_stray,
                "Leave out stray vertices: alone, or up to three together, and further than 20 median spacings from "
                "all others")
      ->group("Matching");
}

void check_usage(const MatchSettings& settings) {
  as_usage([&] { settings.validate(); });
}

void add_set_option(CLI::App& command, std::vector<std::string>& set) {
  command
      .add_option("--set", set,
                  "An option of a grouper, detector or descriptor, such as gc.tolerance_pr=2 or harris.radius_pr=4; "
                  "'corral groupers', 'detectors' and 'descriptors' list them")
      ->type_name("NAME.OPTION=VALUE")
      ->expected(1)
      ->take_all();
}

OptionsByName parse_set(const std::vector<std::string>& set) {
  const std::vector<std::string> known = option_names();
  OptionsByName options;
  for (const std::string& text : set) {
    const std::size_t equals = text.find('='), dot = text.find('.');
    if (equals == std::string::npos || dot == 0 || dot == std::string::npos || dot + 1 >= equals)
      throw UsageError("--set " + text + ": expected NAME.OPTION=VALUE, such as gc.tolerance_pr=2");
    const std::string name = text.substr(0, dot);
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      const std::string nearest = nearest_name(name, known);
      throw UsageError("--set " + text + ": no grouper, detector or descriptor is named '" + name + "'" +
                       (nearest.empty() ? "" : ", did you mean '" + nearest + "'?"));
    }
    if (!options[name].emplace(text.substr(dot + 1, equals - dot - 1), text.substr(equals + 1)).second)
      throw UsageError("--set " + text + ": this option is set twice");
  }
  return options;
}

void require_in_use(const OptionsByName& options, const std::vector<std::string>& in_use) {
  std::string list;
  for (const std::string& name : in_use) list += (list.empty() ? "" : ", ") + name;
  for (const auto& [name, overrides] : options)
    if (std::find(in_use.begin(), in_use.end(), name) == in_use.end())
      throw UsageError("--set " + name + "." + overrides.begin()->first + ": " + name +
                       " is not in use here, expected an option of " + list);
}

OptionsByName surface_part(const OptionsByName& options) {
  OptionsByName part;
  for (const auto& [name, overrides] : options)
    if (look_up(detectors(), name) || look_up(descriptors(), name)) part[name] = overrides;
  return part;
}

ConfiguredGrouper configure_grouper(const std::string& name, const OptionsByName& options) {
  return as_usage([&] {
    const auto found = options.find(name);
    return find_method(name).configure(found == options.end() ? OptionOverrides() : found->second);
  });
}

void check_threshold(double threshold_pr) {
  if (!(threshold_pr >= 0) || !std::isfinite(threshold_pr))
    throw UsageError("--threshold-pr: expected a finite length of at least 0");
}

RigidTransform read_pose(const std::string& name) {
  const StoredTransform pose = read_transform(name);
  for (const std::string& note : pose.notes) say("note: " + name + ": " + note);
  return pose;
}

CLI::Option* add_truth_options(CLI::App& command, TruthSettings& settings, const std::string& purpose) {
  auto* truth = command
                    .add_option("--truth", settings.file,
                                "True target_from_source, in any layout that 'corral transform --help' lists; one of "
                                "several poses is FILE:KEY" +
                                    purpose)
                    ->type_name("FILE[:KEY]");
  command.add_flag("--truth-inverse", settings.is_inverse, "The file has source_from_target: take the inverse")
      ->needs(truth);
  return truth;
}

RigidTransform read_truth(const TruthSettings& settings) {
  const RigidTransform pose = read_pose(settings.file);
  return settings.is_inverse ? pose.inverse() : pose;
}

Eigen::Vector3d parse_vector(const std::string& option, const std::string& text) {
  Eigen::Vector3d vector;
  std::size_t begin = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t end = axis < 2 ? text.find(',', begin) : text.size();
    const std::optional<double> number =
        end == std::string::npos ? std::nullopt : parse_double(std::string_view(text).substr(begin, end - begin));
    if (!number || !std::isfinite(*number))
      throw UsageError(option + ": found '" + text + "', expected three finite numbers x,y,z");
    vector(axis) = *number;
    begin = end + 1;
  }
  return vector;
}

void add_threads(CLI::App& command, int& threads) {
  command.add_option("--threads", threads, "0: as many as there are processors; results do not depend on it")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
}

void add_sensor_options(CLI::App& command, SensorSettings& settings) {
  auto* sensor = command
                     .add_option("--sensor", settings.sensor,
                                 "Position of the sensor, mesh units (default: as the file says, else the origin)")
                     ->type_name("X,Y,Z");
  command
      .add_option("--direction", settings.direction,
                  "Viewing direction of the sensor, if it is far away or its position is unknown")
      ->type_name("X,Y,Z")
      ->excludes(sensor);
}

ViewOptions view_options(const SensorSettings& settings) {
  ViewOptions options;
  if (settings.sensor) options.sensor = parse_vector("--sensor", *settings.sensor);
  if (settings.direction) {
    options.direction = parse_vector("--direction", *settings.direction);
    if (options.direction->isZero(0)) throw UsageError("--direction: expected a vector that is not zero");
  }
  return options;
}

std::optional<std::uint64_t> parse_size(const std::string& text) {
  const std::size_t digits = std::min(text.find_first_not_of("0123456789."), text.size());
  std::string unit = text.substr(std::min(text.find_first_not_of(' ', digits), text.size()));
  std::transform(unit.begin(), unit.end(), unit.begin(), [](unsigned char letter) { return std::tolower(letter); });
  if (!unit.empty() && unit.back() == 'b') unit.pop_back();
  const bool is_binary = unit.size() == 2 && unit.back() == 'i';
  if (is_binary) unit.pop_back();
  const std::size_t power = std::string("kmgtp").find(unit) + 1;  // of the empty unit too: 1
  const std::optional<double> number = parse_double(text.substr(0, digits));
  if (!number || unit.size() > 1 || power == 0) return std::nullopt;
  const double bytes = *number * std::pow(is_binary ? 1024 : 1000, unit.empty() ? 0 : static_cast<double>(power));
  if (!(bytes < 9e18)) return std::nullopt;
  return static_cast<std::uint64_t>(bytes);
}

CLI::Option* add_size(CLI::App& command, const std::string& option, std::uint64_t& bytes, const std::string& purpose) {
  const auto to_bytes = [](std::string& text) {
    const std::optional<std::uint64_t> size = parse_size(text);
    if (!size) return "found '" + text + "', expected a size such as 500MB or 1.5GB";
    text = std::to_string(*size);
    return std::string();
  };
  return command.add_option(option, bytes, purpose)->type_name("SIZE")->transform(CLI::Validator(to_bytes, ""));
}

void add_pose_options(CLI::App& command, std::string& rows, std::string& select) {
  const auto add = [&](const char* option, std::string& value, const std::array<const char*, 2>& words,
                       const char* purpose) {
    command.add_option(option, value, purpose)
        ->check(CLI::IsMember(std::vector<std::string>(words.begin(), words.end())))
        ->type_name(std::string(words[0]) + "|" + words[1])
        ->capture_default_str();
  };
  add("--rows", rows, kRows,
      "Matches that poses are refined over. all: also over all matches, from the pose refined over the selection, in "
      "columns of their own");
  add("--select", select, kSelect,
      "What chooses among the poses of a grouper. surface: how the two surfaces lie on each other under them, for "
      "groupers that can keep poses");
}

void add_plugin_option(CLI::App& command, std::vector<std::string>& plugins) {
  command
      .add_option("--plugin", plugins,
                  "Also run the grouper in this shared library, under the name that it states (grouping/plugin.h)")
      ->type_name("FILE")
      ->allow_extra_args(false);
}

void add_external_options(CLI::App& command, ExternalSettings& settings) {
  command
      .add_option(
          "--external", settings.methods,
          "Also run another program as a grouper: NAME='python3 mine.py {matches} {group}'. It reads the table of "
          "matches and writes the rows that it keeps, or a pose to {pose}, or both (apps/README.md)")
      ->type_name("NAME=COMMAND")
      ->allow_extra_args(false);
  add_plugin_option(command, settings.plugins);
  command
      .add_option("--external-timeout", settings.timeout_s,
                  "Longest call of such a program in seconds: then it is killed, with all that it started")
      ->capture_default_str();
}

void load_plugins(const std::vector<std::string>& files) {
  for (const std::string& file : files) load_plugin(file);
}

std::vector<std::string> with_plugins(std::vector<std::string> names) {
  for (const std::string& method : plugin_methods())
    if (std::find(names.begin(), names.end(), method) == names.end()) names.push_back(method);
  return names;
}

std::vector<ExternalMethod> external_methods(const ExternalSettings& settings) {
  if (!(settings.timeout_s > 0 && settings.timeout_s <= 1e6))
    throw UsageError("--external-timeout: expected seconds above zero, 1000000 at most");
  std::vector<ExternalMethod> methods;
  for (const std::string& text : settings.methods) try {
      methods.push_back(parse_external(text));
      methods.back().timeout_s = settings.timeout_s;
      methods.back().memory_bytes = static_cast<std::uint64_t>(half_of_memory());
      for (std::size_t i = 0; i + 1 < methods.size(); ++i)
        if (methods[i].name == methods.back().name)
          throw UsageError("--external: " + methods[i].name + " occurs twice");
    } catch (const InvalidInput& error) {
      throw UsageError(error.what());
    }
  return methods;
}

std::vector<std::string> words_of(const ExternalSettings& settings) {
  std::vector<std::string> words;
  for (const std::string& file : settings.plugins) words.insert(words.end(), {"--plugin", file});
  for (const std::string& method : settings.methods) words.insert(words.end(), {"--external", method});
  if (settings.timeout_s != ExternalSettings().timeout_s)
    words.insert(words.end(), {"--external-timeout", to_text(settings.timeout_s)});
  return words;
}

void add_memory_limit(CLI::App& command, std::uint64_t& bytes) {
  bytes = static_cast<std::uint64_t>(half_of_memory());
  add_size(command, "--memory-limit", bytes,
           "Most memory that a grouper may use, such as 500MB or 2GB; one that would need more is not called "
           "(default: half of the machine's)");
}

}  // namespace corral
