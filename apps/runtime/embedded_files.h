// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

namespace corral {

/// Text files that are compiled into the program, by name. corral_embed (embed.cmake) makes the functions that return them;
/// their users declare them: `const EmbeddedFiles& embedded_claims();`
using EmbeddedFiles = std::map<std::string, std::string>;

}  // namespace corral
