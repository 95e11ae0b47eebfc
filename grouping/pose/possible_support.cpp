// SPDX-License-Identifier: MIT
#include "grouping/pose/possible_support.h"

#include <algorithm>
#include <numeric>

#include "grouping/columns/filter_loops.h"

namespace corral {
namespace {

constexpr std::ptrdiff_t kNearlyMissed = 64;  ///< rows that are looked at after those which the best pose misses

/// Times the unit: what a difference of distances may be above 2 tau.
double slack(const FilterTable& table, double smallest_area) {
  const double far = table.source_origin().lpNorm<1>() + table.target_origin().lpNorm<1>();
  return 0x1p-45 * (far / table.unit() + 4) + 0x1p-44 * table.unit() * (table.unit() / smallest_area);
}

}  // namespace

PossibleSupport::PossibleSupport(const CorrespondenceSet& matches, double tolerance, double smallest_area)
    : table_(matches),
      left_(table_),
      tolerance_(2 * tolerance + slack(table_, smallest_area) * table_.unit()),
      is_exact_(table_.unit() > 0x1p-200 && table_.unit() < 0x1p200 && !table_.is_blind()) {}

void PossibleSupport::exceed(int count, const std::vector<double>& residuals) {
  if (!is_exact_ || count >= left_.rows()) return;
  if (partners_.empty()) {
    const ConsistencyFilter filter(table_, tolerance_);
    partners_.resize(static_cast<std::size_t>(filter.padded_rows()));
    count_consistent(filter, partners_.data());
    rows_.resize(static_cast<std::size_t>(table_.rows()));
    std::iota(rows_.begin(), rows_.end(), 0);
  }
  rows_.erase(std::remove_if(rows_.begin(), rows_.end(),
                             [&](int row) { return partners_[static_cast<std::size_t>(row)] <= count; }),
              rows_.end());
  const auto missed_first = static_cast<std::ptrdiff_t>(rows_.size()) - count + kNearlyMissed;
  if (missed_first < static_cast<std::ptrdiff_t>(rows_.size()))
    std::nth_element(rows_.begin(), rows_.begin() + missed_first, rows_.end(), [&](int a, int b) {
      return residuals[static_cast<std::size_t>(a)] > residuals[static_cast<std::size_t>(b)];
    });
  left_ = table_.subset(rows_);
}

}  // namespace corral
