// SPDX-License-Identifier: MIT
#include "apps/study/experiment_options.h"

#include <algorithm>

#include "apps/pair/methods.h"
#include "apps/pair/option_names.h"
#include "apps/pair/surface_choice.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {

void set_choice(MatchSettings& matching, const std::string& name, const std::string& value) {
  if (name == "detector") matching.detector = find_detector(value).name;
  if (name == "descriptor") matching.descriptor = find_descriptor(value).name;
  MatchSettings::visit_fields(matching, [&](const OptionField& field, auto& member) {
    if (field.name == name && !detail::parse_value(value, member))
      throw InvalidInput("matching", name, "'" + value + "'",
                         detail::accepted_values<std::decay_t<decltype(member)>>(field));
  });
}

OptionOverrides options_at(const Experiment& experiment, const std::string& name, const StudyLevel& level) {
  const auto found = experiment.options.find(name);
  OptionOverrides options = found == experiment.options.end() ? OptionOverrides() : found->second;
  if (experiment.sweep == Sweep::Option) {
    const auto [swept, option] = split_option(experiment.info.attribute);
    if (swept == name) options[option] = level.label;
  }
  return experiment.by_surface ? with_kept_poses(name, std::move(options)) : options;
}

MatchSettings matching_at(const Experiment& experiment, const StudyLevel& level) {
  MatchSettings matching = experiment.matching;
  if (experiment.sweep == Sweep::Choice) set_choice(matching, experiment.info.attribute, level.label);
  for (const std::string& name : matching.in_use()) {
    const OptionOverrides options = options_at(experiment, name, level);
    if (!options.empty()) matching.options[name] = options;
  }
  return matching;
}

MatchSettings with_option(MatchSettings matching, const std::string& option, const std::string& value) {
  const auto [name, field] = split_option(option);
  matching.options[name][field] = value;
  return matching;
}

void override_options(Experiment& experiment, const OptionsByName& options) {
  for (const auto& [name, overrides] : options)
    for (const auto& [option, value] : overrides) {
      const std::string full = name + "." + option;
      if (full == experiment.info.attribute || full == experiment.varied)
        throw InvalidInput("--set", full, "swept by the experiment " + experiment.info.name, "another option");
      if (option == "seed") throw InvalidInput("--set", full, value, "the key seed of the experiment");
      experiment.options[name][option] = value;
    }
  check_options(experiment);
}

bool is_in_use(const Experiment& experiment, const std::string& name) {
  const std::vector<std::string>& methods = experiment.info.methods;
  if (std::find(methods.begin(), methods.end(), name) != methods.end()) return true;
  return std::any_of(experiment.info.levels.begin(), experiment.info.levels.end(), [&](const StudyLevel& level) {
    const std::vector<std::string> used = matching_at(experiment, level).in_use();
    return std::find(used.begin(), used.end(), name) != used.end();
  });
}

void check_options(const Experiment& experiment) {
  for (const auto& [name, overrides] : experiment.options)
    if (!is_in_use(experiment, name))
      throw InvalidInput(experiment.info.name, "an option", "that of '" + name + "', which is not in use",
                         "those of its groupers, detectors and descriptors");
  for (const StudyLevel& level : experiment.info.levels) {
    for (const std::string& method : experiment.info.methods)
      find_method(method).configure(options_at(experiment, method, level));
    const MatchSettings matching = matching_at(experiment, level);
    matching.validate();
    for (const double value : experiment.varied_values)
      with_option(matching, experiment.varied, to_text(value)).validate();
  }
}

}  // namespace corral
