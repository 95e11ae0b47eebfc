// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace corral {

/// A part of a study: the units that plan_shards gives to it. A whole study is the one shard of one.
struct Shard {
  int number = 1, count = 1;  ///< 1 .. count

  bool is_whole() const { return count == 1; }
  bool operator==(const Shard& other) const { return number == other.number && count == other.count; }
  bool operator<(const Shard& other) const {
    return count != other.count ? count < other.count : number < other.number;
  }
};

constexpr int kMostShards = 100'000;

/// "3/7", as typed. Throws InvalidInput.
Shard parse_shard(const std::string& text);
std::string to_text(const Shard& shard);    ///< "3/7"
std::string file_name(const Shard& shard);  ///< "3-of-7"

}  // namespace corral
