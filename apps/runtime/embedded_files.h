// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

namespace corral {

/// Text files that the program carries with it, by their names. corral_embed (embed.cmake) makes the functions that return
/// them; who uses one declares it: `const EmbeddedFiles& embedded_claims();`
using EmbeddedFiles = std::map<std::string, std::string>;

}  // namespace corral
