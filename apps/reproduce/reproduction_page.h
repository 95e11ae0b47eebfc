// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "apps/reproduce/reproduction.h"

namespace corral {

/// The matrix of statements by readings as one HTML file without scripts: a column for each reading, under its point, and the
/// combination that was found; what the readings say, and where they come from, above it.
std::string reproduction_html(const Reproduction& reproduction);

}  // namespace corral
