// SPDX-License-Identifier: MIT
#include "io/disk/staged_files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <optional>
#include <set>
#include <system_error>

#include "io/disk/file.h"
#include "io/disk/open_file.h"
#include "kernel/error.h"

namespace corral {
namespace {

namespace fs = std::filesystem;

/// The ending of the name of a temporary file; mkstemp replaces the last six letters.
constexpr char kTemporary[] = ".part-XXXXXX";

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

}  // namespace

/// New content in a temporary file beside the file that it will replace; of a device it is kept until then.
class StagedFiles::File {
 public:
  explicit File(std::string path) : path_(std::move(path)), place_(end_of_links(path_)) {
    std::error_code error;
    const fs::file_status status = fs::status(path_, error);
    if (status.type() == fs::file_type::none) fail_by_code(path_, "be examined", error);
    if (fs::is_directory(status)) throw IoError(path_, "", "is a directory, expected a file to write");
    if (fs::exists(status) && !fs::is_regular_file(status)) return;
    temporary_ = place_.string() + kTemporary;
    const int descriptor = ::mkostemp(temporary_.data(), O_CLOEXEC);
    if (descriptor < 0) {
      temporary_.clear();
      fail_by_errno(path_, "be created");
    }
    open_.emplace(descriptor, path_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() {
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
  }

  const std::string& path() const { return path_; }
  bool is_device() const { return place_key_.empty(); }  ///< once it is sealed
  /// The same for two names of one place.
  const std::string& place_key() const { return place_key_; }
  fs::path folder() const { return place_.has_parent_path() ? place_.parent_path() : "."; }

  void write(const std::string& content) {
    if (open_)
      open_->write(content);
    else
      of_device_ += content;
  }

  /// Puts the content on the disk.
  void seal() {
    if (!open_) return;
    if (::fchmod(open_->descriptor(), mode_for(place_, path_)) != 0) fail_by_errno(path_, "be given its permissions");
    open_->put_on_disk();
    open_->close();
    open_.reset();
    struct stat status;
    if (::stat(folder().c_str(), &status) != 0) fail_by_errno(path_, "be examined");
    place_key_ = std::to_string(status.st_dev) + " " + std::to_string(status.st_ino) + " " + place_.filename().string();
  }

  void replace() {
    if (is_device()) {
      OpenFile device(::open(path_.c_str(), O_WRONLY | O_CLOEXEC), path_);
      device.write(of_device_);
      return device.close();
    }
    if (::rename(temporary_.c_str(), place_.c_str()) != 0) fail_by_errno(path_, "be replaced");
    temporary_.clear();
  }

 private:
  const std::string path_;
  const fs::path place_;
  std::string temporary_, place_key_;
  std::optional<OpenFile> open_;
  std::string of_device_;
};

StagedFiles::StagedFiles() = default;
StagedFiles::~StagedFiles() = default;

void StagedFiles::seal() {
  if (!files_.empty()) files_.back()->seal();
}

void StagedFiles::begin(const std::string& path) {
  seal();
  files_.push_back(std::make_unique<File>(path));
}

void StagedFiles::write(const std::string& content) { files_.back()->write(content); }

void StagedFiles::commit() {
  seal();
  std::set<std::string> places;
  std::set<fs::path> folders;
  for (const auto& file : files_) {
    if (file->is_device()) continue;
    folders.insert(file->folder());
    if (!places.insert(file->place_key()).second)
      throw IoError(file->path(), "", "is named for two outputs, expected a name for each");
  }
  for (const auto& file : files_) file->replace();
  for (const fs::path& folder : folders) put_names_on_disk(folder.string());
}

void remove_leftovers_of(const std::string& path) {
  const fs::path place = path;
  const std::string beginning = place.filename().string() + ".";
  std::vector<std::string> leftovers;
  std::error_code error;
  for (fs::directory_iterator entry(place.has_parent_path() ? place.parent_path() : ".", error), end;
       !error && entry != end; entry.increment(error))
    if (entry->path().filename().string().rfind(beginning, 0) == 0 && is_temporary(entry->path()))
      leftovers.push_back(entry->path());
  if (error) fail_by_code(path, "be examined", error);
  for (const std::string& leftover : leftovers) remove_file(leftover);
}

bool is_temporary(const std::string& name) {
  const std::string ending = fs::path(name).extension().string();
  return ending.size() == sizeof kTemporary - 1 && ending.rfind(".part-", 0) == 0;
}

}  // namespace corral
