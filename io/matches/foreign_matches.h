// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/array/number_table.h"
#include "kernel/correspondence_set.h"
#include "kernel/rigid_transform.h"

namespace corral {

/// A table of matches in a file of another program.
struct ForeignMatches {
  CorrespondenceSet matches;  ///< without the rows that hold a nan; resolution 1, as no layout states it
  int rows = 0;               ///< in the file
  Indices kept;               ///< the row of the file of each match
  std::vector<bool> labels;   ///< of the rows of the file, true: said to be correct; empty if the file has none
  std::optional<RigidTransform> target_from_source;  ///< if the file has it
  std::vector<std::string> notes;                    ///< what a user should know: a sentence each, no full stop
};

/// Where the matches are, and what they refer to.
struct ForeignFiles {
  std::string matches;             ///< the table; or the source points, if `targets` is named
  std::string targets = {};        ///< the target points, of which row i belongs to row i of `matches`
  const Points* source = nullptr;  ///< the two clouds, which pairs of indices need
  const Points* target = nullptr;
  std::optional<int> first_index = {};  ///< 0 or 1; absent: 1 if the indices show it, else 0
};

/// Reads matches as other programs write them, as text, .npy or .npz:
///
///   rows of six       x y z of the source, x y z of the target; a seventh column that holds 0 and 1 only is that of labels,
///                     others are not read, and noted. A line of names may say which columns are which
///   rows of two       indices of a point of the source cloud and of one of the target cloud
///   two files         rows of three, the source points and the target points
///   .npz              arrays under the names that programs of the field give them (io/README.md), also a true pose and labels;
///                     FILE:NAME for one array
///
/// Six (three) rows that have another length are columns. Rows with a nan are left out and counted.
/// Throws    IoError naming file and line: ragged rows, an infinite coordinate, an index without a point, two files of
///           different lengths, no matches.
ForeignMatches read_foreign_matches(const ForeignFiles& files);

}  // namespace corral
