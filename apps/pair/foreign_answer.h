// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/pair/evaluate_pair.h"

namespace corral {

/// What another program says of a pair: which matches it selected, its pose, or both, and how long it took.
struct ForeignAnswer {
  std::string labels;             ///< file, as read_selection takes it; empty: it states no selection
  std::string pose;               ///< FILE or FILE:KEY, as read_transform takes it; empty: it states no pose
  std::string times;              ///< CSV file with the columns pair and ms; empty: there is none
  std::optional<double> time_ms;  ///< of every pair, where there is no such file

  /// Those that are given.
  std::vector<std::string> files() const;
};

constexpr double kStatedPosePr = 5;  ///< most residual of a match that a pose without a selection stands for

/// The selection and the pose in these files; without labels the selection is every match that the pose brings within
/// kStatedPosePr. Throws IoError: a file that is not there ("no answer"), of another table, or not of this kind.
GroupingResult read_answer(const ForeignAnswer& answer, const CorrespondenceSet& matches);

/// Scores, refines and judges it as the answer of a grouper (judge). What cannot be read is the failure of this method alone.
MethodRecord evaluate_answer(const std::string& method, const ForeignAnswer& answer, const std::string& pair,
                             const CorrespondenceSet& matches, const std::optional<PairTruth>& truth);

}  // namespace corral
