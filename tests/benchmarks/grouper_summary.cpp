// SPDX-License-Identifier: MIT
#include "tests/benchmarks/grouper_summary.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <ctime>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "grouping/filter_loops.h"
#include "grouping/registry.h"
#include "kernel/random.h"
#include "tests/benchmarks/multiply_add_peak.h"
#include "tests/benchmarks/plain_groupers.h"
#include "tests/benchmarks/ratio_table.h"
#include "tests/support/reference_groupers.h"

namespace corral::benchmarks {
namespace {

// What an operation is:
//   RANSAC   27 for each pose and match: 9 products and 9 sums move the point, 3 differences, 3 squares, 2 sums and a
//            comparison judge it
//   GC       20 for each unordered pair: 6 differences, 6 squares and 4 sums on the two sides, the difference and the sum
//            of the squared lengths, 2 to judge them

/// The arithmetic that the definition asks for, and the loop that does it, on a table.
struct Kernel {
  double operations;
  Call call;
};

/// The residuals of every match under poses through one match each, none given up early.
Kernel residual_counting(const CorrespondenceSet& matches) {
  constexpr int kPoses = 1000;
  const auto table = std::make_shared<FilterTable>(matches);
  const auto poses = std::make_shared<std::vector<PoseFilter>>();
  RandomStream random(1);
  for (int i = 0; i < kPoses; ++i) {
    RigidTransform pose{random.rotation(), Eigen::Vector3d::Zero()};
    const int row = i % matches.size();
    pose.translation = matches.target_points.row(row).transpose() - pose * matches.source_points.row(row).transpose();
    poses->emplace_back(*table, pose, 5 * matches.resolution);
  }
  return {27.0 * kPoses * matches.size(), [table, poses] {
            for (const PoseFilter& pose : *poses) benchmark::DoNotOptimize(count_near(*table, pose, table->rows(), -1));
          }};
}

Kernel pair_counting(const CorrespondenceSet& matches) {
  const auto table = std::make_shared<FilterTable>(matches);
  const auto counts = std::make_shared<FloatColumn>(static_cast<std::size_t>(table->padded_rows()));
  const double pairs = 0.5 * matches.size() * (matches.size() - 1);
  return {20 * pairs, [table, counts, tolerance = 3 * matches.resolution] {
            count_consistent(*table, {*table, tolerance}, counts->data());
            benchmark::DoNotOptimize(counts->front());
          }};
}

/// GFLOP/s: the best of five runs of at least 5 ms.
double rate(const Kernel& kernel) {
  double best = 0;
  for (int run = 0; run < 5; ++run) {
    int calls = 0;
    double ms = 0;
    for (const std::clock_t start = std::clock(); ms < 5; ++calls) {
      kernel.call();
      ms = 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    }
    best = std::max(best, kernel.operations * calls / ms / 1e6);
  }
  return best;
}

/// Absent where there is no reference, or where it would take too long.
std::optional<Indices> reference_selection(const std::string& grouper, const CorrespondenceSet& matches) {
  const int count = matches.size();
  if (grouper == "ss") return reference::similarity_score(matches, {}).rows;
  if (grouper == "nnsr") return reference::nearest_neighbor_ratio(matches, {}).rows;
  if (grouper == "st" && count <= 500) return reference::spectral(matches, {}).rows;
  if (grouper == "gc" && count <= 500) return reference::geometric_consistency(matches, {}).rows;
  if (grouper == "gc") return plain::largest_star(matches, 3 * matches.resolution);
  if (grouper == "hough") return reference::hough_voting(matches, {}).rows;
  if (grouper == "si" && count <= 5000) return reference::search_of_inliers(matches, {}).rows;
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
    if (time.grouper != "ransac" && time.grouper != "gc") continue;
    const CorrespondenceSet& matches = time.table->matches;
    const double reached = rate(time.grouper == "gc" ? pair_counting(matches) : residual_counting(matches));
    std::fprintf(to, "counting: %-6s %s n = %d: %.1f GFLOP/s, %.0f %% of peak\n", time.grouper.c_str(),
                 time.table->scene.c_str(), matches.size(), reached, 100 * reached / peak);
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
      std::fprintf(to, "labels: %s differs on %s n = %d\n", grouper.c_str(), table->scene.c_str(),
                   table->matches.size());
    identical.try_emplace(table, true).first->second &= same;
  }
  std::size_t count = 0;
  for (const auto& [table, same] : identical) count += same;
  std::fprintf(to, "\nlabels: identical on %zu of %zu tables\n", count, identical.size());
  return count == identical.size();
}

}  // namespace corral::benchmarks
