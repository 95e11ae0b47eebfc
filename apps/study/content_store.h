// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/study/cache_folder.h"
#include "kernel/correspondence_set.h"
#include "kernel/surface/descriptors.h"

namespace corral {

/// 32 hexadecimal digits: a 128-bit hash of the content, not cryptographic.
std::string content_hash(const std::string& content);

/// The same of a content that comes in pieces.
class ContentHasher {
 public:
  ContentHasher();
  ~ContentHasher();
  ContentHasher(const ContentHasher&) = delete;
  ContentHasher& operator=(const ContentHasher&) = delete;

  void add(const std::string& piece);
  std::string hash() const;  ///< of all pieces so far

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The matches of a pair, and the number of keypoints on either side.
struct StoredMatches {
  CorrespondenceSet matches;
  int source_keypoints = 0;
};

/// Intermediate results by the hash (content_hash) of everything they depend on. A result that is missing, damaged or could
/// not be written is absent, and is computed again.
class ContentStore {
 public:
  /// In a folder that may be shared (CacheFolder). Where a limit is given, all files together have no more bytes than that, and
  /// those that were used longest ago are deleted. Throws IoError if the folder cannot be created.
  explicit ContentStore(std::string folder, std::uint64_t limit_bytes = 0);

  std::optional<Descriptors> descriptors(const std::string& key) const;
  std::optional<StoredMatches> matches(const std::string& key) const;
  void put(const std::string& key, const Descriptors& descriptors) const;
  void put(const std::string& key, const StoredMatches& stored) const;

 private:
  std::optional<std::string> load(const std::string& key) const;
  void save(const std::string& key, const std::string& content) const;
  CacheFolder folder_;
};

}  // namespace corral
