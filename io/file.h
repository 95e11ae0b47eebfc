// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace corral {

/// The whole content of a regular file or a pipe. Throws IoError naming the path: missing, a directory, not readable.
std::string read_file(const std::string& path);

/// Writes a file whole or not at all: into a new file beside it, which then takes its place. Pipes and devices are written
/// to directly. Throws IoError; what was there before is then still there.
void write_file(const std::string& path, const std::string& content);

struct FileContent {
  std::string path, content;
};

/// The same for several files: all are written beside their places before the first takes its own. Throws IoError if two
/// have the same place.
void write_files(const std::vector<FileContent>& files);

/// Throws what write_file would throw before long work is done for nothing. Changes nothing.
void check_writable(const std::string& path);

/// Takes away a file that an earlier run left, if it is there. Pipes and devices stay. Throws IoError.
void remove_file(const std::string& path);

/// Takes away what writes that were killed left in a folder and below: files beside a place that never took it. Throws
/// IoError if the folder cannot be read.
void remove_leftovers(const std::string& folder);

/// Creates a folder and its parents if they are not there. Throws IoError if that is not possible.
void make_folder(const std::string& path);

}  // namespace corral
