// SPDX-License-Identifier: MIT
#include "tests/support/reference/frame_ransac.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <set>

#include "tests/support/reference/pose_choice.h"

namespace corral::reference {
namespace {

double off_identity(const Eigen::Matrix3d& matrix) {
  return (matrix * matrix.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
}

bool is_frame(const Eigen::Matrix3d& matrix) { return off_identity(matrix) <= 1e-4 && matrix.determinant() > 0; }

struct Hypothesis {
  RigidTransform pose;
  PoseWorth worth;
};

std::vector<Hypothesis> hypotheses_of(const CorrespondenceSet& matches, const FrameRansacOptions& options) {
  std::vector<Hypothesis> all;
  for (int row = 0; row < matches.size(); ++row) {
    const Eigen::Matrix3d &source = matches.source_frames[static_cast<std::size_t>(row)],
                          &target = matches.target_frames[static_cast<std::size_t>(row)];
    if (!is_frame(source) || !is_frame(target)) continue;
    RigidTransform pose;
    pose.rotation = target.transpose() * source;
    if (off_identity(pose.rotation) > 1e-9) {
      const Eigen::JacobiSVD<Eigen::Matrix3d> svd(pose.rotation, Eigen::ComputeFullU | Eigen::ComputeFullV);
      pose.rotation = svd.matrixU() * svd.matrixV().transpose();
    }
    pose.translation =
        matches.target_points.row(row).transpose() - pose.rotation * matches.source_points.row(row).transpose();
    const PoseWorth worth = pose_worth(matches, pose, options.score, options.tolerance_pr);
    if (worth.agreeing.size() >= 3) all.push_back({pose, worth});
  }
  return all;
}

Selection of_sorted_rows(const CorrespondenceSet& matches, const FrameRansacOptions& options) {
  std::vector<Hypothesis> all = hypotheses_of(matches, options);
  std::stable_sort(all.begin(), all.end(), [](const Hypothesis& a, const Hypothesis& b) { return a.worth > b.worth; });
  std::set<Indices> seen;
  std::vector<RigidTransform> poses;
  for (const Hypothesis& one : all) {
    if (static_cast<int>(poses.size()) == std::max(1, options.polish)) break;
    if (!seen.insert(one.worth.agreeing).second) continue;
    poses.push_back(refitted(matches, one.pose, options.score, options.tolerance_pr,
                             options.polish > 0 ? options.refit_rounds : 0));
  }
  return rows_of_best_pose(matches, poses, options.score, options.tolerance_pr, 0);
}

}  // namespace

Selection frame_ransac(const CorrespondenceSet& matches, const FrameRansacOptions& options) {
  return in_canonical_order(matches, [&](const CorrespondenceSet& rows) { return of_sorted_rows(rows, options); });
}

}  // namespace corral::reference
