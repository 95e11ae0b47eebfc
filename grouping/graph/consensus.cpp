// SPDX-License-Identifier: MIT
#include "grouping/graph/consensus.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "grouping/columns/column_loops.h"
#include "grouping/columns/compatibility.h"
#include "grouping/columns/filter_loops.h"
#include "grouping/graph/bit_graph.h"

namespace corral {
namespace {

constexpr int kReferences = 500;

int size_of(std::int64_t sum) { return static_cast<int>(std::ceil(std::sqrt(static_cast<double>(sum)))); }

}  // namespace

double Consensus::memory(int rows) {
  return BitGraph::memory(rows) + FilterTable::memory(rows) + ConsistencyFilter::memory(rows) + 100.0 * rows;
}

bool Consensus::agree(int i, int j) const {
  const PairDistances lengths = pair_distances(matches_, i, j);
  return std::abs(lengths.source - lengths.target) < tolerance_;
}

Indices Consensus::with(int row) const {
  std::vector<std::uint8_t> agrees(static_cast<std::size_t>(matches_.size()));
  compare_with_seed(matches_, row, tolerance_, agrees.data());
  return marked_rows(agrees);
}

Consensus::Size Consensus::measure(const Indices& rows, Indices& sums) const {
  const CorrespondenceSet set = select_rows(matches_, rows);
  const int count = set.size();
  sums.assign(rows.size(), 0);
  if (count <= sample_) {
    const BitGraph graph = consistency_graph(set, tolerance_);
    for (int i = 0; i < count; ++i) sums[static_cast<std::size_t>(i)] = graph.degree(i) + 1;
  } else {
    std::vector<std::uint8_t> agrees(rows.size());
    for (std::int64_t k = 0; k < kReferences; ++k) {
      compare_with_seed(set, static_cast<int>(k * count / kReferences), tolerance_, agrees.data());
      for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += agrees[i];
    }
    for (int& sum : sums) sum = static_cast<int>(static_cast<std::int64_t>(sum) * count / kReferences);
  }
  const std::int64_t total = std::accumulate(sums.begin(), sums.end(), std::int64_t{0});
  return {size_of(total), total};
}

bool Consensus::is_smaller(const Indices& rows, int size) const {
  if (rows.empty() || static_cast<int>(rows.size()) > sample_) return false;
  const ConsistencyFilter filter(FilterTable(select_rows(matches_, rows)), tolerance_);
  Indices possible(static_cast<std::size_t>(filter.padded_rows()));
  count_consistent(filter, possible.data());
  return size_of(std::accumulate(possible.begin(), possible.begin() + static_cast<std::ptrdiff_t>(rows.size()),
                                 std::int64_t{0})) < size;
}

}  // namespace corral
