// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

#include "io/disk/open_file.h"

namespace corral {

/// A file that only grows, and of which this object is the only writer. What append() has returned from survives the end of the
/// process and a power cut; what it was in the middle of may be there in part.
class AppendFile {
 public:
  /// A new empty file. Absent if something of this name exists, which stays as it is: of two processes that ask for the same
  /// name, on one machine or on two that share a file system, one gets it. Throws IoError.
  static std::optional<AppendFile> create(const std::string& path);

  /// Adds the whole text and returns when it is on the disk. Where that fails, the file is cut to the length that it had, and
  /// later calls may succeed; where that fails too, every later call throws. Throws IoError.
  void append(const std::string& text);

  const std::string& path() const { return file_.path(); }

 private:
  explicit AppendFile(OpenFile file) : file_(std::move(file)) {}

  OpenFile file_;
  off_t size_ = 0;          ///< of what has been appended whole
  bool is_broken_ = false;  ///< something may lie behind it
};

}  // namespace corral
