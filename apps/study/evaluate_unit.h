// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/results/study_record.h"
#include "apps/study/content_store.h"
#include "apps/study/work_list.h"
#include "io/file.h"

namespace corral {

/// How one call of a grouper ended, or what all right matches (the oracle) or all matches (the floor) lead to.
struct TaskResult {
  MethodStatus status;
  std::optional<int> selected;  ///< absent if there is no answer
  std::vector<int> correct;     ///< at each threshold; empty without a truth
  PoseScores initial, refined, dense;
  std::optional<double> time_ms;
};

/// The answer of a unit.
struct UnitResult {
  std::string failure;  ///< why the pair could not be matched; then nothing else is filled
  double resolution = 0;
  int source_points = 0, source_keypoints = 0;  ///< vertices of the source, and those that were keypoints
  int matches = 0;
  bool has_truth = false;
  std::vector<int> true_matches;                   ///< at each threshold
  std::vector<std::optional<double>> frame_share;  ///< at each threshold
  std::vector<TaskResult> tasks;                   ///< one each
  std::vector<TaskResult> oracles;                 ///< one for each threshold
  std::optional<TaskResult> floor;
};

/// Hashes of files by their paths; empty where a file cannot be read.
using InputHashes = std::map<std::string, std::string>;
std::string hash_of(const InputHashes& inputs, const std::string& path);

/// What the answer of a unit depends on, as the name of its file.
std::string unit_key(const WorkUnit& unit, const InputHashes& inputs);

/// A unit with what it is worked on with.
struct UnitWork {
  const WorkUnit& unit;
  const InputHashes& inputs;
  const ContentStore& store;
};

/// The table of a unit, from the store or made and stored. Throws IoError or InvalidInput.
StoredMatches unit_matches(const UnitWork& work, const Mesh& source, const Mesh& target);

/// Matches, groups, scores and refines. Whatever fails is in the result, but for want of memory (std::bad_alloc). `files`: gets the files of selections and poses.
UnitResult evaluate_unit(const UnitWork& work, std::vector<FileContent>& files);

/// As text, and back; what is no such text is absent.
std::string unit_result_text(const UnitResult& result);
std::optional<UnitResult> parse_unit_result(const std::string& text);

}  // namespace corral
