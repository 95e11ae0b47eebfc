// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "apps/reproduce/reading_tables.h"

namespace corral {

/// The options that a grouper has beside those of the experiment, under each choice among the points that name it; the text's
/// first.
std::vector<OptionOverrides> grouper_variants(const std::vector<OpenPoint>& points, const std::string& grouper);

/// An experiment whose pairs are matched in one way.
struct MatchedExperiment {
  ExperimentTable table;                         ///< with the groupers' options of the text
  std::vector<RowNumbers> agreement, keypoints;  ///< as in ClaimTable
  /// By grouper and options: its columns at each level.
  std::map<std::pair<std::string, OptionOverrides>, std::vector<MethodColumns>> variants;
};

/// What is to be run: experiments on one data set, under the matching part of a combination.
struct MatchedSet {
  const std::vector<OpenPoint>& points;
  const ClaimBook& book;
  const ReproduceSettings& settings;
  Combination matching;
  std::vector<std::string> experiments;
  std::string name;  ///< of the study folder
};

/// Runs the groupers with all of their variants, or takes what an earlier call has done. By experiment and
/// least_true_matches. Throws IoError, InvalidInput.
std::map<std::pair<std::string, int>, MatchedExperiment> run_matched_set(const MatchedSet& set,
                                                                         const StudyObserver& observer);

}  // namespace corral
