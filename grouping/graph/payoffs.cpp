// SPDX-License-Identifier: MIT
#include "grouping/graph/payoffs.h"

#include <algorithm>

#include "grouping/columns/compatibility.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "grouping/graph/payoffs.cpp"
#include <hwy/foreach_target.h>

#include "kernel/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

HWY_INLINE Lanes lengths(const Points& points, int row, int j) {
  const Lanes x = Lanes::fill(points(row, 0)) - Lanes::load(points.col(0).data() + j),
              y = Lanes::fill(points(row, 1)) - Lanes::load(points.col(1).data() + j),
              z = Lanes::fill(points(row, 2)) - Lanes::load(points.col(2).data() + j);
  return square_root(x * x + y * y + z * z);
}

/// Whole lanes of one row, from a column on; returns the first column that is left.
HWY_FLATTEN int fill_row(const CorrespondenceSet& matches, int row, int j, double* entries) {
  for (; j + kLanes <= matches.size(); j += kLanes, entries += kLanes) {
    const Lanes source = lengths(matches.source_points, row, j), target = lengths(matches.target_points, row, j);
    const Lanes smaller_one = smaller(source, target), larger_one = larger(source, target);
    select(Lanes::fill(0) < smaller_one, smaller_one / larger_one, Lanes::fill(0)).store(entries);
  }
  return j;
}

/// Each entry is used twice: it adds the share of its column to its row, and that of its row to its column.
HWY_FLATTEN void multiply(const Payoffs& payoffs, const double* shares, double* gains, int padded_rows) {
  for (int row = 0; row < payoffs.size(); ++row) {
    const double* entries = payoffs.from(row);
    const Lanes share = Lanes::fill(shares[row]);
    Lanes gain = Lanes::fill(0);
    for (int j = Payoffs::first(row); j < padded_rows; j += kLanes, entries += kLanes) {
      const Lanes payoff = Lanes::load(entries);
      gain = gain + payoff * Lanes::load(shares + j);
      (Lanes::load(gains + j) + payoff * share).store(gains + j);
    }
    gains[row] += sum(gain);
  }
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(fill_row);
HWY_EXPORT(multiply);

Payoffs::Payoffs(const CorrespondenceSet& matches, bool distinct) : rows_(matches.size()) {
  std::size_t count = 0;
  for (int row = 0; row < rows_; ++row) {
    starts_.push_back(count);
    count += static_cast<std::size_t>(padded(rows_) - first(row));
  }
  entries_.assign(count, 0);
  for (int row = 0; row < rows_; ++row) {
    double* entries = &entries_[starts_[static_cast<std::size_t>(row)]] - first(row);
    const int left = HWY_DYNAMIC_DISPATCH(fill_row)(matches, row, first(row), entries + first(row));
    for (int j = left; j < rows_; ++j) {
      const PairDistances lengths = pair_distances(matches, row, j);
      entries[j] = rigidity_ratio(lengths.source, lengths.target);
    }
    for (int j = first(row); j <= row; ++j) entries[j] = 0;
    if (!distinct) continue;
    for (int j = row + 1; j < rows_; ++j)
      if (matches.source_points.row(row) == matches.source_points.row(j) ||
          matches.target_points.row(row) == matches.target_points.row(j))
        entries[j] = 0;
  }
}

void Payoffs::multiply(const AlignedColumn& shares, AlignedColumn& gains) const {
  std::fill(gains.begin(), gains.end(), 0);
  HWY_DYNAMIC_DISPATCH(multiply)(*this, shares.data(), gains.data(), padded(rows_));
}

}  // namespace corral
#endif
