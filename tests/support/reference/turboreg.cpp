// SPDX-License-Identifier: MIT
#include "tests/support/reference/turboreg.h"

#include <algorithm>
#include <array>
#include <set>
#include <tuple>

#include "kernel/triangle_fit.h"
#include "tests/support/reference/pose_choice.h"

namespace corral::reference {
namespace {

using Counts = Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic>;

/// W: of each edge the common neighbours.
Counts common_neighbors(const CorrespondenceSet& matches, const TurboregOptions& options) {
  const int count = matches.size();
  Eigen::MatrixXi edges = Eigen::MatrixXi::Zero(count, count);
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) {
      const PairLengths lengths = pair_lengths(matches, i, j);
      edges(i, j) = i != j && lengths.difference < options.edge_pr * matches.resolution &&
                    lengths.sum > options.min_length_pr * matches.resolution;
    }
  Counts common = Counts::Zero(count, count);
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < i; ++j)
      if (edges(i, j) != 0) common(i, j) = common(j, i) = edges.col(i).dot(edges.col(j));
  return common;
}

std::vector<RigidTransform> pose_of(const CorrespondenceSet& matches, const std::array<int, 3>& corners) {
  LaneTriangles source, target;
  for (int lane = 0; lane < kLanes; ++lane) {
    source.set(lane, matches.source_points, corners);
    target.set(lane, matches.target_points, corners);
  }
  LaneMotions motions;
  fit_triangles(source, target, 1e-3 * matches.resolution * matches.resolution, motions);
  if (!motions.is_usable(0)) return {};
  return {motions.get(0)};
}

Selection of_sorted_rows(const CorrespondenceSet& matches, const TurboregOptions& options) {
  const Counts common = common_neighbors(matches, options);
  const auto difference = [&](int i, int j) { return pair_lengths(matches, i, j).difference; };
  std::vector<std::tuple<int, double, int, int>> edges;  // the first ones first
  for (int i = 0; i < matches.size(); ++i)
    for (int j = i + 1; j < matches.size(); ++j)
      if (common(i, j) > 0) edges.emplace_back(-common(i, j), difference(i, j), i, j);
  std::sort(edges.begin(), edges.end());
  edges.resize(std::min(edges.size(), static_cast<std::size_t>(options.pivots)));

  std::set<std::array<int, 3>> triangles;
  for (const auto& [negative, of_edge, i, j] : edges) {
    std::vector<std::tuple<int, double, int>> thirds;
    for (int k = 0; k < matches.size(); ++k)  // a common neighbour has one with i and with j: the other of them
      if (common(i, k) > 0 && common(j, k) > 0)
        thirds.emplace_back(-common(i, k) - common(j, k), std::max(difference(i, k), difference(j, k)), k);
    std::sort(thirds.begin(), thirds.end());
    for (std::size_t n = 0; n < std::min<std::size_t>(2, thirds.size()); ++n) {
      std::array<int, 3> corners{i, j, std::get<2>(thirds[n])};
      std::sort(corners.begin(), corners.end());
      triangles.insert(corners);
    }
  }
  std::vector<RigidTransform> poses;
  for (const auto& corners : triangles)
    for (const RigidTransform& pose : pose_of(matches, corners)) poses.push_back(pose);
  return rows_of_best_pose(matches, poses, options.score, options.tolerance_pr, options.refit_rounds);
}

}  // namespace

Selection turboreg(const CorrespondenceSet& matches, const TurboregOptions& options) {
  return in_canonical_order(matches, [&](const CorrespondenceSet& rows) { return of_sorted_rows(rows, options); });
}

}  // namespace corral::reference
