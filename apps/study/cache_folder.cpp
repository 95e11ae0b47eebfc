// SPDX-License-Identifier: MIT
#include "apps/study/cache_folder.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <tuple>
#include <vector>

#include "io/disk/file.h"
#include "io/disk/staged_files.h"
#include "kernel/error.h"

namespace corral {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kKeySize = 32;

struct Entry {
  fs::file_time_type used;
  std::string name;
  std::uint64_t bytes = 0;
  bool operator<(const Entry& other) const { return std::tie(used, name) < std::tie(other.used, other.name); }
};

struct Listing {
  std::vector<Entry> whole, unfinished;
};

bool is_key(const std::string& text) {
  return text.size() == kKeySize && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

/// The files of a cache, and those on the way to become one. What vanishes meanwhile is left out. Absent if the folder cannot be
/// read.
std::optional<Listing> list(const std::string& folder) {
  Listing listing;
  std::error_code error;
  for (fs::directory_iterator file(folder, error), end; !error && file != end; file.increment(error)) {
    const std::string name = file->path().filename().string();
    const bool is_whole = is_key(name);
    if (!is_whole && !(is_key(name.substr(0, kKeySize)) && is_temporary(name))) continue;
    struct stat status;
    if (::lstat(file->path().c_str(), &status) != 0 || !S_ISREG(status.st_mode)) continue;
    std::error_code gone;
    const fs::file_time_type used = fs::last_write_time(file->path(), gone);
    if (!gone)
      (is_whole ? listing.whole : listing.unfinished)
          .push_back({used, name, static_cast<std::uint64_t>(status.st_size)});
  }
  return error ? std::nullopt : std::optional<Listing>(std::move(listing));
}

/// Whether a file is deleted, by whomever.
bool is_deleted(const std::string& path) {
  std::error_code error;
  fs::remove(path, error);
  return !error;
}

/// Deletes unfinished files a day older than the last change of a name in the folder: no clock but that of the file system is
/// asked, which all machines share, and a file that somebody is writing is not as old.
void remove_abandoned(const std::string& folder, const std::vector<Entry>& unfinished) {
  std::error_code error;
  const fs::file_time_type now = fs::last_write_time(folder, error);
  for (const Entry& entry : unfinished)
    if (!error && now - entry.used > std::chrono::hours(24)) is_deleted(folder + "/" + entry.name);
}

}  // namespace

CacheFolder::CacheFolder(std::string folder, std::uint64_t limit_bytes)
    : folder_(std::move(folder)), limit_(limit_bytes) {
  make_folder(folder_);
  if (const auto found = list(folder_)) remove_abandoned(folder_, found->unfinished);
}

std::optional<std::string> CacheFolder::load(const std::string& key) const {
  try {
    std::string content = read_file(path(key));
    ::utimensat(AT_FDCWD, path(key).c_str(), nullptr, 0);  // in a folder that is only read nobody evicts
    return content;
  } catch (const IoError&) {
    return std::nullopt;
  }
}

void CacheFolder::save(const std::string& key, const std::string& content) const {
  if (!reserve(content.size())) return;
  try {
    write_file(path(key), content);
  } catch (const IoError&) {  // a full disk: whoever made the content has it all the same
  }
  release(content.size());
}

bool CacheFolder::reserve(std::uint64_t bytes) const {
  if (limit_ == 0) return true;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (has_given_up_ || bytes > limit_ || (bytes > room_ && !make_room(bytes))) return false;
  room_ -= bytes;
  in_flight_ += bytes;
  return true;
}

void CacheFolder::release(std::uint64_t bytes) const {
  if (limit_ == 0) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  in_flight_ -= bytes;
}

bool CacheFolder::make_room(std::uint64_t bytes) const {
  // An eighth is freed at once, and no more than that is believed to be free: others write too.
  const std::uint64_t wanted = std::max(bytes, limit_ / 8);
  std::optional<Listing> found = list(folder_);
  has_given_up_ = !found;
  if (!found) return false;
  std::uint64_t used = in_flight_;  // counted twice where it has begun: rather too much than too little
  for (const Entry& entry : found->whole) used += entry.bytes;
  for (const Entry& entry : found->unfinished) used += entry.bytes;
  std::sort(found->whole.begin(), found->whole.end());
  for (const Entry& entry : found->whole) {
    if (used <= limit_ - wanted) break;
    if (is_deleted(path(entry.name)))
      used -= entry.bytes;
    else
      has_given_up_ = true;
  }
  if (used > limit_ - wanted) return false;
  has_given_up_ = false;
  room_ = wanted;
  return true;
}

}  // namespace corral
