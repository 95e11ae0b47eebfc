// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "apps/pair/explain.h"
#include "apps/results/study_folder.h"

namespace corral {

/// Where a pair ended on the way to its pose.
enum class Stage {
  Registered,  ///< not lost: the refined pose registers it
  Keypoints,   ///< fewer than 20 matched keypoints lie in the overlap, and all correct matches do not register it
  Matches,     ///< all correct matches, a perfect selection, do not register it
  Grouping,    ///< they would, the selection of this grouper does not
  Pose,        ///< the refinement lost it: it diverged, did not converge, or left a good start
  Truth,       ///< the truth cannot belong to the pair
  Failed,      ///< the pair could not be matched, or the grouper gave no answer
};
constexpr std::size_t kStages = 7;

/// "registered", "keypoints", "matches", "grouping", "pose", "truth", "failed".
const char* to_text(Stage stage);
Stage stage_of(Cause cause);

/// How many pairs ended where, for one grouper at one level of an experiment.
struct LossRow {
  std::string experiment, dataset, level, method;
  int pairs = 0;  ///< with a truth, to which the grouper applies; excluded ones are among them
  std::array<double, kStages> ended =
      {};  ///< in the order of Stage, in pairs; repeats count as one pair in equal parts

  double of(Stage stage) const { return ended[static_cast<std::size_t>(stage)]; }
  double share(Stage stage) const { return pairs > 0 ? of(stage) / pairs : 0; }
};

/// Every pair of a study by the rules of explain_pair, from its records alone: each experiment, level and method (bounds behind
/// the groupers), in their order. The records of a pair at a level follow one another, as in records.csv.
///
/// Departs   Normals on opposite sides are no number of a record: such a pair is lost at its keypoints or matches. A pair whose
///           truth does not fit is lost whatever its poses. Without a number of keypoints (tables of matches) none is lost there.
std::vector<LossRow> losses_of(const StudyFolder& run);

/// The same of records that come in parts: the records of a pair at a level are in one.
class LossCounter {
 public:
  explicit LossCounter(const std::vector<ExperimentInfo>& experiments);
  void add(const std::vector<StudyRecord>& records);
  std::vector<LossRow> rows() const { return rows_; }

 private:
  using Records = std::vector<StudyRecord>::const_iterator;
  void add_pair(Records first, Records last);

  std::vector<LossRow> rows_;
  std::map<std::pair<std::string, std::string>, std::size_t> levels_;  ///< experiment, level: where its rows begin
};

/// The same over all levels of an experiment.
std::vector<LossRow> over_levels(const std::vector<LossRow>& rows);

/// As CSV: experiment,dataset,level,method,pairs, then the share of each stage; empty where there are no pairs.
std::string losses_text(const std::vector<LossRow>& rows);

}  // namespace corral
