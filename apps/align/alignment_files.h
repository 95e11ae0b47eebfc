// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/align/align_view_set.h"
#include "apps/runtime/json.h"
#include "io/file.h"

namespace corral {

/// The name of a view: that of its file without folder and ending.
std::string view_name(const std::string& path);

/// Poses between named views: a CSV file with the columns source, target, transform (a file, from the folder of the CSV
/// file) and, if there is one, weight. Other columns are not read, so that pairs.csv of an alignment can be handed back.
/// Throws IoError naming file and line: a missing column, a name that is none of the views, a pair of a view with itself, a
/// weight that is not above 0, a transform that cannot be read.
std::vector<ViewPair> read_view_pairs(const std::string& path, const std::vector<std::string>& names);

/// Where the measured pose of a pair is, numbered from 1.
std::string pose_file(const std::string& folder, std::size_t number);

/// <view>.xf for each view (world_from_view), pairs.csv, and the measured poses in poses/.
std::vector<FileContent> alignment_files(const std::string& folder, const std::vector<std::string>& names,
                                         const AlignedViews& aligned);

/// The pairs as a table, those that somebody should look at once more below it, and the parts.
std::string alignment_text(const std::vector<std::string>& names, const AlignedViews& aligned);
Json to_json(const std::vector<std::string>& names, const AlignedViews& aligned);

}  // namespace corral
