// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "io/mesh/mesh_file.h"

// What several subcommands do with the files that they are told.
namespace corral {

/// A surface that a command line names. What its reader left out is said on stderr. `drop_stray`: without the lone vertices
/// that are further than 20 median spacings from all others, which is said too. Throws IoError as read_surface does.
Mesh read_input(const std::string& path, bool drop_stray = false);

/// Throws UsageError if an output is one of the inputs, or two outputs are one file, by whatever name: called before any
/// work, so that nothing is lost. Empty names are ignored.
void keep_inputs(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs);

}  // namespace corral
