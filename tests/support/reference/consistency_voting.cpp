// SPDX-License-Identifier: MIT
#include "tests/support/reference/consistency_voting.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kernel/elementary.h"

namespace corral::reference {

Selection consistency_voting(const CorrespondenceSet& matches, const ConsistencyVotingOptions& options) {
  std::vector<std::pair<double, int>> by_ratio;
  for (int row = 0; row < matches.size(); ++row)
    by_ratio.emplace_back(matches.feature_distance(row) / matches.second_feature_distance(row), row);
  std::sort(by_ratio.begin(), by_ratio.end());
  by_ratio.resize(std::min(by_ratio.size(), static_cast<std::size_t>(options.voters)));
  const auto has_frames = [&](std::size_t row) {
    return is_valid_frame(matches.source_frames[row]) && is_valid_frame(matches.target_frames[row]);
  };
  Selection result;
  for (int i = 0; i < matches.size(); ++i) {
    double sum = 0;
    int asked = 0;
    for (const auto& [ratio, j] : by_ratio) {
      if (i == j) continue;
      ++asked;
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
      const double d = ((matches.source_points.row(i) - matches.source_points.row(j)).norm() -
                        (matches.target_points.row(i) - matches.target_points.row(j)).norm()) /
                       matches.resolution;
      double worth = exponential(-std::pow(d / options.scale_pr, 2));
      if (has_frames(a) && has_frames(b)) {
        const Eigen::Matrix3d relative = (matches.target_frames[a] * matches.target_frames[b].transpose()) *
                                         (matches.source_frames[a] * matches.source_frames[b].transpose()).transpose();
        const double deg = Eigen::AngleAxisd(relative).angle() * 180 / std::acos(-1.0);
        worth *= exponential(-std::pow(deg / options.scale_deg, 2));
      } else if (options.frames == FrameNeed::Required) {
        worth = 0;
      }
      sum += worth;
    }
    result.scores.push_back(asked > 0 ? sum / asked : 0);
  }
  result.rows = rows_by_otsu(result.scores, options.otsu);
  return result;
}

}  // namespace corral::reference
