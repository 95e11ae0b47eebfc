// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "kernel/options.h"

namespace corral {

/// The names of all methods, detectors and descriptors, in that order: what NAME of NAME.OPTION may be.
std::vector<std::string> option_names();

/// The default options of one of them; null for another name.
const std::vector<OptionValue>* default_options(const std::string& name);

/// "name.option" in two.
std::pair<std::string, std::string> split_option(const std::string& option);

}  // namespace corral
