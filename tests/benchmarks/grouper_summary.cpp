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

#include "grouping/columns/filter_loops.h"
#include "grouping/graph/compatibility_graph.h"
#include "grouping/registry.h"
#include "grouping/spectral.h"
#include "kernel/all_finite.h"
#include "kernel/random.h"
#include "tests/benchmarks/multiply_add_peak.h"
#include "tests/benchmarks/plain_groupers.h"
#include "tests/benchmarks/ratio_table.h"
#include "tests/support/reference/groupers.h"

namespace corral::benchmarks {
namespace {

// What an operation is, by grouper and loop:
//   ransac residuals  27 for each pose and match: 9 products and 9 sums move the point, 3 differences, 3 squares, 2 sums and
//                     a comparison judge it
//   gc     pairs      16 for each unordered pair: 6 products and 8 sums for the two squared lengths and their difference, a
//                     square and a difference to judge it
//   st     ratios     20 for each ordered pair: 6 differences, 6 squares and 4 sums on the two sides, the lesser and the
//                     greater of them, a product and a comparison
//   st     product    1 for each ordered pair that is compatible: the sum of a row
//   si     voters     47 for each ordered pair: a ratio and a residual as above
//   hough  method     36 for each match: 3 differences, 9 products and 6 sums into one frame, 9 and 6 out of the other, 3 sums
// NNSR does next to no arithmetic: what it reads is counted, which is the whole table, to check it. SS is a sort, its peer.

/// Numbers of a row: two points, two frames, two distances.
constexpr int kColumns = 26;

/// The arithmetic that the definition requires, and the loop that does it, on a table.
struct Kernel {
  std::string name;
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
  return {"residuals", 27.0 * kPoses * matches.size(), [table, poses] {
            for (const PoseFilter& pose : *poses) benchmark::DoNotOptimize(count_near(*table, pose, -1));
          }};
}

Kernel pair_counting(const CorrespondenceSet& matches) {
  const auto filter = std::make_shared<ConsistencyFilter>(FilterTable(matches), 3 * matches.resolution);
  const auto counts = std::make_shared<Indices>(static_cast<std::size_t>(filter->padded_rows()));
  const double pairs = 0.5 * matches.size() * (matches.size() - 1);
  return {"pairs", 16 * pairs, [filter, counts] {
            count_consistent(*filter, counts->data());
            benchmark::DoNotOptimize(counts->front());
          }};
}

Kernel ratio_comparing(const CorrespondenceSet& matches) {
  const auto table = std::make_shared<FilterTable>(matches);
  const auto size = static_cast<std::size_t>(table->padded_rows());
  const auto certain = std::make_shared<std::vector<std::uint8_t>>(size),
             possible = std::make_shared<std::vector<std::uint8_t>>(size);
  return {"ratios", 20.0 * matches.size() * matches.size(), [table, certain, possible] {
            for (int block = 0; block < table->padded_rows() / 8; ++block)
              compare_ratios(*table, SimilarityFilter(SpectralOptions().similarity), block, certain->data(),
                             possible->data());
            benchmark::DoNotOptimize(certain->front());
          }};
}

Kernel graph_product(const CorrespondenceSet& matches) {
  const auto graph = std::make_shared<CompatibilityGraph>(matches, SpectralOptions().similarity);
  const auto numbers = std::make_shared<Eigen::VectorXd>(Eigen::VectorXd::Ones(matches.size())),
             sums = std::make_shared<Eigen::VectorXd>(matches.size());
  return {"product", graph->degrees().sum(), [graph, numbers, sums] {
            graph->round_and_multiply(*numbers, *sums);
            benchmark::DoNotOptimize(sums->data());
          }};
}

Kernel voter_asking(const CorrespondenceSet& matches) {
  const auto table = std::make_shared<FilterTable>(matches);
  const auto pose = std::make_shared<PoseFilter>(*table, RigidTransform{}, 5 * matches.resolution);
  return {"voters", 47.0 * matches.size() * matches.size(), [table, pose] {
            const SimilarityFilter filter(SpectralOptions().similarity);
            for (int row = 0; row < table->rows(); ++row)
              benchmark::DoNotOptimize(ask_voters(*table, filter, *table, row, *pose));
          }};
}

Kernel whole_method(const std::string& grouper, double operations, const CorrespondenceSet& matches) {
  return {"method", operations,
          [group = find_grouper(grouper).configure({}).group, &matches] { benchmark::DoNotOptimize(group(matches)); }};
}

std::vector<Kernel> arithmetic_of(const std::string& grouper, const CorrespondenceSet& matches) {
  if (grouper == "ransac") return {residual_counting(matches)};
  if (grouper == "gc") return {pair_counting(matches)};
  if (grouper == "st") return {ratio_comparing(matches), graph_product(matches)};
  if (grouper == "si") return {voter_asking(matches)};
  if (grouper == "hough") return {whole_method(grouper, 36.0 * matches.size(), matches)};
  return {};
}

/// The columns of a table next to each other, and the loop that adds them up.
Kernel plain_reading(const CorrespondenceSet& matches) {
  const auto numbers =
      std::make_shared<AlignedColumn>(static_cast<std::size_t>(padded(kColumns * matches.size())), 1.0);
  return {"reading", 8.0 * kColumns * matches.size(), [numbers] {
            benchmark::DoNotOptimize(all_finite(numbers->data(), static_cast<Eigen::Index>(numbers->size())));
          }};
}

/// Operations (bytes) per nanosecond: the best of five runs of at least 5 ms.
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
    const CorrespondenceSet& matches = time.table->matches;
    const auto print = [&](const Kernel& kernel, const char* unit, double most, const char* of) {
      const double reached = rate(kernel);
      std::fprintf(to, "rate: %-6s %-9s %s n = %d: %.1f %s, %.0f %% of %s\n", time.grouper.c_str(), kernel.name.c_str(),
                   time.table->scene.c_str(), matches.size(), reached, unit, 100 * reached / most, of);
    };
    for (const Kernel& kernel : arithmetic_of(time.grouper, matches)) print(kernel, "GFLOP/s", peak, "peak");
    if (time.grouper == "nnsr")
      print(whole_method(time.grouper, 8.0 * kColumns * matches.size(), matches), "GB/s", rate(plain_reading(matches)),
            "plain reading");
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
