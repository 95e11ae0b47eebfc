// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "apps/reproduce/readings.h"

namespace corral {

/// Where a set is: a folder of that name in the data folder, or that folder itself.
std::string set_folder(const std::string& data, const std::string& set);

/// A data folder in which one set has another form: `folder` receives it, and from then on has it. Surfaces that do not change
/// are named where they are. An interrupted call continues when it is repeated. Throws IoError, InvalidInput.
void write_pair_form(const std::string& data, const std::string& set, PairForm form, const std::string& folder);

}  // namespace corral
