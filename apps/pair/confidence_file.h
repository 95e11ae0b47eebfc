// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "apps/pair/confidence.h"

namespace corral {

/// confidence.toml, and back. Throws IoError naming file and key.
std::string confidence_text(const ConfidenceModels& models);
ConfidenceModels parse_confidence(const std::string& path, const std::string& text);

/// That of paper/confidence.toml, which is compiled into the program.
const ConfidenceModels& built_in_confidence();

}  // namespace corral
