// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "kernel/correspondence_set.h"

namespace corral {

/// Reads a table of matches:
///
///   # corral matches 1
///   # resolution <mesh units per pr>
///   # source_centroid x y z                      (optional)
///   source_keypoint,target_keypoint,source_x,source_y,source_z,target_x,target_y,target_z,feature_distance,
///       second_feature_distance,source_frame_0..8,target_frame_0..8          (one header line)
///   one row per match
///
/// Columns may come in any order; only the six coordinates are required, a frame needs all nine, unknown ones are ignored.
/// Throws    IoError naming file and line: a ragged row, a field that is not a finite number, a resolution that is not
///           positive, a missing or doubled column.
CorrespondenceSet read_matches(const std::string& path);

/// The same as text with every column that the table has; reading it back gives the same table.
std::string matches_text(const CorrespondenceSet& matches);

}  // namespace corral
