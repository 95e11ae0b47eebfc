// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/results/study_record.h"
#include "apps/runtime/json.h"
#include "apps/study/content_store.h"
#include "apps/study/work_list.h"
#include "io/disk/file.h"

namespace corral {

/// The result of one call of a grouper, or of all correct matches (the oracle) or all matches (the baseline).
struct TaskResult {
  MethodStatus status;
  std::optional<int> selected;  ///< absent if there is no answer
  std::vector<int> correct;     ///< at each threshold; empty without a truth
  std::vector<int>
      true_matches;  ///< at each threshold, under the truth by which `correct` counts; empty: those of the unit
  PoseScores initial, refined, all_rows, dense;
  std::optional<double> time_ms, stated_time_ms, confidence;
};

/// The result of a unit.
struct UnitResult {
  std::string failure;         ///< why the pair could not be matched; then nothing else is filled
  bool is_unreadable = false;  ///< the failure: a file was refused by the system, which may not last. Not kept
  double resolution = 0;
  int source_points = 0, source_keypoints = 0;  ///< vertices of the source, and those that were keypoints
  int matches = 0;
  std::optional<int> keypoints_in_overlap;  ///< of the matched ones, with a truth; absent for a table of matches
  bool has_truth = false;
  std::string truth, truth_text;                   ///< TruthFit::name and text; empty without a truth
  std::vector<std::string> warnings;               ///< of data that make results wrong
  std::vector<int> true_matches;                   ///< at each threshold
  std::vector<std::optional<double>> frame_share;  ///< at each threshold
  std::vector<TaskResult> tasks;                   ///< one each
  std::vector<TaskResult> oracles;                 ///< one for each threshold
  std::optional<TaskResult> baseline;
};

/// Hashes of files by their paths; empty where a file cannot be read.
using InputHashes = std::map<std::string, std::string>;
std::string hash_of(const InputHashes& inputs, const std::string& path);

/// A hash of what the result of a unit depends on besides its files.
std::string unit_key(const WorkUnit& unit);

/// A unit with the tools to evaluate it.
struct UnitWork {
  const WorkUnit& unit;
  const InputHashes& inputs;
  const ContentStore& store;
};

/// The table of a unit from the store, if it is there.
std::optional<StoredMatches> stored_unit_matches(const UnitWork& work);
/// The same, computed and stored where it is not. Throws IoError or InvalidInput.
StoredMatches unit_matches(const UnitWork& work, const Mesh& source, const Mesh& target);

/// Matches, groups, scores and refines. Failures are in the result, except for lack of memory (std::bad_alloc). `files`
/// receives the files of selections and poses.
UnitResult evaluate_unit(const UnitWork& work, std::vector<FileContent>& files);

/// To JSON and back. Throws Json::exception or InvalidInput for any other JSON.
Json to_json(const UnitResult& result);
UnitResult unit_result_of(const Json& json);

}  // namespace corral
