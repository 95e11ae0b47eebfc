// SPDX-License-Identifier: MIT
#include "tests/support/degenerate_tables.h"

#include <functional>

#include "tests/support/table_changes.h"
#include "tests/support/tables.h"

namespace corral::testing {
namespace {

/// A table that is nothing special, half of its rows right.
SyntheticProblem ordinary() { return synthetic(24, 0.5, 3); }

using Change = std::function<void(CorrespondenceSet&)>;

CorrespondenceSet changed(const Change& change) {
  CorrespondenceSet table = ordinary().matches;
  change(table);
  return table;
}

/// Rows moved exactly, by one of several motions in turn, with their frames.
CorrespondenceSet moved_by(const std::vector<RigidTransform>& motions, CorrespondenceSet table) {
  for (int row = 0; row < table.size(); ++row) {
    const auto i = static_cast<std::size_t>(row);
    const RigidTransform& motion = motions[i % motions.size()];
    table.target_points.row(row) = (motion * table.source_points.row(row).transpose()).transpose();
    table.target_frames[i] = table.source_frames[i] * motion.rotation.transpose();
  }
  return table;
}

RigidTransform motion_of(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation = {0, 0, 0}) {
  RigidTransform motion;
  motion.rotation = rotation;
  motion.translation = translation;
  return motion;
}

/// Every corner of a cube meets its images under the four turns about one axis: four motions explain eight rows each.
CorrespondenceSet cube_with_four_turns() {
  Eigen::Matrix3d quarter;
  quarter << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  std::vector<RigidTransform> turns{motion_of(Eigen::Matrix3d::Identity())};
  while (turns.size() < 4) turns.push_back(motion_of(quarter * turns.back().rotation));
  CorrespondenceSet table = full_table(32);
  for (int row = 0; row < 32; ++row)
    for (int axis = 0; axis < 3; ++axis) table.source_points(row, axis) = (row / 4) >> axis & 1 ? 20 : -20;
  table.source_centroid = Eigen::Vector3d(7, 3, 1);  // off the axis: four votes
  return moved_by(turns, table);
}

/// A mirror image keeps all distances but no motion makes it. Its frames are left-handed unless they are taken over.
CorrespondenceSet mirrored(bool with_frames) {
  return changed([=](auto& t) {
    const Eigen::Matrix3d mirror = Eigen::Vector3d(1, 1, -1).asDiagonal();
    t = moved_by({motion_of(mirror)}, t);
    if (with_frames) t.target_frames = t.source_frames;
  });
}

/// Points projected on the space that the axes span.
void project(Points& points, const Eigen::Matrix3Xd& axes) { points = (points * axes * axes.transpose()).eval(); }

/// Flattened in the frame of the source on either side, as asked.
CorrespondenceSet flattened(int dimensions, bool source, bool target) {
  const SyntheticProblem problem = ordinary();
  const Eigen::Matrix3Xd axes = synthetic(1, 1, 8).truth.rotation.leftCols(dimensions);
  CorrespondenceSet table = problem.matches;
  if (source) project(table.source_points, axes);
  if (target) project(table.target_points, problem.truth.rotation * axes);
  return table;
}

CorrespondenceSet with_extent(double factor, bool ruler_too) {
  CorrespondenceSet table = scaled(ordinary().matches, factor);
  if (!ruler_too) table.resolution = 1;
  return table;
}

CorrespondenceSet far_away() {
  const RigidTransform source = motion_of(Eigen::Matrix3d::Identity(), {1e7, -2e7, 0.5e7});
  const RigidTransform target = motion_of(Eigen::Matrix3d::Identity(), {-3e7, 1e7, 1e7});
  return with_moved_target(with_moved_source(ordinary().matches, source), target);
}

CorrespondenceSet with_noise(double noise_pr, double inlier_ratio) {
  SyntheticOptions options;
  options.matches = 24;
  options.inlier_ratio = inlier_ratio;
  options.noise_pr = noise_pr;
  options.frame_noise_deg = 2 * noise_pr;
  return make_synthetic_problem(options).matches;
}

CorrespondenceSet with_features(double nearest, double second) {
  return changed([=](auto& t) {
    t.feature_distance.setConstant(nearest);
    t.second_feature_distance.setConstant(second);
  });
}

void mirror_frames(LocalReferenceFrames& frames) {
  for (auto& frame : frames) frame.row(1) *= -1;
}

void remove_frames(LocalReferenceFrames& frames) {
  for (auto& frame : frames) frame.setZero();
}

void put_at_one_place(Points& points) { points.rowwise() = points.row(0).eval(); }

}  // namespace

std::vector<DegenerateTable> degenerate_tables() {
  const RigidTransform half_turn = motion_of(Eigen::Vector3d(-1, -1, 1).asDiagonal());
  const RigidTransform elsewhere = motion_of(synthetic(1, 1, 9).truth.rotation, {300, -200, 100});
  return {
      {"no row", full_table(0)},
      {"one row", full_table(1)},
      {"two rows", full_table(2)},
      {"three rows", full_table(3)},
      {"four rows", full_table(4)},
      {"one row many times", select_rows(ordinary().matches, Indices(12, 0))},
      {"five rows many times", select_rows(ordinary().matches, {0, 1, 2, 3, 4, 4, 3, 2, 1, 0, 0, 1, 2, 3, 4, 2, 2, 2})},
      {"one source point", changed([](auto& t) { put_at_one_place(t.source_points); })},
      {"one target point", changed([](auto& t) { put_at_one_place(t.target_points); })},
      {"one point on either side",
       changed([](auto& t) { put_at_one_place(t.source_points), put_at_one_place(t.target_points); })},
      {"collinear", flattened(1, true, true)},
      {"collinear source", flattened(1, true, false)},
      {"collinear target", flattened(1, false, true)},
      {"coplanar", flattened(2, true, true)},
      {"coplanar source", flattened(2, true, false)},
      {"coplanar target", flattened(2, false, true)},
      {"mirrored", mirrored(false)},
      {"mirrored but for the frames", mirrored(true)},
      {"cube with four turns", cube_with_four_turns()},
      {"half a turn", moved_by({half_turn}, ordinary().matches)},
      {"two motions", moved_by({half_turn, elsewhere}, ordinary().matches)},
      {"the same twice", moved_by({RigidTransform()}, ordinary().matches)},
      {"all exactly right", with_noise(0, 1)},
      {"all right", with_noise(1, 1)},
      {"all wrong", with_noise(1, 0)},
      {"equal features", with_features(0.5, 1)},
      {"ratios on the limit", with_features(0.8, 1)},
      {"features at distance zero", with_features(0, 0)},
      {"nearest at distance zero", with_features(0, 1)},
      {"negative nearest distance", with_features(-0.5, 1)},
      {"negative second distance", with_features(0.5, -1)},
      {"negative distances", changed([](auto& t) { t.feature_distance *= -1, t.second_feature_distance *= -1; })},
      {"a bit of everything", harsh_table(200, 0.05, 3)},
      {"tiny", with_extent(1e-30, true)},
      {"tiny against the ruler", with_extent(1e-30, false)},
      {"huge", with_extent(1e30, true)},
      {"huge against the ruler", with_extent(1e30, false)},
      {"far away", far_away()},
      {"no frames", changed([](auto& t) { remove_frames(t.source_frames), remove_frames(t.target_frames); })},
      {"no source frames", changed([](auto& t) { remove_frames(t.source_frames); })},
      {"no target frames", changed([](auto& t) { remove_frames(t.target_frames); })},
      {"one pair of frames", changed([](auto& t) {
         const auto frame = t.source_frames[5];
         remove_frames(t.source_frames), t.source_frames[5] = frame;
       })},
      {"left-handed frames", changed([](auto& t) { mirror_frames(t.source_frames), mirror_frames(t.target_frames); })},
      {"left-handed source frames", changed([](auto& t) { mirror_frames(t.source_frames); })},
      {"left-handed target frames", changed([](auto& t) { mirror_frames(t.target_frames); })},
  };
}

}  // namespace corral::testing
