// SPDX-License-Identifier: MIT
#include "grouping/graph/pair_matrix.h"

#include <algorithm>
#include <cmath>

#include "grouping/columns/compatibility.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "grouping/graph/pair_matrix.cpp"
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
template <class Entry>
HWY_INLINE int fill_row(const CorrespondenceSet& matches, int row, double* entries, const Entry& entry) {
  int j = PairMatrix::first(row);
  for (; j + kLanes <= matches.size(); j += kLanes)
    entry(lengths(matches.source_points, row, j), lengths(matches.target_points, row, j)).store(entries + j);
  return j;
}

HWY_FLATTEN int fill_ratios(const CorrespondenceSet& matches, int row, double* entries) {
  return fill_row(matches, row, entries, [](Lanes source, Lanes target) HWY_ATTR {
    const Lanes smaller_one = smaller(source, target), larger_one = larger(source, target);
    return select(Lanes::fill(0) < smaller_one, smaller_one / larger_one, Lanes::fill(0));
  });
}

HWY_FLATTEN int fill_differences(const CorrespondenceSet& matches, double largest, int row, double* entries) {
  const Lanes limit = Lanes::fill(largest), one = Lanes::fill(1), zero = Lanes::fill(0);
  return fill_row(matches, row, entries, [=](Lanes source, Lanes target) HWY_ATTR {
    const Lanes difference = magnitude(source - target), share = difference / limit;
    return select(difference < limit, one - share * share, zero);
  });
}

/// Each entry is used twice: it adds the value of its column to its row, and that of its row to its column.
HWY_FLATTEN void multiply(const PairMatrix& matrix, const double* values, double* sums, int padded_rows) {
  for (int row = 0; row < matrix.size(); ++row) {
    const double* entries = matrix.from(row);
    const Lanes value = Lanes::fill(values[row]);
    Lanes total = Lanes::fill(0);
    for (int j = PairMatrix::first(row); j < padded_rows; j += kLanes, entries += kLanes) {
      const Lanes entry = Lanes::load(entries);
      total = total + entry * Lanes::load(values + j);
      (Lanes::load(sums + j) + entry * value).store(sums + j);
    }
    sums[row] += sum(total);
  }
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(fill_ratios);
HWY_EXPORT(fill_differences);
HWY_EXPORT(multiply);

PairMatrix::PairMatrix(int rows) : rows_(rows) {
  std::size_t count = 0;
  for (int row = 0; row < rows; ++row) {
    starts_.push_back(count);
    count += static_cast<std::size_t>(padded(rows) - first(row));
  }
  entries_.assign(count, 0);
}

PairMatrix PairMatrix::of_ratios(const CorrespondenceSet& matches, bool distinct) {
  PairMatrix matrix(matches.size());
  for (int row = 0; row < matrix.rows_; ++row) {
    double* entries = matrix.row_from_zero(row);
    const int left = HWY_DYNAMIC_DISPATCH(fill_ratios)(matches, row, entries);
    for (int j = left; j < matrix.rows_; ++j) {
      const PairDistances lengths = pair_distances(matches, row, j);
      entries[j] = rigidity_ratio(lengths.source, lengths.target);
    }
    std::fill(entries + first(row), entries + row + 1, 0);
    if (!distinct) continue;
    for (int j = row + 1; j < matrix.rows_; ++j)
      if (matches.source_points.row(row) == matches.source_points.row(j) ||
          matches.target_points.row(row) == matches.target_points.row(j))
        entries[j] = 0;
  }
  return matrix;
}

PairMatrix PairMatrix::of_differences(const CorrespondenceSet& matches, double largest) {
  PairMatrix matrix(matches.size());
  for (int row = 0; row < matrix.rows_; ++row) {
    double* entries = matrix.row_from_zero(row);
    const int left = HWY_DYNAMIC_DISPATCH(fill_differences)(matches, largest, row, entries);
    for (int j = left; j < matrix.rows_; ++j) {
      const PairDistances lengths = pair_distances(matches, row, j);
      const double difference = std::abs(lengths.source - lengths.target), share = difference / largest;
      entries[j] = difference < largest ? 1 - share * share : 0;
    }
    std::fill(entries + first(row), entries + row + 1, 0);
  }
  return matrix;
}

void PairMatrix::multiply(const AlignedColumn& values, AlignedColumn& sums) const {
  std::fill(sums.begin(), sums.end(), 0);
  HWY_DYNAMIC_DISPATCH(multiply)(*this, values.data(), sums.data(), padded(rows_));
}

}  // namespace corral
#endif
