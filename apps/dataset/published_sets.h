// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace corral {

/// A file whose content is known.
struct KnownFile {
  std::string name, package, sha256;  ///< package: what brings it, such as "opencv-doc"
};

/// Where the meshes of a data set come from, as data/<name>.toml describes it.
struct PublishedSet {
  std::string name;           ///< as in `corral dataset import <name>`
  std::string title, origin;  ///< in words
  std::string place;          ///< where it is, or where to ask for it
  std::string terms;
  std::vector<std::string> citation;
  std::vector<std::string> layout;  ///< lines of a small map of the folder: file, what it is
  std::vector<std::string> files;   ///< expected names
  std::vector<KnownFile> known;
  std::string use;  ///< the command that reads it
};

/// The default data, then the published sets that the program knows.
std::vector<PublishedSet> published_sets();

}  // namespace corral
