// SPDX-License-Identifier: MIT
#include "apps/runtime/output.h"

#include <cstdio>

#include "io/disk/file.h"
#include "kernel/error.h"

namespace corral {

void put(const std::string& path, const std::string& text) {
  if (!path.empty()) return write_file(path, text);
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw IoError("standard output", "", "cannot be written");
}

void put(const std::string& path, const Json& json) { put(path, json_text(json)); }

void say(const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); }

}  // namespace corral
