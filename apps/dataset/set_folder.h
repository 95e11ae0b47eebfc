// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "io/pairs/dataset_file.h"

namespace corral {

/// The folder of a data set that is being made. Its recipe is written first, its manifest last: an interrupted call continues
/// when repeated, and an unfinished set has no manifest. Files appear whole or not at all.
class SetFolder {
 public:
  /// `recipe`: everything that the files depend on, in lines. Creates the folder. Throws IoError if it holds a set of another
  /// recipe or without a recipe, or cannot be written to.
  SetFolder(const std::string& folder, const std::string& recipe);

  std::string path(const std::string& file) const;  ///< of a file of the set
  bool has(const std::string& file) const;          ///< from an earlier call
  void put(const std::string& file, const std::string& content) const;
  void finish(const Dataset& dataset) const;  ///< writes the manifest

 private:
  std::string folder_;
};

/// The mesh files in a folder, sorted by name. Throws IoError if the folder cannot be read or holds none.
std::vector<std::string> mesh_files(const std::string& folder);

/// A hash of the content of a file, for recipes.
std::string checksum(const std::string& path);

/// A text with - for each character that the name of a pair may not contain.
std::string pair_word(std::string text);
/// The same for the name of a file, without folders and ending.
std::string file_word(const std::string& file);

}  // namespace corral
