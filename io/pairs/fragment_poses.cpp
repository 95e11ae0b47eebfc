// SPDX-License-Identifier: MIT
#include "io/pairs/fragment_poses.h"

#include <map>

#include "io/disk/file.h"
#include "io/pose/pose_entry.h"
#include "io/text/line_reader.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

constexpr std::int64_t kMost = 1000000;

std::map<std::pair<int, int>, double> read_info(const std::string& path) {
  const std::string content = read_file(path);
  LineReader reader(path, content);
  reader.allow_open_end();
  std::map<std::pair<int, int>, double> overlaps;
  while (reader.next()) {
    const auto head = reader.fields();
    if (head.size() != 3)
      reader.fail("found " + quoted(reader.line()) + ", expected 'i j n', two fragments and a number");
    const int target = static_cast<int>(reader.integer(head[0], 0, kMost, "a fragment"));
    const int source = static_cast<int>(reader.integer(head[1], 0, kMost, "a fragment"));
    for (int row = 0; row < 6; ++row) {
      reader.need("six lines of six numbers");
      if (reader.fields().size() != 6) reader.fail("found " + quoted(reader.line()) + ", expected six numbers");
      if (row == 0) overlaps[{source, target}] = reader.finite_number(reader.fields()[0]);
    }
  }
  return overlaps;
}

}  // namespace

std::vector<FragmentPair> read_fragment_pairs(const std::string& log, const std::string& info) {
  const auto overlaps = info.empty() ? std::map<std::pair<int, int>, double>() : read_info(info);
  std::vector<FragmentPair> pairs;
  std::map<std::pair<int, int>, bool> seen;
  for (const PoseEntry& entry : parse_poses(log, read_file(log))) {
    const auto source = parse_int(entry.source), target = parse_int(entry.target);
    if (!source || !target || *source < 0 || *target < 0 || *source > kMost || *target > kMost)
      throw IoError(log, entry.place, "the pose is not between two numbered fragments, expected 'i j n' above it");
    FragmentPair pair{static_cast<int>(*source), static_cast<int>(*target), std::nullopt};
    if (seen[{pair.source, pair.target}])
      throw IoError(log, entry.place,
                    "the pair " + std::to_string(pair.target) + " " + std::to_string(pair.source) +
                        " is there twice, expected once");
    seen[{pair.source, pair.target}] = true;
    const auto overlap = overlaps.find({pair.source, pair.target});
    if (overlap != overlaps.end()) pair.overlap_points = overlap->second;
    pairs.push_back(pair);
  }
  return pairs;
}

}  // namespace corral
