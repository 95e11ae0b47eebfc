// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/results/study_record.h"
#include "kernel/rigid_transform.h"
#include "kernel/types.h"

namespace corral {

/// A step of the swept attribute: one value, or an interval.
struct StudyLevel {
  std::string label;         ///< as written in the experiment file, such as "0.05" or "[65,70)"
  double low = 0, high = 0;  ///< equal for a single value
  double middle() const { return (low + high) / 2; }
};

/// An experiment in the manifest of a study.
struct ExperimentInfo {
  std::string name;    ///< such as "noise"
  std::string title;   ///< a few words for people
  std::string figure;  ///< panel of the paper, such as "a"; empty if it has none
  std::string dataset;
  std::string attribute;                      ///< swept: a column of pairs.csv, threshold_pr, matches, or method.option
  std::string axis;                           ///< label and unit of an axis, such as "noise (pr)"
  std::vector<StudyLevel> levels;             ///< in order
  std::vector<std::string> methods;           ///< in order, the bounds left out
  std::map<std::string, std::string> titles;  ///< of methods of other programs, for people
  double threshold_pr = 4;
  int least_true_matches = 1;  ///< pairs with fewer are excluded for all methods
};

/// The surfaces of a pair of a study.
struct StudyPair {
  std::string source, target, truth;                             ///< files; the surfaces or the truth may be empty
  double resolution = 0;                                         ///< mesh units per pr that the pair was judged with
  std::optional<int> source_points = {}, source_keypoints = {};  ///< of the source's surface, where the run says it

  bool has_surfaces() const { return !source.empty(); }
};

/// A folder that `corral evaluate` made: manifest.json, records.csv, summary.csv, selections/.
struct StudyFolder {
  std::string folder;
  std::vector<ExperimentInfo> experiments;
  std::map<std::string, StudyPair> pairs;  ///< by "dataset/pair"
  std::vector<StudyRecord> records;        ///< in the order of the work list
};

/// Reads manifest.json and records.csv. Throws IoError naming file and place.
StudyFolder read_study(const std::string& folder);

/// The matches and selections of a pair. A file of selections: source_keypoint,target_keypoint (empty where matches are no
/// vertices), residual_pr (empty without a truth), then one column of 0 and 1 for each grouper.
struct PairSelections {
  Indices source_keypoints, target_keypoints;  ///< vertices of the two meshes, one per match; or empty
  std::vector<double> residual_pr;             ///< |T p - p'| of each match under the true pose, or empty
  std::map<std::string, Indices> selected;     ///< by method, ascending rows
  std::size_t matches = 0;                     ///< how many, where neither keypoints nor residuals say so
};
PairSelections read_selections(const std::string& path);
/// Columns of the methods in the order given.
std::string selections_text(const PairSelections& selections, const std::vector<std::string>& methods);

/// The poses of the groupers on a pair: `<selections without .csv>.poses.csv`, lines method,stage (initial, refined,
/// all rows, dense), then the twelve numbers of [R | t] row by row.
struct StudyPose {
  std::string method, stage;
  RigidTransform target_from_source;
};
std::vector<StudyPose> read_poses(const std::string& path);
std::string poses_text(const std::vector<StudyPose>& poses);

}  // namespace corral
