// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "apps/claims/claim_measure.h"
#include "apps/results/study_folder.h"

namespace corral {

/// An experiment with what claims look at beside its table, by level; empty unless a claim of the book does.
struct ClaimTable {
  const ExperimentTable* table = nullptr;
  std::vector<RowNumbers> agreement, keypoints;
};
/// Reads the files of selections that the table names, where a claim looks at their agreement.
ClaimTable claim_table(const ClaimBook& book, const StudyFolder& run, const ExperimentTable& table);

/// The experiments that claims are judged on, and how to draw from their pairs. The tables must outlive it.
struct ClaimStudy {
  ClaimData data;
  std::map<std::string, std::string> figures;  ///< panels of the paper, by experiment

  bool has(const std::string& experiment) const { return data.count(experiment) > 0; }
  void add(const ClaimTable& table);
  Draws all_rows() const;
  Draws resampled(int repeat) const;  ///< levels of the same pairs are drawn alike

 private:
  std::vector<std::size_t> sizes_;    // rows of each slot
  std::vector<std::uint64_t> seeds_;  // of each slot
};

}  // namespace corral
