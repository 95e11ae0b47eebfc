// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

namespace corral {

/// Files that can be made again, up to a size of all together. Their names are keys of 32 hexadecimal digits (content_hash);
/// whatever else lies in the folder stays. Any number of threads and processes may share a folder, without a lock: a file that
/// another process has deleted is absent, and one that is being written has a name of its own until it is whole.
///
/// Where there is no room, the files that were used longest ago are deleted; loading one counts as use (it sets the time of its
/// last change). Every process counts what it writes itself and lists the folder anew after an eighth of the limit, so that
/// beside p - 1 others the folder may grow beyond the limit by (p - 1) / 8 of it, for as long.
///
/// Apart from the constructor nothing throws IoError: a file that cannot be read is absent, and one that cannot be written is
/// not kept.
class CacheFolder {
 public:
  /// Creates the folder, and removes what calls that were killed left unfinished in it. No limit where it is 0. Throws IoError.
  CacheFolder(std::string folder, std::uint64_t limit_bytes);

  std::optional<std::string> load(const std::string& key) const;
  void save(const std::string& key, const std::string& content) const;

 private:
  bool reserve(std::uint64_t bytes) const;
  void release(std::uint64_t bytes) const;
  bool make_room(std::uint64_t bytes) const;
  std::string path(const std::string& key) const { return folder_ + "/" + key; }

  std::string folder_;
  std::uint64_t limit_;
  mutable std::mutex mutex_;
  mutable std::uint64_t room_ = 0;       ///< what may be written before the folder is listed again
  mutable std::uint64_t in_flight_ = 0;  ///< being written by threads of this process
  mutable bool has_given_up_ = false;    ///< after a folder that is full and cannot be emptied
};

}  // namespace corral
