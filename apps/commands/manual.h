// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace corral {

/// A file of the manual, by its path below the folder `share` of an installation.
struct ManualFile {
  std::string path, text;
};

/// A page of the manual for the program and one for each of its commands (man/man1/corral-run.1), made of their help, and the
/// completions of bash, zsh and fish. `version` stands in the pages.
std::vector<ManualFile> manual_files(const CLI::App& app, const std::string& version);

}  // namespace corral
