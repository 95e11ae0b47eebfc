// SPDX-License-Identifier: MIT
#include "tests/benchmarks/plain_groupers.h"

#include <algorithm>
#include <cmath>

namespace corral::benchmarks::plain {
namespace {

double distance(const Points& points, int i, int j) {
  const double x = points(i, 0) - points(j, 0), y = points(i, 1) - points(j, 1), z = points(i, 2) - points(j, 2);
  return std::sqrt(x * x + y * y + z * z);
}

bool agree(const CorrespondenceSet& matches, int i, int j, double tolerance) {
  return std::abs(distance(matches.source_points, i, j) - distance(matches.target_points, i, j)) < tolerance;
}

}  // namespace

std::vector<double> sorted_scores(const CorrespondenceSet& matches) {
  std::vector<double> scores;
  scores.reserve(static_cast<std::size_t>(matches.size()));
  for (int i = 0; i < matches.size(); ++i) scores.push_back(1 - matches.feature_distance(i));
  std::sort(scores.begin(), scores.end());
  return scores;
}

std::vector<double> ratio_scores(const CorrespondenceSet& matches) {
  std::vector<double> scores(static_cast<std::size_t>(matches.size()));
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    scores[i] = 1 - matches.feature_distance(row) / matches.second_feature_distance(row);
  }
  return scores;
}

Indices largest_star(const CorrespondenceSet& matches, double tolerance) {
  std::vector<int> members(static_cast<std::size_t>(matches.size()), 1);  // each agrees with itself
  for (int i = 0; i < matches.size(); ++i)
    for (int j = i + 1; j < matches.size(); ++j)
      if (agree(matches, i, j, tolerance))
        ++members[static_cast<std::size_t>(i)], ++members[static_cast<std::size_t>(j)];
  const auto seed = static_cast<int>(std::max_element(members.begin(), members.end()) - members.begin());
  Indices star;
  for (int i = 0; i < matches.size(); ++i)
    if (agree(matches, seed, i, tolerance)) star.push_back(i);
  return star;
}

}  // namespace corral::benchmarks::plain
