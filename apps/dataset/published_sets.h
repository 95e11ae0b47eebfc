// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace corral {

/// A file whose content is known.
struct KnownFile {
  std::string name, package, sha256;  ///< package: the Debian package that holds it, such as "opencv-doc"
};

/// Where the meshes of a data set come from, as data/<name>.toml describes it.
struct PublishedSet {
  std::string name;           ///< as in `corral dataset import <name>`
  std::string title, origin;  ///< in words
  std::string place;          ///< where to find it or to ask for it
  std::string terms;
  std::vector<std::string> citation;
  std::vector<std::string> layout;  ///< the files of the folder, a line each: name, content
  std::vector<std::string> files;   ///< expected names
  std::vector<KnownFile> known;
  std::string use;  ///< the command that reads it
};

/// The default data, then the published sets that the program knows.
std::vector<PublishedSet> published_sets();

}  // namespace corral
