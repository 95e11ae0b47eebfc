// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace corral {

/// Files that are written piece by piece and take their places together: each as a temporary file beside the one that it will
/// replace. Where commit() is not reached, what was there stays as it was. Pipes and devices are written to in commit().
class StagedFiles {
 public:
  StagedFiles();
  ~StagedFiles();
  StagedFiles(const StagedFiles&) = delete;
  StagedFiles& operator=(const StagedFiles&) = delete;

  void begin(const std::string& path);     ///< a further file; the one before is whole. Throws IoError
  void write(const std::string& content);  ///< at the end of the file begun last. Throws IoError
  /// Replaces all files. When it returns, they survive a power cut. Throws IoError if two have the same place; only if the
  /// last step fails, which puts the new names on the disk, the new files are there.
  void commit();

 private:
  class File;
  void seal();  ///< the file begun last is whole

  std::vector<std::unique_ptr<File>> files_;
};

/// Removes the temporary files that killed calls left beside a file of this name. Throws IoError if the folder cannot be read.
void remove_leftovers_of(const std::string& path);

/// Whether a file of this name is one that a call is writing, or that a killed one left.
bool is_temporary(const std::string& name);

}  // namespace corral
