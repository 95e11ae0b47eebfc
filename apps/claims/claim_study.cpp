// SPDX-License-Identifier: MIT
#include "apps/claims/claim_study.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>

#include "kernel/error.h"
#include "kernel/random.h"

namespace corral {
namespace {

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t kSeed = 1;

bool asks_for(const ClaimBook& book, const std::string& experiment, Quantity::Kind kind) {
  for (const Claim& claim : book.claims)
    for (const ClaimPart& part : claim.parts)
      if (part.of.kind == kind &&
          std::find(part.experiments.begin(), part.experiments.end(), experiment) != part.experiments.end())
        return true;
  return false;
}

/// Keypoints for 100,000 vertices of the source, at the first row of each source.
std::vector<RowNumbers> keypoint_densities(const StudyFolder& run, const ExperimentTable& table) {
  std::set<std::string> seen;
  std::vector<RowNumbers> columns;
  for (const LevelTable& level : table.levels) {
    RowNumbers& column = columns.emplace_back();
    for (const std::string& name : level.pairs) {
      const auto pair = run.pairs.find(table.info.dataset + "/" + name);
      const bool is_known = pair != run.pairs.end() && pair->second.source_points && pair->second.source_keypoints &&
                            *pair->second.source_points > 0 && seen.insert(pair->second.source).second;
      column.push_back(is_known ? 1e5 * *pair->second.source_keypoints / *pair->second.source_points : kAbsent);
    }
  }
  return columns;
}

}  // namespace

ClaimTable claim_table(const ClaimBook& book, const StudyFolder& run, const ExperimentTable& table) {
  ClaimTable made{&table, {}, {}};
  made.agreement.resize(table.levels.size());
  made.keypoints.resize(table.levels.size());
  const std::string& name = table.info.name;
  if (asks_for(book, name, Quantity::Kind::Agreement)) made.agreement = selection_agreement(run, table, book.methods);
  if (asks_for(book, name, Quantity::Kind::KeypointDensity)) made.keypoints = keypoint_densities(run, table);
  return made;
}

void ClaimStudy::add(const ClaimTable& table) {
  const ExperimentInfo& info = table.table->info;
  figures[info.name] = info.figure;
  std::vector<LevelSource>& sources = data[info.name];
  for (std::size_t i = 0; i < table.table->levels.size(); ++i) {
    const LevelTable& level = table.table->levels[i];
    sources.push_back({&level, sizes_.size(), table.agreement[i], table.keypoints[i]});
    std::uint64_t seed = kSeed;
    for (const std::string& pair : level.pairs) seed = derive_seed(seed, pair);
    sizes_.push_back(level.pairs.size());
    seeds_.push_back(seed);
  }
}

Draws ClaimStudy::all_rows() const {
  Draws draws;
  for (const std::size_t size : sizes_) {
    draws.emplace_back(size);
    std::iota(draws.back().begin(), draws.back().end(), 0);
  }
  return draws;
}

Draws ClaimStudy::resampled(int repeat) const {
  Draws draws;
  for (std::size_t slot = 0; slot < sizes_.size(); ++slot) {
    RandomStream stream(derive_seed(seeds_[slot] + static_cast<std::uint64_t>(repeat), "claims"));
    for (int& row : draws.emplace_back(sizes_[slot])) row = static_cast<int>(stream.below(sizes_[slot]));
  }
  return draws;
}

}  // namespace corral
