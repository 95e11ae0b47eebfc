// SPDX-License-Identifier: MIT
#include "io/disk/file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <system_error>

#include "io/disk/open_file.h"
#include "io/disk/staged_files.h"
#include "kernel/error.h"

namespace corral {

namespace fs = std::filesystem;
namespace {

/// So many bytes. Where there are millions of them, the first touch of each page costs more than reading it: the system may
/// use large pages, if it has any.
std::string zero_bytes(std::size_t count) {
  std::string bytes;
  bytes.reserve(count);
#ifdef MADV_HUGEPAGE
  constexpr std::uintptr_t kPage = std::uintptr_t{1} << 21;
  const auto begin = reinterpret_cast<std::uintptr_t>(bytes.data()), first = (begin + kPage - 1) / kPage * kPage;
  const std::uintptr_t behind = (begin + count) / kPage * kPage;
  if (first < behind)
    ::madvise(bytes.data() + (first - begin), behind - first, MADV_HUGEPAGE);  // advice: may be refused
#endif
  bytes.resize(count);
  return bytes;
}

}  // namespace

std::string read_file(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) throw SystemError(path, "", "does not exist");
  if (fs::is_directory(status)) throw IoError(path, "", "is a directory, expected a file");
  if (!error && !fs::is_regular_file(status) && !fs::is_fifo(status))
    throw IoError(path, "", "is a device, expected a file");
  const OpenFile file(::open(path.c_str(), O_RDONLY | O_CLOEXEC), path);
  // Room for one byte more than the file should have: reading then finds its end without more room. A pipe has no size.
  const std::uintmax_t size = status.type() == fs::file_type::regular ? fs::file_size(path, error) : 0;
  std::string content = zero_bytes(error ? 4096 : std::max<std::uintmax_t>(size + 1, 4096));
  std::size_t used = 0;
  while (true) {
    const ssize_t count = ::read(file.descriptor(), content.data() + used, content.size() - used);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail_by_errno(path, "be read");
    if (count == 0) break;
    used += static_cast<std::size_t>(count);
    if (used == content.size()) content.resize(2 * used);
  }
  content.resize(used);
  return content;
}

void write_files(const std::vector<FileContent>& files) {
  StagedFiles staged;
  for (const FileContent& file : files) {
    staged.begin(file.path);
    staged.write(file.content);
  }
  staged.commit();
}

void check_writable(const std::string& path) { StagedFiles().begin(path); }  // made and discarded

void write_file(const std::string& path, const std::string& content) { write_files({{path, content}}); }

void remove_file(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::none) fail_by_code(path, "be examined", error);
  if (!fs::is_regular_file(status)) return;
  fs::remove(path, error);  // one that is gone meanwhile is no error
  if (error) fail_by_code(path, "be removed", error);
}

void remove_leftovers(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> leftovers;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (is_temporary(entry->path())) leftovers.push_back(entry->path());
  if (error) fail_by_code(folder, "be read as a folder", error);
  for (const std::string& path : leftovers) remove_file(path);
}

void make_folder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (!error && !fs::is_directory(path, error) && !error) error = std::make_error_code(std::errc::not_a_directory);
  if (error) fail_by_code(path, "be created as a folder", error);
}

}  // namespace corral
