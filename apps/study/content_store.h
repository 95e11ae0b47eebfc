// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kernel/correspondence_set.h"
#include "kernel/surface/descriptors.h"

namespace corral {

/// 32 hexadecimal digits: a 128-bit hash of the content, not cryptographic.
std::string content_hash(const std::string& content);

/// The matches of a pair, and the number of keypoints on either side.
struct StoredMatches {
  CorrespondenceSet matches;
  int source_keypoints = 0;
};

/// Intermediate results by the hash of everything they depend on. A result that is missing, damaged or could not be written
/// is absent, and is computed again.
class ContentStore {
 public:
  explicit ContentStore(std::string folder);  ///< throws IoError if it cannot be created

  std::optional<Descriptors> descriptors(const std::string& key) const;
  std::optional<StoredMatches> matches(const std::string& key) const;
  void put(const std::string& key, const Descriptors& descriptors) const;
  void put(const std::string& key, const StoredMatches& stored) const;

 private:
  std::optional<std::string> load(const std::string& key) const;
  void save(const std::string& key, const std::string& content) const;
  std::string folder_;
};

}  // namespace corral
