// SPDX-License-Identifier: MIT
#pragma once

// Files for tests: a folder that is gone afterwards, and what reading a file complains about.

#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "kernel/error.h"

namespace corral::testing {

/// An empty folder under the system's temporary one, removed with all it holds.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "corral_test_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw IoError(name, "", "cannot be created");
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::string& path() const { return path_; }
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }

  /// Names of what lies in it, sorted.
  std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(path_))
      found.push_back(entry.path().filename().string());
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  std::string path_;
};

/// Writes without any of the care that is under test.
inline std::string put_text(const std::string& path, const std::string& content) {
  // Some file systems wait for the disk when a file is cut to nothing, but not when it is new.
  if (std::filesystem::is_regular_file(path)) std::filesystem::remove(path);
  std::ofstream(path, std::ios::binary) << content;
  return path;
}

inline std::string text_of(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream content;
  content << stream.rdbuf();
  return content.str();
}

/// The text of the IoError that a call throws; empty if it throws nothing. Any other exception passes through.
template <class Call>
std::string io_error_of(Call&& call) {
  try {
    call();
  } catch (const IoError& error) {
    return error.what();
  }
  return "";
}

/// What an IoError says after the name of the file, which must come first; empty if the call throws nothing.
template <class Call>
std::string complaint(const std::string& path, Call&& call) {
  const std::string error = io_error_of(call);
  if (error.empty()) return "";
  EXPECT_EQ(error.substr(0, path.size()), path);
  return error.substr(path.size());
}

/// All occurrences of one text replaced by another.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

}  // namespace corral::testing
