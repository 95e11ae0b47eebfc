// SPDX-License-Identifier: MIT
#include "io/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <mutex>
#include <system_error>

#include "kernel/error.h"

namespace corral {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, const std::string& action) {
  throw IoError(path, "", "cannot " + action + " (" + std::strerror(errno) + ")");
}

/// A file descriptor that closes itself.
struct Descriptor {
  int value;
  ~Descriptor() {
    if (value >= 0) ::close(value);
  }
};

void write_all(int descriptor, const std::string& content, const std::string& path) {
  for (std::size_t done = 0; done < content.size();) {
    const ssize_t written = ::write(descriptor, content.data() + done, content.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path, "be written");
    done += static_cast<std::size_t>(written);
  }
}

/// The ending of the name of a temporary file; mkstemp replaces the last six letters.
constexpr char kTemporary[] = ".part-XXXXXX";

bool is_temporary(const fs::path& name) {
  const std::string ending = name.extension().string();
  return ending.size() == sizeof kTemporary - 1 && ending.rfind(".part-", 0) == 0;
}

/// Permissions of the existing file, else those that the umask gives a new one.
mode_t mode_for(const fs::path& place) {
  struct stat status;
  if (::stat(place.c_str(), &status) == 0) return status.st_mode & 07777;
  static std::mutex asking;  // between the two calls the umask is 0 for every thread
  const std::lock_guard<std::mutex> lock(asking);
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return 0666 & ~mask;
}

/// The end of a chain of links, whether it exists or not: a link stays a link, its target is replaced.
fs::path end_of_links(fs::path path) {
  std::error_code error;
  for (int step = 0; step < 40 && fs::is_symlink(fs::symlink_status(path, error)); ++step)
    path = path.parent_path() / fs::read_symlink(path, error);
  return path;
}

/// New content in a temporary file beside the file that it will replace.
class StagedFile {
 public:
  explicit StagedFile(const FileContent& file) : file_(file), place_(end_of_links(file.path)) {
    const fs::file_status status = fs::status(file.path, error_);
    if (fs::is_directory(status)) throw IoError(file.path, "", "is a directory, expected a file to write");
    is_device_ = fs::exists(status) && !fs::is_regular_file(status);
    if (is_device_) return;
    temporary_ = place_.string() + kTemporary;
    const Descriptor descriptor{::mkstemp(temporary_.data())};
    if (descriptor.value < 0) {
      temporary_.clear();
      fail(file.path, "be created");
    }
    try {
      write_all(descriptor.value, file.content, file.path);
      if (::fsync(descriptor.value) != 0) fail(file.path, "be written");  // whole after a power cut too
      if (::fchmod(descriptor.value, mode_for(place_)) != 0) fail(file.path, "be given its permissions");
    } catch (...) {
      discard();
      throw;
    }
  }
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;
  ~StagedFile() { discard(); }

  const std::string& path() const { return file_.path; }
  bool takes_the_place_of(const StagedFile& other) const {
    return !is_device_ && !other.is_device_ && fs::weakly_canonical(place_) == fs::weakly_canonical(other.place_);
  }

  void commit() {
    if (is_device_) {
      const Descriptor descriptor{::open(file_.path.c_str(), O_WRONLY | O_CLOEXEC)};
      if (descriptor.value < 0) fail(file_.path, "be opened for writing");
      return write_all(descriptor.value, file_.content, file_.path);
    }
    if (::rename(temporary_.c_str(), place_.c_str()) != 0) fail(file_.path, "be replaced");
    temporary_.clear();
  }

 private:
  void discard() {
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
  }

  const FileContent& file_;
  fs::path place_;
  std::string temporary_;
  bool is_device_ = false;
  std::error_code error_;
};

}  // namespace

std::string read_file(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) throw IoError(path, "", "does not exist");
  if (fs::is_directory(status)) throw IoError(path, "", "is a directory, expected a file");
  if (!error && !fs::is_regular_file(status) && !fs::is_fifo(status))
    throw IoError(path, "", "is a device, expected a file");
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  if (file.value < 0) fail(path, "be opened");
  // Room for one byte more than the file should have: reading then finds its end without more room. A pipe has no size.
  const std::uintmax_t size = status.type() == fs::file_type::regular ? fs::file_size(path, error) : 0;
  std::string content(error ? 4096 : std::max<std::uintmax_t>(size + 1, 4096), '\0');
  std::size_t used = 0;
  while (true) {
    const ssize_t count = ::read(file.value, content.data() + used, content.size() - used);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(path, "be read");
    if (count == 0) break;
    used += static_cast<std::size_t>(count);
    if (used == content.size()) content.resize(2 * used);
  }
  content.resize(used);
  return content;
}

void write_files(const std::vector<FileContent>& files) {
  std::vector<std::unique_ptr<StagedFile>> staged;
  for (const FileContent& file : files) staged.push_back(std::make_unique<StagedFile>(file));
  for (const auto& file : staged)
    for (const auto& other : staged)
      if (file != other && file->takes_the_place_of(*other))
        throw IoError(other->path(), "", "is named for two outputs, expected a name for each");
  for (const auto& file : staged) file->commit();
}

void check_writable(const std::string& path) {
  const FileContent nothing{path, ""};
  const StagedFile staged(nothing);  // made and discarded
}

void write_file(const std::string& path, const std::string& content) { write_files({{path, content}}); }

void remove_file(const std::string& path) {
  std::error_code error;
  if (fs::is_regular_file(path, error) && !fs::remove(path, error))
    throw IoError(path, "", "cannot be removed (" + error.message() + ")");
}

void remove_leftovers(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> leftovers;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->is_regular_file(error) && is_temporary(entry->path().filename())) leftovers.push_back(entry->path());
  if (error) throw IoError(folder, "", "cannot be read as a folder (" + error.message() + ")");
  for (const std::string& path : leftovers) remove_file(path);
}

void make_folder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error || !fs::is_directory(path))
    throw IoError(path, "", "cannot be created as a folder (" + error.message() + ")");
}

}  // namespace corral
