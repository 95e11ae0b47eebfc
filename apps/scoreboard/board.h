// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/results/study_results.h"
#include "apps/results/success_share.h"

namespace corral {

/// A method on a board.
struct BoardRow {
  std::string method;
  bool is_submitted = false;  ///< its answers came in files
  int rank = 0;               ///< by success, from 1; equal shares have the same; 0: it applies to no table
  SuccessShare all;
  std::vector<std::optional<SuccessShare>>
      by_share;  ///< by the share of correct matches, one for each of kCorrectShares
  std::optional<double> precision, recall, f1, confidence;
  std::optional<double> median_ms;
  bool is_time_stated = false;  ///< by the method, not taken by Corral
};

/// All methods on the pairs of one experiment on one data set.
struct Board {
  std::string experiment, dataset, title;
  int tables = 0;
  std::vector<BoardRow> rows;  ///< the oracle, then by rank and name, then those that apply to no table

  const BoardRow* row_of(const std::string& method) const;
};

/// A board for every experiment on every data set; studies of the same one share a board. Pairs are those that are judged; an oracle
/// of all correct matches is a row too.
/// Throws    IoError: studies of one board that judge other pairs, or two with one method.
std::vector<Board> make_boards(const std::vector<StudyResults>& studies);

}  // namespace corral
