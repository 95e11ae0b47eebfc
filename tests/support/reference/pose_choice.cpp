// SPDX-License-Identifier: MIT
#include "tests/support/reference/pose_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "kernel/weighted_fit.h"

namespace corral::reference {
namespace {

std::vector<double> contents_of(const CorrespondenceSet& matches, int row) {
  std::vector<double> contents;
  const auto add = [&](const auto& numbers) {
    for (const double number : numbers) contents.push_back(number);
  };
  const auto i = static_cast<std::size_t>(row);
  add(matches.source_points.row(row));
  add(matches.target_points.row(row));
  if (matches.feature_distance.size() > 0) contents.push_back(matches.feature_distance(row));
  if (matches.second_feature_distance.size() > 0) contents.push_back(matches.second_feature_distance(row));
  if (!matches.source_frames.empty()) add(matches.source_frames[i].reshaped());
  if (!matches.target_frames.empty()) add(matches.target_frames[i].reshaped());
  return contents;
}

double length(double x, double y, double z) { return std::sqrt(x * x + y * y + z * z); }

double distance(const Points& points, int i, int j) {
  return length(points(i, 0) - points(j, 0), points(i, 1) - points(j, 1), points(i, 2) - points(j, 2));
}

double residual(const CorrespondenceSet& matches, const RigidTransform& pose, int row) {
  std::array<double, 3> off{};
  for (int axis = 0; axis < 3; ++axis)
    off[static_cast<std::size_t>(axis)] = pose.rotation(axis, 0) * matches.source_points(row, 0) +
                                          pose.rotation(axis, 1) * matches.source_points(row, 1) +
                                          pose.rotation(axis, 2) * matches.source_points(row, 2) +
                                          pose.translation(axis) - matches.target_points(row, axis);
  return length(off[0], off[1], off[2]);
}

double worth_of_row(PoseScore score, double e) {
  switch (score) {
    case PoseScore::Inliers:
      return 1;
    case PoseScore::Mse:
      return (1 - e) * (1 - e);
    case PoseScore::Msac:
      return 1 - e * e;
    default:
      return 1 - e;
  }
}

}  // namespace

Selection in_canonical_order(const CorrespondenceSet& matches,
                             const std::function<Selection(const CorrespondenceSet&)>& select) {
  std::vector<std::pair<std::vector<double>, int>> sorted;
  for (int row = 0; row < matches.size(); ++row) sorted.emplace_back(contents_of(matches, row), row);
  std::sort(sorted.begin(), sorted.end());
  Indices order;
  for (const auto& entry : sorted) order.push_back(entry.second);
  Selection selection = select(select_rows(matches, order));
  for (int& row : selection.rows) row = order[static_cast<std::size_t>(row)];
  std::sort(selection.rows.begin(), selection.rows.end());
  return selection;
}

PairLengths pair_lengths(const CorrespondenceSet& matches, int i, int j) {
  const double source = distance(matches.source_points, i, j), target = distance(matches.target_points, i, j);
  return {std::abs(source - target), source + target};
}

PoseWorth pose_worth(const CorrespondenceSet& matches, const RigidTransform& pose, PoseScore score,
                     double tolerance_pr) {
  const double tolerance = tolerance_pr * matches.resolution;
  PoseWorth worth;
  std::map<std::array<double, 3>, std::vector<double>> by_target;
  for (int row = 0; row < matches.size(); ++row) {
    const double e = residual(matches, pose, row);
    if (!(e < tolerance)) continue;
    worth.agreeing.push_back(row);
    worth.score += worth_of_row(score, e / tolerance);
    worth.mae += 1 - e / tolerance;
    if (score != PoseScore::Oamae) continue;
    const auto q = matches.target_points.row(row);
    by_target[{q(0), q(1), q(2)}].push_back(1 - e / tolerance);
  }
  if (score != PoseScore::Oamae) return worth;
  worth.score = 0;
  for (const auto& [point, parts] : by_target) {
    double sum = 0;
    for (const double part : parts) sum += part;
    worth.score += sum / static_cast<double>(parts.size());
  }
  return worth;
}

RigidTransform refitted(const CorrespondenceSet& matches, const RigidTransform& pose, PoseScore score,
                        double tolerance_pr, int rounds) {
  RigidTransform present = pose, best = pose;
  PoseWorth worth = pose_worth(matches, pose, score, tolerance_pr), best_worth = worth;
  Indices before;
  for (int round = 0; round < rounds && worth.agreeing.size() >= 3 && worth.agreeing != before; ++round) {
    before = worth.agreeing;
    std::vector<double> weights;
    for (const int row : before) {
      const double e = residual(matches, present, row) / (tolerance_pr * matches.resolution);
      weights.push_back(1 / (1 + e * e));
    }
    const auto next = fit_weighted(matches, before, weights);
    if (!next) break;
    present = *next;
    worth = pose_worth(matches, present, score, tolerance_pr);
    if (worth > best_worth) best = present, best_worth = worth;
  }
  return best;
}

Selection rows_of_best_pose(const CorrespondenceSet& matches, const std::vector<RigidTransform>& poses, PoseScore score,
                            double tolerance_pr, int rounds) {
  if (poses.empty()) return {};
  RigidTransform best = poses.front();
  PoseWorth best_worth = pose_worth(matches, best, score, tolerance_pr);
  for (const RigidTransform& pose : poses) {
    const PoseWorth worth = pose_worth(matches, pose, score, tolerance_pr);
    if (worth > best_worth) best = pose, best_worth = worth;
  }
  const RigidTransform end = refitted(matches, best, score, tolerance_pr, rounds);
  Indices rows = pose_worth(matches, end, score, tolerance_pr).agreeing;
  if (rows.size() < 3) rows.clear();
  return {rows};
}

}  // namespace corral::reference
