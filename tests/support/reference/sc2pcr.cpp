// SPDX-License-Identifier: MIT
#include "tests/support/reference/sc2pcr.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "kernel/weighted_fit.h"
#include "tests/support/reference/pose_choice.h"

namespace corral::reference {
namespace {

/// D, its diagonal 0.
Eigen::MatrixXd differences(const CorrespondenceSet& matches) {
  Eigen::MatrixXd d(matches.size(), matches.size());
  for (int i = 0; i < matches.size(); ++i)
    for (int j = 0; j < matches.size(); ++j) d(i, j) = i == j ? 0 : pair_lengths(matches, i, j).difference;
  return d;
}

Eigen::MatrixXd closeness(const Eigen::MatrixXd& d, double distance) {
  return d.unaryExpr([&](double x) { return x < distance ? 1 - (x / distance) * (x / distance) : 0; });
}

Eigen::MatrixXi below(const Eigen::MatrixXd& d, double distance) {
  return d.unaryExpr([&](double x) { return x < distance ? 1 : 0; });
}

/// The nearest float of each entry, whatever its exponent.
std::vector<double> leading_entries(const Eigen::MatrixXd& s) {
  Eigen::VectorXd v = Eigen::VectorXd::Ones(s.rows());
  for (int round = 0; round < 10; ++round) v = (s * v).normalized();
  std::vector<double> entries;
  for (const double entry : v) {
    int exponent = 0;
    const double fraction = std::frexp(entry, &exponent);
    entries.push_back(std::ldexp(static_cast<double>(static_cast<float>(fraction)), exponent));
  }
  return entries;
}

/// Power rounds in the order of the fast form: poses of equal worth up to rounding are settled alike.
std::vector<double> weights_of(const Eigen::MatrixXd& s, const Indices& rows) {
  std::vector<double> weights(rows.size(), 1.0);
  for (int round = 0; round < 10; ++round) {
    std::vector<double> next(rows.size(), 0.0);
    double total = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t j = 0; j < rows.size(); ++j)
        if (i != j) next[i] += s(rows[i], rows[j]) * weights[j];
      total += next[i];
    }
    for (std::size_t i = 0; i < rows.size(); ++i) weights[i] = next[i] / total;
  }
  return weights;
}

/// The seed, and of `candidates` the first by these keys, up to a number in all.
using Key = std::tuple<int, int, double, int>;
Indices with_first(int seed, std::vector<Key> keys, int count) {
  std::sort(keys.begin(), keys.end());
  Indices rows{seed};
  for (const Key& key : keys)
    if (static_cast<int>(rows.size()) < count) rows.push_back(std::get<3>(key));
  return rows;
}

Selection of_sorted_rows(const CorrespondenceSet& matches, const Sc2pcrOptions& options) {
  const double distance = options.distance_pr * matches.resolution;
  const Eigen::MatrixXd d = differences(matches), s = closeness(d, distance);
  const Eigen::MatrixXi agree = below(d, distance), closely = below(d, distance / 2);
  std::vector<RigidTransform> poses;
  for (const int seed : sc2pcr_seeds(matches, options)) {
    const auto second_order = [&](int j) { return agree(seed, j) * closely.col(seed).dot(closely.col(j)); };
    std::vector<Key> keys;
    for (int j = 0; j < matches.size(); ++j)
      if (j != seed && second_order(j) > 0) keys.emplace_back(0, -second_order(j), d(seed, j), j);
    const Indices first = with_first(seed, keys, options.neighbours);
    keys.clear();
    for (const int j : first) {
      int agreeing = 0;
      for (const int k : first) agreeing += agree(seed, k) * agree(k, j);
      if (j != seed) keys.emplace_back(-agreeing, -second_order(j), d(seed, j), j);
    }
    const Indices second = with_first(seed, keys, options.kept);
    if (second.size() < 3) continue;
    if (const auto pose = fit_weighted(matches, second, weights_of(s, second))) poses.push_back(*pose);
  }
  return rows_of_best_pose(matches, poses, options.score, options.tolerance_pr, options.refit_rounds);
}

}  // namespace

Indices sc2pcr_seeds(const CorrespondenceSet& matches, const Sc2pcrOptions& options) {
  const std::vector<double> v =
      leading_entries(closeness(differences(matches), options.distance_pr * matches.resolution));
  const Points& p = matches.source_points;
  std::vector<std::pair<double, int>> seeds;
  for (int i = 0; i < matches.size(); ++i) {
    bool is_largest = true;
    for (int j = 0; j < matches.size(); ++j) {
      const double x = p(i, 0) - p(j, 0), y = p(i, 1) - p(j, 1), z = p(i, 2) - p(j, 2);
      const double of_i = v[static_cast<std::size_t>(i)], of_j = v[static_cast<std::size_t>(j)];
      if (std::sqrt(x * x + y * y + z * z) < options.seed_radius_pr * matches.resolution)
        is_largest = is_largest && (of_j < of_i || (of_j == of_i && j >= i));
    }
    if (is_largest) seeds.emplace_back(-v[static_cast<std::size_t>(i)], i);
  }
  std::sort(seeds.begin(), seeds.end());
  const int most = std::max(1, static_cast<int>(std::floor(options.seed_share * matches.size())));
  Indices rows;
  for (const auto& seed : seeds)
    if (static_cast<int>(rows.size()) < most) rows.push_back(seed.second);
  return rows;
}

Selection sc2pcr(const CorrespondenceSet& matches, const Sc2pcrOptions& options) {
  if (matches.size() < 3) return {};
  return in_canonical_order(matches, [&](const CorrespondenceSet& rows) { return of_sorted_rows(rows, options); });
}

}  // namespace corral::reference
