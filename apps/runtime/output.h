// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "apps/runtime/json.h"

namespace corral {

/// Writes to the file, or to stdout if no file is named.
void put(const std::string& path, const std::string& text);
void put(const std::string& path, const Json& json);

/// A line for the user, on stderr.
void say(const std::string& line);

}  // namespace corral
