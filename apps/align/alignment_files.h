// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/align/align_view_set.h"
#include "apps/runtime/json.h"
#include "io/disk/file.h"

namespace corral {

/// The name of a view: its file name without folder and ending.
std::string view_name(const std::string& path);

/// Poses between named views: a CSV file with the columns source, target, transform (a file, from the folder of the CSV
/// file) and optionally weight. Other columns are ignored, so that pairs.csv of an alignment can be read back. Throws
/// IoError naming file and line: a missing column, an unknown view, a pair of a view with itself, a weight that is not
/// above 0, a transform that cannot be read.
std::vector<ViewPair> read_view_pairs(const std::string& path, const std::vector<std::string>& names);

/// The files of transforms that such a table names.
std::vector<std::string> pose_names(const std::string& path);

/// The file of the measured pose of a pair, numbered from 1.
std::string pose_file(const std::string& folder, std::size_t number);

/// <view>.xf for each view (world_from_view), pairs.csv, and the measured poses in poses/.
std::vector<FileContent> alignment_files(const std::string& folder, const std::vector<std::string>& names,
                                         const AlignedViews& aligned);

/// The pairs as a table, those that should be inspected again below it, and the parts.
std::string alignment_text(const std::vector<std::string>& names, const AlignedViews& aligned);
Json to_json(const std::vector<std::string>& names, const AlignedViews& aligned);

}  // namespace corral
