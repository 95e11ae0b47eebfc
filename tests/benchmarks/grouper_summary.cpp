// SPDX-License-Identifier: MIT
#include "tests/benchmarks/grouper_summary.h"

#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "grouping/registry.h"
#include "tests/benchmarks/multiply_add_peak.h"
#include "tests/benchmarks/plain_groupers.h"
#include "tests/support/reference_groupers.h"

namespace corral::benchmarks {
namespace {

/// The arithmetic that the definition asks for, whatever is really done for it; 0 where it is not what the time goes into.
///   RANSAC   27 for each of 10,000 poses and each match: 9 products and 9 sums move the point, 3 differences, 3 squares,
///            2 sums and a comparison judge it
///   GC       20 for each unordered pair: 6 differences, 6 squares and 4 sums on the two sides, the difference and the sum
///            of the squared lengths, 2 to judge them
double nominal_operations(const std::string& grouper, double matches) {
  if (grouper == "ransac") return 27 * 10000 * matches;
  if (grouper == "gc") return 20 * matches * (matches - 1) / 2;
  return 0;
}

/// The time of the innermost loops. Nobody can call them alone: it is the whole call's, which makes the rate a lower bound.
double kernel_ms(const GrouperTime& time) { return time.ms; }

/// Absent where there is no reference, or where it would take too long.
std::optional<Indices> reference_selection(const std::string& grouper, const CorrespondenceSet& matches) {
  const int count = matches.size();
  if (grouper == "ss") return reference::similarity_score(matches, {});
  if (grouper == "nnsr") return reference::nearest_neighbor_ratio(matches, {});
  if (grouper == "st" && count <= 500) return reference::spectral(matches, {});
  if (grouper == "gc" && count <= 500) return reference::geometric_consistency(matches, {});
  if (grouper == "gc") return plain::largest_star(matches, 3 * matches.resolution);
  if (grouper == "hough") return reference::hough_voting(matches, {});
  if (grouper == "si" && count <= 5000) return reference::search_of_inliers(matches, {});
  return std::nullopt;
}

double slope(const std::vector<std::pair<double, double>>& points) {
  double x_mean = 0, y_mean = 0, xx = 0, xy = 0;
  for (const auto& [x, y] : points)
    x_mean += x / static_cast<double>(points.size()), y_mean += y / static_cast<double>(points.size());
  for (const auto& [x, y] : points) xx += (x - x_mean) * (x - x_mean), xy += (x - x_mean) * (y - y_mean);
  return xy / xx;
}

}  // namespace

void print_rates(std::FILE* to, const std::vector<GrouperTime>& times) {
  const double peak = multiply_add_peak();
  std::fprintf(to, "\nmultiply-add peak of one core, single precision: %.1f GFLOP/s\n", peak);
  for (const GrouperTime& time : times) {
    const double operations = nominal_operations(time.grouper, time.table->matches.size());
    if (operations == 0) continue;
    const double rate = operations / kernel_ms(time) / 1e6;
    std::fprintf(to, "rate: %-6s %s n = %d: %.2f GFLOP/s, %.2f %% of peak\n", time.grouper.c_str(),
                 time.table->mesh.c_str(), time.table->matches.size(), rate, 100 * rate / peak);
  }
}

void print_exponents(std::FILE* to, const std::vector<GrouperTime>& times) {
  std::fprintf(to, "\n");
  for (const Grouper& grouper : groupers()) {
    std::vector<std::pair<double, double>> points;
    std::set<int> sizes;
    for (const GrouperTime& time : times) {
      if (time.grouper != grouper.name) continue;
      points.emplace_back(std::log(time.table->matches.size()), std::log(time.ms));
      sizes.insert(time.table->matches.size());
    }
    if (sizes.size() > 1) std::fprintf(to, "cost: %-6s grows as n^%.2f\n", grouper.name.c_str(), slope(points));
  }
}

bool print_labels(std::FILE* to, const std::vector<GrouperTime>& times) {
  std::map<const NaturalTable*, bool> identical;
  for (const auto& [grouper, table, ms] : times) {
    const auto expected = reference_selection(grouper, table->matches);
    if (!expected) continue;
    const bool same = find_grouper(grouper).configure({}).group(table->matches).selected == *expected;
    if (!same)
      std::fprintf(to, "labels: %s differs on %s n = %d\n", grouper.c_str(), table->mesh.c_str(),
                   table->matches.size());
    identical.try_emplace(table, true).first->second &= same;
  }
  std::size_t count = 0;
  for (const auto& [table, same] : identical) count += same;
  std::fprintf(to, "\nlabels: identical on %zu of %zu tables\n", count, identical.size());
  return count == identical.size();
}

}  // namespace corral::benchmarks
