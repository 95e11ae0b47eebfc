// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/results/study_results.h"
#include "apps/results/success_share.h"

namespace corral {

/// The judged pairs of a data set over all experiments of some studies, each pair once.
struct SetTable {
  std::string dataset;
  std::vector<std::string> pairs;
  RowNumbers matches, correct_share;  ///< of each pair
  std::vector<std::string> methods;   ///< in the order of the experiments, then the oracle if it is there
  std::map<std::string, std::map<std::string, RowNumbers>> numbers;  ///< by method and measure; NaN where there is none
  std::map<std::string, double> median_ms;                           ///< by method

  const RowNumbers& column(const std::string& method, const std::string& measure) const {
    return numbers.at(method).at(measure);
  }
};

/// A table for each data set, in the order of the studies. A pair that several experiments or levels have is taken from the
/// experiment with the most methods, of these from the first, at its first level. Experiments of times are left out.
std::vector<SetTable> set_tables(const std::vector<StudyResults>& studies);

/// Of a method, over the pairs on which it was tried.
struct MethodShare : SuccessShare {
  std::string method;
  std::optional<double> median_ms;
};

/// Pairs with a like share of correct matches and number of matches.
struct ChoiceCell {
  int pairs = 0;
  std::vector<MethodShare> best;  ///< the best, then those not distinguishable from it: their interval holds its share
};

/// Bins of the number of matches, by their upper ends; the first begins at 0, the last has no end.
extern const std::vector<double> kMatchCounts;
std::string match_count_text(std::size_t bin);

/// Which method to use on a data set.
struct MethodChoice {
  std::string dataset;
  int pairs = 0;
  std::vector<MethodShare> methods;            ///< by success, the faster first among equals
  std::vector<bool> is_on_front;               ///< of each: no method that is as good is faster
  std::optional<MethodShare> perfect;          ///< all correct matches
  std::vector<std::vector<ChoiceCell>> cells;  ///< by share of correct matches and number of matches
};
MethodChoice choose_method(const SetTable& table);

}  // namespace corral
