// SPDX-License-Identifier: MIT
#include "apps/study/shard.h"

#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {

Shard parse_shard(const std::string& text) {
  const std::size_t bar = text.find('/');
  if (bar != std::string::npos) {
    const auto number = parse_int(text.substr(0, bar)), count = parse_int(text.substr(bar + 1));
    if (number && count && *count >= 1 && *count <= kMostShards && *number >= 1 && *number <= *count)
      return {static_cast<int>(*number), static_cast<int>(*count)};
  }
  throw InvalidInput("corral evaluate", "--shard", "'" + text + "'",
                     "I/N, such as 3/7, with 1 <= I <= N <= " + std::to_string(kMostShards));
}

std::string to_text(const Shard& shard) { return std::to_string(shard.number) + "/" + std::to_string(shard.count); }

std::string file_name(const Shard& shard) {
  return std::to_string(shard.number) + "-of-" + std::to_string(shard.count);
}

}  // namespace corral
