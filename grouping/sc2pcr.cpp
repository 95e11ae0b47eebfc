// SPDX-License-Identifier: MIT
#include "grouping/sc2pcr.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "grouping/columns/canonical_order.h"
#include "grouping/columns/compatibility.h"
#include "grouping/graph/bit_graph.h"
#include "grouping/graph/pair_matrix.h"
#include "grouping/pose/pose_choice.h"
#include "kernel/weighted_fit.h"

namespace corral {
namespace {

constexpr int kRounds = 10;  ///< of power iteration

double difference_of_lengths(const CorrespondenceSet& matches, int i, int j) {
  const PairDistances lengths = pair_distances(matches, i, j);
  return std::abs(lengths.source - lengths.target);
}

/// A number of 24 bits that is as near as any.
double rounded(double number) {
  const double high = number * 0x20000001;
  return high - (high - number);
}

/// v, to 24 bits.
std::vector<double> leading_entries(const CorrespondenceSet& matches, double distance) {
  const PairMatrix matrix = PairMatrix::of_differences(matches, distance);
  AlignedColumn values(static_cast<std::size_t>(padded(matches.size())), 0), sums(values);
  std::fill_n(values.begin(), matches.size(), 1.0);
  for (int round = 0; round < kRounds; ++round) {
    matrix.multiply(values, sums);
    double square = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] += sums[i];  // S_ii = 1
      square += values[i] * values[i];
    }
    const double norm = std::sqrt(square);
    for (double& value : values) value /= norm;
  }
  std::vector<double> entries(static_cast<std::size_t>(matches.size()));
  std::transform(values.begin(), values.begin() + matches.size(), entries.begin(), rounded);
  return entries;
}

std::size_t most_seeds(int matches, double share) {
  return static_cast<std::size_t>(std::max(1.0, std::floor(share * matches)));
}

/// The rows, which ascend in x, without a better one near them, by v.
Indices find_seeds(const CorrespondenceSet& matches, const std::vector<double>& v, double radius, std::size_t most) {
  const Points& p = matches.source_points;
  const auto is_better = [&](int a, int b) {
    const double of_a = v[static_cast<std::size_t>(a)], of_b = v[static_cast<std::size_t>(b)];
    return of_a != of_b ? of_a > of_b : a < b;
  };
  const auto beats = [&](int other, int row) {
    return is_better(other, row) && point_distance(p, row, other) < radius;
  };
  const auto is_largest = [&](int row) {
    for (int j = row - 1; j >= 0 && p(row, 0) - p(j, 0) < radius; --j)
      if (beats(j, row)) return false;
    for (int j = row + 1; j < matches.size() && p(j, 0) - p(row, 0) < radius; ++j)
      if (beats(j, row)) return false;
    return true;
  };
  Indices seeds;
  for (int row = 0; row < matches.size(); ++row)
    if (is_largest(row)) seeds.push_back(row);
  std::sort(seeds.begin(), seeds.end(), is_better);
  seeds.resize(std::min(seeds.size(), most));
  return seeds;
}

/// A match beside a seed.
struct Companion {
  int second_order;  ///< W
  int row;
  double difference;  ///< D to the seed
  int agreeing = 0;   ///< of the first set
};
bool comes_first(const Companion& a, const Companion& b) {
  return std::tie(b.agreeing, b.second_order, a.difference, a.row) <
         std::tie(a.agreeing, a.second_order, b.difference, b.row);
}

class Consensus {
 public:
  Consensus(const CorrespondenceSet& matches, const Sc2pcrOptions& options)
      : matches_(matches),
        distance_(options.distance_pr * matches.resolution),
        first_(static_cast<std::size_t>(options.neighbours) - 1),
        second_(static_cast<std::size_t>(options.kept) - 1),
        agree_(consistency_graph(matches, distance_)),
        closely_(consistency_graph(matches, distance_ / 2)),
        counts_(static_cast<std::size_t>(matches.size())) {
    others_.reserve(counts_.size());
    companions_.reserve(counts_.size());
  }

  std::optional<RigidTransform> pose_of(int seed) {
    find_companions(seed);
    Indices rows{seed};
    for (const Companion& companion : companions_) rows.push_back(companion.row);
    if (rows.size() < 3) return std::nullopt;
    return fit_weighted(matches_, rows, weights_of(rows));
  }

 private:
  void find_companions(int seed) {
    others_.clear();
    agree_.for_neighbors(seed, [&](int j) { others_.push_back(j); });
    closely_.count_common(seed, others_, counts_.data());
    companions_.clear();
    for (std::size_t n = 0; n < others_.size(); ++n) {
      const int j = others_[n];
      const int second_order = counts_[n] + (closely_.is_edge(seed, j) ? 2 : 0);  // h_ss h_sj + h_sj h_jj
      if (second_order > 0) companions_.push_back({second_order, j, difference_of_lengths(matches_, seed, j)});
    }
    keep_first(first_);
    for (Companion& one : companions_)
      for (const Companion& other : companions_) one.agreeing += agree_.is_edge(one.row, other.row);
    keep_first(second_);
  }

  void keep_first(std::size_t count) {
    count = std::min(count, companions_.size());
    std::partial_sort(companions_.begin(), companions_.begin() + static_cast<std::ptrdiff_t>(count), companions_.end(),
                      comes_first);
    companions_.resize(count);
  }

  std::vector<double> weights_of(const Indices& rows) const {
    const auto count = static_cast<Eigen::Index>(rows.size());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(count, count);
    for (Eigen::Index i = 0; i < count; ++i)
      for (Eigen::Index j = 0; j < i; ++j) {
        const double share =
            difference_of_lengths(matches_, rows[static_cast<std::size_t>(i)], rows[static_cast<std::size_t>(j)]) /
            distance_;
        matrix(i, j) = matrix(j, i) = share < 1 ? 1 - share * share : 0;
      }
    std::vector<double> weights(rows.size(), 1.0), next(rows.size());
    for (int round = 0; round < kRounds; ++round) {
      double total = 0;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        next[i] = 0;
        for (std::size_t j = 0; j < rows.size(); ++j)
          next[i] += matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) * weights[j];
        total += next[i];
      }
      for (std::size_t i = 0; i < rows.size(); ++i) weights[i] = next[i] / total;  // not a number: no model
    }
    return weights;
  }

  const CorrespondenceSet& matches_;
  const double distance_;
  const std::size_t first_, second_;
  const BitGraph agree_, closely_;  ///< H and h without the diagonal
  std::vector<int> counts_;
  Indices others_;
  std::vector<Companion> companions_;
};

PoseRule rule_of(const Sc2pcrOptions& options) {
  return {options.score, options.tolerance_pr, options.refit_rounds, options.keep};
}

GroupingResult group_in_order(const CorrespondenceSet& matches, const Sc2pcrOptions& options) {
  const std::vector<double> entries = leading_entries(matches, options.distance_pr * matches.resolution);
  const Indices seeds = find_seeds(matches, entries, options.seed_radius_pr * matches.resolution,
                                   most_seeds(matches.size(), options.seed_share));
  Consensus consensus(matches, options);
  PoseChoice choice(matches, rule_of(options));
  for (const int seed : seeds)
    if (const auto pose = consensus.pose_of(seed)) choice.offer(*pose);
  return choice.finish();
}

}  // namespace

GroupingResult group_by_sc2pcr(const CorrespondenceSet& matches, const Sc2pcrOptions& options) {
  validate_options(options, "sc2pcr");
  matches.validate();
  if (matches.size() < 3) return {};
  return group_in_canonical_order(matches,
                                  [&](const CorrespondenceSet& rows) { return group_in_order(rows, options); });
}

double working_memory(int matches, const Sc2pcrOptions& options) {
  const double seeds = static_cast<double>(most_seeds(matches, options.seed_share));
  const double matrix = PairMatrix::memory(matches) + 16.0 * padded(matches);
  const double members = std::min(1.0 * matches, 1.0 * options.kept);
  const double graphs = 2 * BitGraph::memory(matches) + (8.0 + sizeof(Companion)) * matches + 16 * members * members +
                        PoseChoice::memory(matches, seeds, rule_of(options));
  return canonical_order_memory(matches) + 16.0 * matches + std::max(matrix, graphs);
}

}  // namespace corral
