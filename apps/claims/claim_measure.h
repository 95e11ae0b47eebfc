// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include "apps/claims/averaging.h"
#include "apps/claims/claim_test.h"
#include "apps/results/level_table.h"

namespace corral {

/// Rows of every level, each as often as it was drawn, at LevelSource::slot.
using Draws = std::vector<std::vector<int>>;

/// A level as claims see it.
struct LevelSource {
  const LevelTable* table = nullptr;
  std::size_t slot = 0;
  RowNumbers agreement, keypoints;  ///< of Quantity::Agreement and KeypointDensity; empty unless a claim looks at them
};
using ClaimData = std::map<std::string, std::vector<LevelSource>>;  ///< by experiment

/// The numbers that a rule is about, bound to the data; book, part and data must outlive it.
class ClaimMeasure {
 public:
  using Numbers = std::vector<double>;

  ClaimMeasure(const ClaimBook& book, const ClaimPart& part, const ClaimData& data, const Averaging& averaging);

  const std::string& reason() const { return reason_; }  ///< why there are none; empty if there are
  Scale scale() const;
  std::vector<std::string> labels() const;  ///< of the levels, for rules about each level; else one without a name
  /// One number for each method, or a single one: for each level, or all in one.
  std::vector<Numbers> numbers(const Draws& draws) const;

 private:
  /// Columns whose sums are divided by each other; without the second ones it is the mean of the one first.
  struct Ratio {
    std::vector<const RowNumbers*> above, below;
  };
  struct Level {
    const LevelSource* source;
    std::vector<const RowNumbers*> columns;  // one for each method or for all; null if it is not there
    std::vector<std::vector<Ratio>> ratios;  // of each of them; their mean is its number at the level
    std::vector<int> partners;               // of Take::LeastStep: the pair's row in the next level, or -1
  };
  using Levels = std::vector<Level>;
  using Range = std::optional<std::pair<double, double>>;

  Levels bind(const ClaimData& data, const std::string& experiment);
  void bind_columns(Level& level) const;
  std::vector<Ratio> ratios_of(const LevelTable& table, const std::string& method) const;
  bool is_usable(const Level& level) const;
  void bind_partners();
  void require_levels();

  Numbers of_level(const Level& level, const Draws& draws) const;
  Numbers mean(const Levels& levels, const Draws& draws) const;
  static Levels within(const Levels& levels, const Range& range, bool from_the_end);
  Numbers of_ends(const Draws& draws) const;
  Numbers of_experiments(const Draws& draws) const;
  Numbers of_series(const Draws& draws) const;
  Numbers of_steps(const Draws& draws) const;
  Numbers of_cells(const Draws& draws) const;
  Numbers of_pairs(const Draws& draws) const;
  double of_numbers(const Numbers& numbers, const Numbers& values) const;

  const ClaimBook& book_;
  const ClaimPart& part_;
  Averaging averaging_;
  std::string reason_;
  std::vector<Levels> experiments_;  // as in the part
  std::vector<Levels> with_;
};

}  // namespace corral
