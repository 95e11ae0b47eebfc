// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <system_error>

#include "kernel/error.h"

// What the writers of this room share. An IoError names the file and the reason that the system gives.
namespace corral {

/// The system refused what was asked of a file: at another time it may not.
struct SystemError : IoError {
  using IoError::IoError;
};

/// Throws SystemError "PATH: cannot ACTION (REASON)" with the reason in errno.
[[noreturn]] void fail_by_errno(const std::string& path, const std::string& action);
/// The same with another reason.
[[noreturn]] void fail_by_code(const std::string& path, const std::string& action, const std::error_code& reason);

/// A descriptor of the system with the name of its file, closed at the end of its life.
class OpenFile {
 public:
  OpenFile(int descriptor, std::string path);  ///< throws IoError where the descriptor is below 0
  OpenFile(OpenFile&& other) noexcept;
  OpenFile& operator=(OpenFile&& other) noexcept;
  ~OpenFile();

  int descriptor() const { return descriptor_; }
  const std::string& path() const { return path_; }

  void write(const std::string& content);  ///< throws IoError; a part may have been written
  void put_on_disk();                      ///< returns when the content survives a power cut; throws IoError
  /// Throws IoError: some file systems say only here that the disk is full.
  void close();

 private:
  int descriptor_;
  std::string path_;
};

/// Returns when the names in a folder survive a power cut, where the file system can do that. Throws IoError.
void put_names_on_disk(const std::string& folder);

}  // namespace corral
