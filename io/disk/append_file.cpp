// SPDX-License-Identifier: MIT
#include "io/disk/append_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <utility>

#include "kernel/error.h"

namespace corral {

std::optional<AppendFile> AppendFile::create(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor < 0 && errno == EEXIST) return std::nullopt;
  if (descriptor < 0) fail_by_errno(path, "be created");
  AppendFile file(OpenFile(descriptor, path));
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  try {
    put_names_on_disk(folder.empty() ? "." : folder.string());
  } catch (const IoError&) {
    ::unlink(path.c_str());  // nothing is in it
    throw;
  }
  return file;
}

void AppendFile::append(const std::string& text) {
  if (is_broken_)
    throw IoError(path(), "byte " + std::to_string(size_),
                  "cannot be appended to, because an earlier write failed here and could not be undone");
  try {
    file_.write(text);
    file_.put_on_disk();
    size_ += static_cast<off_t>(text.size());
  } catch (const IoError&) {
    is_broken_ = ::ftruncate(file_.descriptor(), size_) != 0;
    throw;
  }
}

}  // namespace corral
