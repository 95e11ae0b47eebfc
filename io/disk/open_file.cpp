// SPDX-License-Identifier: MIT
#include "io/disk/open_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "kernel/error.h"

namespace corral {

void fail_by_errno(const std::string& path, const std::string& action) {
  throw SystemError(path, "", "cannot " + action + " (" + std::strerror(errno) + ")");
}

void fail_by_code(const std::string& path, const std::string& action, const std::error_code& reason) {
  errno = reason.value();
  fail_by_errno(path, action);
}

OpenFile::OpenFile(int descriptor, std::string path) : descriptor_(descriptor), path_(std::move(path)) {
  if (descriptor_ < 0) fail_by_errno(path_, "be opened");
}

OpenFile::OpenFile(OpenFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), path_(std::move(other.path_)) {}

OpenFile& OpenFile::operator=(OpenFile&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(path_, other.path_);
  return *this;
}

OpenFile::~OpenFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OpenFile::write(const std::string& content) {
  for (std::size_t done = 0; done < content.size();) {
    const ssize_t written = ::write(descriptor_, content.data() + done, content.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail_by_errno(path_, "be written");
    done += static_cast<std::size_t>(written);
  }
}

void OpenFile::put_on_disk() {
  int result = 0;
  do result = ::fdatasync(descriptor_);
  while (result != 0 && errno == EINTR);
  if (result != 0) fail_by_errno(path_, "be written");
}

void OpenFile::close() {
  // The descriptor is gone whatever close() says; an interrupted one is no error of the file.
  if (::close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR) fail_by_errno(path_, "be written");
}

void put_names_on_disk(const std::string& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0 && errno == EACCES) return;  // may be written to, but not listed
  const OpenFile names(descriptor, folder);
  // Some file systems refuse to sync a folder, as they do it by themselves or not at all.
  if (::fsync(names.descriptor()) != 0 && errno != EINVAL && errno != ENOTSUP && errno != EINTR)
    fail_by_errno(folder, "be written");
}

}  // namespace corral
