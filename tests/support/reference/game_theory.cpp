// SPDX-License-Identifier: MIT
#include "tests/support/reference/game_theory.h"

#include <Eigen/Core>
#include <algorithm>

namespace corral::reference {
namespace {

Eigen::MatrixXd payoffs(const CorrespondenceSet& matches, bool distinct) {
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(matches.size(), matches.size());
  for (int i = 0; i < matches.size(); ++i)
    for (int j = 0; j < matches.size(); ++j) {
      const double source = (matches.source_points.row(i) - matches.source_points.row(j)).norm(),
                   target = (matches.target_points.row(i) - matches.target_points.row(j)).norm();
      const bool shares = source == 0 || target == 0;
      if (i != j && source > 0 && target > 0 && !(distinct && shares))
        m(i, j) = std::min(source / target, target / source);
    }
  return m;
}

}  // namespace

Selection game_theory(const CorrespondenceSet& matches, const GameTheoryOptions& options) {
  if (matches.size() < 2) return {};
  const Eigen::MatrixXd m = payoffs(matches, options.distinct);
  Eigen::VectorXd x = Eigen::VectorXd::Constant(matches.size(), 1.0 / matches.size());
  for (int round = 0; round < options.rounds; ++round) {
    const Eigen::VectorXd gains = m * x;
    if (!(x.dot(gains) > 0)) return {};
    x = (x.array() * gains.array() / x.dot(gains)).matrix();
  }
  Selection result;
  result.scores.assign(x.begin(), x.end());
  result.rows = rows_by_otsu(result.scores, options.otsu);
  return result;
}

double mean_payoff(const CorrespondenceSet& matches, const std::vector<double>& shares) {
  const Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(shares.data(), static_cast<Eigen::Index>(shares.size()));
  return x.dot(payoffs(matches, false) * x);
}

}  // namespace corral::reference
