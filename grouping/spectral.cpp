// SPDX-License-Identifier: MIT
#include "grouping/spectral.h"

#include <algorithm>

#include "grouping/compatibility.h"
#include "grouping/principal_eigenvector.h"

namespace corral {
namespace {

constexpr double kTie = 1e-9;

/// r(i,j) where it reaches `similarity`, else 0; 1 on the diagonal.
Eigen::MatrixXd compatibility_matrix(const CorrespondenceSet& matches, double similarity) {
  const int rows = matches.size();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(rows, rows);
  for (int i = 0; i < rows; ++i)
    for (int j = i + 1; j < rows; ++j) {
      const PairDistances distances = pair_distances(matches, i, j);
      const double ratio = rigidity_ratio(distances.source, distances.target);
      matrix(i, j) = matrix(j, i) = ratio >= similarity ? ratio : 0;
    }
  return matrix;
}

/// Position of the largest entry; entries within kTie of it are equal, and the first of them is meant.
Eigen::Index first_maximum(const Eigen::VectorXd& x) {
  const double threshold = x.maxCoeff() - kTie;
  Eigen::Index position = 0;
  while (!(x(position) >= threshold)) ++position;
  return position;
}

/// Accepts one match after another; `refresh` gives the entries of the matches alive from those they had before.
template <class Refresh>
Indices accept_greedily(const Eigen::MatrixXd& weights, Eigen::VectorXd x, Refresh refresh) {
  Indices alive(static_cast<std::size_t>(weights.rows()));
  for (std::size_t i = 0; i < alive.size(); ++i) alive[i] = static_cast<int>(i);
  Indices accepted;
  while (!alive.empty() && x.maxCoeff() > kTie) {
    const auto chosen = static_cast<std::size_t>(first_maximum(x));
    accepted.push_back(alive[chosen]);
    Indices survivors, positions;
    for (std::size_t i = 0; i < alive.size(); ++i)
      if (i != chosen && weights(alive[chosen], alive[i]) > 0)
        survivors.push_back(alive[i]), positions.push_back(static_cast<int>(i));
    alive = survivors;
    x = refresh(alive, Eigen::VectorXd(x(positions)));
  }
  std::sort(accepted.begin(), accepted.end());
  return accepted;
}

}  // namespace

GroupingResult group_by_spectral(const CorrespondenceSet& matches, const SpectralOptions& options) {
  validate_options(options, "st");
  matches.validate();
  GroupingResult result;
  Eigen::MatrixXd weights = compatibility_matrix(matches, options.similarity);
  if ((weights.array() > 0).count() == weights.rows()) return result;  // nobody agrees with anybody else
  if (!options.weighted) weights = (weights.array() > 0).cast<double>();

  const Eigen::VectorXd full = principal_eigenvector(weights);
  if (options.once) {
    result.selected = accept_greedily(weights, full, [](const Indices&, const Eigen::VectorXd& x) { return x; });
  } else {
    result.selected = accept_greedily(weights, full, [&](const Indices& alive, const Eigen::VectorXd&) {
      return principal_eigenvector(weights(alive, alive));
    });
  }
  return result;
}

}  // namespace corral
