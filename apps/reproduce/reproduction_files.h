// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "apps/reproduce/reproduction.h"
#include "apps/runtime/json.h"

namespace corral {

/// The statements by the readings, one line each: its class, its verdict under the text and under each other reading alone,
/// and under the combination that was found (on all pairs and on the held-out half).
std::string matrix_csv(const Reproduction& reproduction);

/// All of it, with margins.
Json reproduction_json(const Reproduction& reproduction);

/// What it comes to, for the terminal.
std::string reproduction_text(const Reproduction& reproduction);

/// The combination as a preset of experiments.
std::string preset_toml(const Reproduction& reproduction);

}  // namespace corral
