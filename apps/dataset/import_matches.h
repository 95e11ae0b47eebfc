// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/dataset/match_importer.h"
#include "apps/runtime/progress.h"

namespace corral {

struct ImportFolderOptions : MatchImportOptions {
  std::string folder, output;
  std::string layout;  ///< empty: the one that is there
};

/// A published folder as a data set: matches/<pair>.csv, truth/<pair>.txt, and pairs.csv with the attributes that the layout has,
/// `rows` and `inlier_ratio` (percent). Clouds stay where they are.
/// Returns   a line for each pair, and notes.
/// Throws    IoError naming the file. The manifest is written last, so that an unfinished set has none.
std::vector<std::string> import_match_folder(const ImportFolderOptions& options, Progress& progress);

}  // namespace corral
