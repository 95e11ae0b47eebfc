// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace corral {

/// A folder of its own among the temporary files, removed with all that lies in it.
class TemporaryFolder {
 public:
  /// Throws IoError if there can be none.
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::string& path() const { return path_; }
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

}  // namespace corral
