// SPDX-License-Identifier: MIT
#include "apps/runtime/temporary_folder.h"

#include <stdlib.h>

#include <filesystem>

#include "kernel/error.h"

namespace corral {

TemporaryFolder::TemporaryFolder() : path_((std::filesystem::temp_directory_path() / "corral_XXXXXX").string()) {
  if (::mkdtemp(path_.data()) == nullptr) throw IoError(path_, "", "cannot be created, for temporary files");
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace corral
