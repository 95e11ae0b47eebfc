// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/pair/method_status.h"
#include "apps/results/optional_number.h"
#include "apps/results/shared_text.h"

namespace corral {

/// The errors of a pose; what could not be computed is absent.
struct PoseScores {
  OptionalNumber rotation_error_deg, translation_error_pr;
  OptionalNumber mean_error_pr;  ///< mean distance over the overlap, as in success curves
  OptionalNumber rmse_pr;        ///< root mean square of the same
  OptionalNumber add_share;      ///< mean distance of all source vertices, in diameters of the source
  OptionalNumber mssd_share;     ///< the largest of these distances
  OptionalNumber add_s_share;    ///< the mean with the distance to the nearest vertex
};

/// A row of records.csv: one grouper on one pair at one level of one experiment. "oracle" (all correct matches) and
/// "baseline" (all matches) are listed like groupers where the truth is known. Records share their texts: a study has millions.
struct StudyRecord {
  SharedText experiment, dataset, level, pair;
  SharedText scene;  ///< of the pair (scene_of); empty if it belongs to none
  SharedText method;
  int repeat = 0;        ///< from 0
  OptionalNumber value;  ///< of the swept attribute
  MethodStatus status;   ///< that of MethodRecord; Failed, with the cause, if the pair could not be matched
  SharedText truth;      ///< TruthFit::name: whether the truth can belong to the pair; empty without a truth
  std::optional<int> matches, true_matches, selected, correct;
  std::optional<int> keypoints_in_overlap;  ///< of the matched ones; absent for a table of matches
  OptionalNumber precision, recall, f1;     ///< of this pair; precision is absent where nothing was selected
  OptionalNumber frame_share;               ///< share of correct matches whose frames agree within 10 degrees
  OptionalNumber metres_per_pr;  ///< where the data set is in metres: for the criteria that the field states so
  PoseScores initial, refined, all_rows, dense;  ///< of the fit to the selection, the refined pose, and from there
                                                 ///< over all matches and over the whole surfaces
  OptionalNumber time_ms;                        ///< of the grouping alone
  OptionalNumber stated_time_ms;                 ///< of a method of another program, as that says
  OptionalNumber confidence;                     ///< probability that the refined pose registers the pair
  SharedText selection;                          ///< file of selections in the study folder; empty if there is none
};

/// The names of the columns, in order.
const std::vector<std::string>& record_columns();
std::string record_line(const StudyRecord& record);  ///< with its line break; reads back as the same record

/// Reads records.csv. Throws IoError naming file and line.
std::vector<StudyRecord> read_records(const std::string& path);

}  // namespace corral
