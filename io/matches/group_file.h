// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "kernel/types.h"

namespace corral {

/// The content of a group file: a selection from a table of matches.
struct GroupTable {
  int matches = 0;             ///< rows of the table
  Indices selected;            ///< ascending
  std::vector<double> scores;  ///< one per row, or empty
};

/// Reads `row,selected,score`: one line per match in order, selected 0 or 1, score empty on all lines or on none. Throws
/// IoError naming file and line.
GroupTable read_group(const std::string& path);

/// The same, and throws IoError unless the file has exactly this many rows, one per match.
GroupTable read_group_of(const std::string& path, int matches);

/// The same as text.
std::string group_text(const GroupTable& group);

}  // namespace corral
