// SPDX-License-Identifier: MIT
#include "grouping/pose/gnc.h"

#include <algorithm>
#include <cmath>

#include "kernel/weighted_fit.h"

namespace corral {
namespace {

constexpr int kRounds = 100;
constexpr double kGrowth = 1.4, kSmallestChange = 1e-6;

std::vector<double> squared_residuals(const CorrespondenceSet& matches, const Indices& rows,
                                      const RigidTransform& target_from_source) {
  std::vector<double> squared;
  for (const int row : rows) {
    const Eigen::Vector3d p = matches.source_points.row(row).transpose(),
                          q = matches.target_points.row(row).transpose();
    squared.push_back((target_from_source * p - q).squaredNorm());
  }
  return squared;
}

}  // namespace

double gnc_weight(double squared_residual, double squared_bound, double mu) {
  if (squared_residual >= squared_bound * (mu + 1) / mu) return 0;
  if (squared_residual <= squared_bound * mu / (mu + 1)) return 1;
  return std::sqrt(squared_bound / squared_residual * mu * (mu + 1)) - mu;
}

std::optional<RigidTransform> fit_gnc(const CorrespondenceSet& matches, const Indices& rows, double bound) {
  const double squared_bound = bound * bound;
  std::vector<double> weights(rows.size(), 1.0);
  std::optional<RigidTransform> pose = fit_weighted(matches, rows, weights);
  if (!pose) return pose;
  std::vector<double> squared = squared_residuals(matches, rows, *pose);
  const double excess = 2 * *std::max_element(squared.begin(), squared.end()) / squared_bound - 1;
  if (!(excess > 0)) return pose;
  double mu = 1 / excess, last_cost = 0;
  for (int round = 0; round < kRounds; ++round, mu *= kGrowth) {
    double cost = 0;
    bool is_decided = true;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      weights[i] = gnc_weight(squared[i], squared_bound, mu);
      is_decided = is_decided && (weights[i] == 0 || weights[i] == 1);
      cost += weights[i] * squared[i];
    }
    const auto next = fit_weighted(matches, rows, weights);
    if (!next) break;
    pose = next;
    if (is_decided || (round > 0 && std::abs(cost - last_cost) < kSmallestChange * squared_bound)) break;
    last_cost = cost;
    squared = squared_residuals(matches, rows, *pose);
  }
  return pose;
}

}  // namespace corral
