// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace corral {

/// The whole content of a regular file or a pipe. Throws IoError naming the path: missing, a directory, not readable.
std::string read_file(const std::string& path);

/// Writes a file whole or not at all: to a temporary file beside it, which then replaces it. Pipes and devices are written
/// to directly. When it returns, the file survives a power cut. Throws IoError, and leaves an existing file as it was; only if
/// the last step fails, which puts the new name on the disk, the new file is there.
void write_file(const std::string& path, const std::string& content);

struct FileContent {
  std::string path, content;
};

/// The same for several files: all temporary files are written before the first one replaces its target. Throws IoError if
/// two have the same target.
void write_files(const std::vector<FileContent>& files);

/// Throws what write_file would throw, to be called before long work. Changes nothing.
void check_writable(const std::string& path);

/// Removes a file that an earlier call left, if it exists. Pipes and devices stay. Throws IoError.
void remove_file(const std::string& path);

/// Removes the temporary files that killed calls left in a folder and its subfolders. Throws IoError if the folder cannot be
/// read.
void remove_leftovers(const std::string& folder);

/// Creates a folder and its parents where they do not exist. Throws IoError if that is not possible.
void make_folder(const std::string& path);

}  // namespace corral
