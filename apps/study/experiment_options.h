// SPDX-License-Identifier: MIT
#pragma once

#include "apps/study/specification.h"

namespace corral {

/// The options that a grouper, detector or descriptor has in the experiment at a level, seeds left out.
OptionOverrides options_at(const Experiment& experiment, const std::string& name, const StudyLevel& level);

/// How pairs are matched at a level: with the options of what is in use there.
MatchSettings matching_at(const Experiment& experiment, const StudyLevel& level);

/// The same with another value of an option "name.option" of a detector or descriptor in use.
MatchSettings with_option(MatchSettings matching, const std::string& option, const std::string& value);

/// Changes options of an experiment as --set does. Throws InvalidInput for what the experiment sweeps or does not accept.
void override_options(Experiment& experiment, const OptionsByName& options);

/// The value of a choice of the matching (detector, descriptor, frames, ..) by its name. Throws InvalidInput.
void set_choice(MatchSettings& matching, const std::string& name, const std::string& value);

/// Whether a grouper, detector or descriptor takes part in the experiment.
bool is_in_use(const Experiment& experiment, const std::string& name);

/// Throws InvalidInput if an option that the experiment gives is not accepted, at any level.
void check_options(const Experiment& experiment);

}  // namespace corral
