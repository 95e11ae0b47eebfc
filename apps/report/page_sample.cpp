// SPDX-License-Identifier: MIT
#include "apps/report/page_sample.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "apps/results/measures.h"
#include "kernel/random.h"

namespace corral {
namespace {

/// The records of a pair at a level, which follow one another.
struct Block {
  std::size_t run, first, end;
  std::uint64_t draw;  // random, of its names

  bool operator<(const Block& other) const {
    return std::tie(draw, run, first) < std::tie(other.draw, other.run, other.first);
  }
};

/// Those of a level: pairs that failed or whose truth does not fit, and the others.
struct LevelBlocks {
  std::vector<Block> odd, sound;
};

/// All blocks, those of scenes apart.
struct Blocks {
  std::vector<Block> scenes;
  std::vector<LevelBlocks> levels;
};

bool is_odd(const StudyRecord& record) {
  return record.status.state == MethodState::Failed || role_of(record, 1) == PairRole::Misfit;
}

Block block_at(const StudyFolder& run, std::size_t number, std::size_t first) {
  const StudyRecord& record = run.records[first];
  const auto is_other = [&](const StudyRecord& other) {
    return other.pair != record.pair || other.level != record.level || other.experiment != record.experiment;
  };
  const auto begin = run.records.begin() + static_cast<std::ptrdiff_t>(first);
  const auto end = std::find_if(begin, run.records.end(), is_other);
  constexpr std::uint64_t kSeed = 1;
  return {number, first, static_cast<std::size_t>(end - run.records.begin()),
          derive_seed(derive_seed(derive_seed(kSeed, record.experiment), record.level), record.pair)};
}

Blocks blocks_of(const std::vector<StudyFolder>& runs, const std::vector<SceneChoice>& scenes) {
  std::set<std::pair<std::size_t, std::string>> wanted;
  for (const SceneChoice& scene : scenes) wanted.emplace(static_cast<std::size_t>(scene.run), scene.selection);
  Blocks blocks;
  std::map<std::tuple<std::size_t, std::string, std::string>, LevelBlocks> levels;
  for (std::size_t run = 0; run < runs.size(); ++run)
    for (std::size_t at = 0; at < runs[run].records.size();) {
      const Block block = block_at(runs[run], run, at);
      const auto first = runs[run].records.begin() + static_cast<std::ptrdiff_t>(block.first);
      const auto end = runs[run].records.begin() + static_cast<std::ptrdiff_t>(block.end);
      at = block.end;
      if (wanted.erase({run, first->selection}) > 0) {
        blocks.scenes.push_back(block);
        continue;
      }
      LevelBlocks& level = levels[{run, first->experiment, first->level}];
      (std::any_of(first, end, is_odd) ? level.odd : level.sound).push_back(block);
    }
  for (auto& [key, level] : levels) {
    std::sort(level.odd.begin(), level.odd.end());
    std::sort(level.sound.begin(), level.sound.end());
    blocks.levels.push_back(std::move(level));
  }
  return blocks;
}

/// In the order in which they are taken.
std::vector<Block> in_turn(const Blocks& blocks) {
  std::vector<Block> order = blocks.scenes;
  std::size_t longest = 0;
  for (const LevelBlocks& level : blocks.levels) longest = std::max({longest, level.odd.size(), level.sound.size()});
  for (std::size_t round = 0; round < longest; ++round)
    for (const LevelBlocks& level : blocks.levels)
      for (const std::vector<Block>* part : {&level.odd, &level.sound})
        if (round < part->size()) order.push_back((*part)[round]);
  return order;
}

}  // namespace

PageRecords sample_records(const std::vector<StudyFolder>& runs, const std::vector<SceneChoice>& scenes,
                           std::size_t most) {
  std::size_t all = 0;
  for (const StudyFolder& run : runs) all += run.records.size();
  std::vector<std::vector<char>> is_taken;
  for (const StudyFolder& run : runs) is_taken.emplace_back(run.records.size(), all > most ? 0 : 1);
  std::size_t taken = 0;
  if (all > most)
    for (const Block& block : in_turn(blocks_of(runs, scenes))) {
      taken += block.end - block.first;
      if (taken > most) break;
      std::fill(is_taken[block.run].begin() + static_cast<std::ptrdiff_t>(block.first),
                is_taken[block.run].begin() + static_cast<std::ptrdiff_t>(block.end), 1);
    }
  PageRecords records(runs.size());
  for (std::size_t run = 0; run < runs.size(); ++run)
    for (std::size_t at = 0; at < is_taken[run].size(); ++at)
      if (is_taken[run][at] != 0) records[run].push_back(&runs[run].records[at]);
  return records;
}

}  // namespace corral
