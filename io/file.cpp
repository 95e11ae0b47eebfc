// SPDX-License-Identifier: MIT
#include "io/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <mutex>
#include <set>
#include <system_error>

#include "io/open_file.h"
#include "kernel/error.h"

namespace corral {
namespace {

namespace fs = std::filesystem;

/// The ending of the name of a temporary file; mkstemp replaces the last six letters.
constexpr char kTemporary[] = ".part-XXXXXX";

[[noreturn]] void fail_by_code(const std::string& path, const std::string& action, const std::error_code& error) {
  errno = error.value();
  fail_by_errno(path, action);
}

/// Permissions of the existing file, else those that the umask gives a new one.
mode_t mode_for(const fs::path& place, const std::string& path) {
  struct stat status;
  if (::stat(place.c_str(), &status) == 0) return status.st_mode & 07777;
  if (errno != ENOENT) fail_by_errno(path, "be examined");
  static std::mutex asking;  // between the two calls the umask is 0 for every thread
  const std::lock_guard<std::mutex> lock(asking);
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return 0666 & ~mask;
}

/// The end of a chain of links, whether it exists or not: a link stays a link, its target is replaced.
fs::path end_of_links(const std::string& name) {
  fs::path path = name;
  for (int step = 0; step < 40; ++step) {
    std::error_code error;
    const fs::file_status status = fs::symlink_status(path, error);
    if (status.type() == fs::file_type::none) fail_by_code(name, "be examined", error);
    if (!fs::is_symlink(status)) break;
    const fs::path next = fs::read_symlink(path, error);
    if (error) fail_by_code(name, "be examined", error);
    path = path.parent_path() / next;
  }
  return path;
}

/// New content in a temporary file beside the file that it will replace.
class StagedFile {
 public:
  explicit StagedFile(const FileContent& file) : file_(file), place_(end_of_links(file.path)) {
    std::error_code error;
    const fs::file_status status = fs::status(file.path, error);
    if (status.type() == fs::file_type::none) fail_by_code(file.path, "be examined", error);
    if (fs::is_directory(status)) throw IoError(file.path, "", "is a directory, expected a file to write");
    is_device_ = fs::exists(status) && !fs::is_regular_file(status);
    if (is_device_) return;
    temporary_ = place_.string() + kTemporary;
    const int descriptor = ::mkostemp(temporary_.data(), O_CLOEXEC);
    if (descriptor < 0) {
      temporary_.clear();
      fail_by_errno(file.path, "be created");
    }
    try {
      fill(OpenFile(descriptor, file.path));
    } catch (...) {
      discard();
      throw;
    }
  }
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;
  ~StagedFile() { discard(); }

  /// The same for two names of one place; empty for a device.
  const std::string& place_key() const { return place_key_; }
  fs::path folder() const { return place_.has_parent_path() ? place_.parent_path() : "."; }

  void commit() {
    if (is_device_) {
      OpenFile device(::open(file_.path.c_str(), O_WRONLY | O_CLOEXEC), file_.path);
      device.write(file_.content);
      return device.close();
    }
    if (::rename(temporary_.c_str(), place_.c_str()) != 0) fail_by_errno(file_.path, "be replaced");
    temporary_.clear();
  }

 private:
  void fill(OpenFile temporary) {
    temporary.write(file_.content);
    if (::fchmod(temporary.descriptor(), mode_for(place_, file_.path)) != 0)
      fail_by_errno(file_.path, "be given its permissions");
    temporary.put_on_disk();
    temporary.close();
    struct stat status;
    if (::stat(folder().c_str(), &status) != 0) fail_by_errno(file_.path, "be examined");
    place_key_ = std::to_string(status.st_dev) + " " + std::to_string(status.st_ino) + " " + place_.filename().string();
  }

  void discard() {
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
  }

  const FileContent& file_;
  fs::path place_;
  std::string temporary_, place_key_;
  bool is_device_ = false;
};

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
  std::string content(error ? 4096 : std::max<std::uintmax_t>(size + 1, 4096), '\0');
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
  std::vector<std::unique_ptr<StagedFile>> staged;
  std::set<std::string> places;
  std::set<fs::path> folders;
  for (const FileContent& file : files) {
    staged.push_back(std::make_unique<StagedFile>(file));
    const std::string place = staged.back()->place_key();
    if (place.empty()) continue;
    folders.insert(staged.back()->folder());
    if (!places.insert(place).second)
      throw IoError(file.path, "", "is named for two outputs, expected a name for each");
  }
  for (const auto& file : staged) file->commit();
  for (const fs::path& folder : folders) put_names_on_disk(folder.string());
}

void check_writable(const std::string& path) {
  const FileContent nothing{path, ""};
  const StagedFile staged(nothing);  // made and discarded
}

void write_file(const std::string& path, const std::string& content) { write_files({{path, content}}); }

void remove_file(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::none) fail_by_code(path, "be examined", error);
  if (!fs::is_regular_file(status)) return;
  fs::remove(path, error);  // one that is gone meanwhile is no error
  if (error) fail_by_code(path, "be removed", error);
}

bool is_temporary(const std::string& name) {
  const std::string ending = fs::path(name).extension().string();
  return ending.size() == sizeof kTemporary - 1 && ending.rfind(".part-", 0) == 0;
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
