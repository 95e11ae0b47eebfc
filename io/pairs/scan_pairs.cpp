// SPDX-License-Identifier: MIT
#include "io/pairs/scan_pairs.h"

#include <fstream>
#include <set>
#include <tuple>

#include "io/disk/file.h"
#include "io/pose/pose_entry.h"
#include "io/text/line_reader.h"

namespace corral {
namespace {

constexpr std::size_t kNames = 4, kMatrix = 16;
constexpr std::int64_t kMost = 1000000;

}  // namespace

bool is_scan_list(const std::string& path) {
  std::ifstream file(path);
  for (const char* name : {"seq", "i", "seq_db", "j"}) {
    std::string word;
    if (!(file >> word) || word != name) return false;
  }
  return true;
}

std::vector<ScanPair> read_scan_list(const std::string& path) {
  const std::string content = read_file(path);
  LineReader reader(path, content);
  reader.need("seq i seq_db j .., the names of the columns");
  std::vector<ScanPair> pairs;
  std::set<std::tuple<int, int, int, int>> seen;
  while (reader.next()) {
    const auto fields = reader.fields();
    if (fields.size() != kNames + kMatrix && fields.size() != kNames + kMatrix + 1)
      reader.fail("found " + std::to_string(fields.size()) +
                  " fields, expected seq i seq_db j, 16 numbers of a pose, and perhaps the overlap");
    int ids[kNames];
    for (std::size_t k = 0; k < kNames; ++k)
      ids[k] = static_cast<int>(reader.integer(fields[k], 0, kMost, k % 2 == 0 ? "a sequence" : "a scan"));
    if (!seen.insert({ids[0], ids[1], ids[2], ids[3]}).second) reader.fail("the pair is there twice, expected once");
    PoseEntry entry;
    entry.place = "line " + std::to_string(reader.line_number());
    for (std::size_t k = 0; k < kMatrix; ++k) entry.numbers.push_back(reader.finite_number(fields[kNames + k]));
    ScanPair pair{ids[0], ids[1], ids[2], ids[3], rigid_pose(path, entry), std::nullopt};
    if (fields.size() > kNames + kMatrix) pair.overlap = reader.finite_number(fields.back());
    pairs.push_back(std::move(pair));
  }
  if (pairs.empty()) reader.fail_at_end("a pair of scans");
  return pairs;
}

}  // namespace corral
