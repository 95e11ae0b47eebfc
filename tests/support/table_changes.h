// SPDX-License-Identifier: MIT
#pragma once

// The same matches written down otherwise: in another unit, seen from elsewhere, in another order.

#include "kernel/correspondence_set.h"
#include "kernel/rigid_transform.h"

namespace corral::testing {

/// All lengths, the ruler included, times a factor.
inline CorrespondenceSet scaled(CorrespondenceSet table, double factor) {
  table.source_points *= factor;
  table.target_points *= factor;
  table.resolution *= factor;
  if (table.source_centroid) *table.source_centroid *= factor;
  return table;
}

/// Row by row, so that equal points stay equal.
inline void move_points(Points& points, const RigidTransform& motion) {
  for (int row = 0; row < points.rows(); ++row) points.row(row) = (motion * points.row(row).transpose()).transpose();
}

/// The target moved, its frames with it.
inline CorrespondenceSet with_moved_target(CorrespondenceSet table, const RigidTransform& moved_from_target) {
  move_points(table.target_points, moved_from_target);
  for (auto& frame : table.target_frames) frame = frame * moved_from_target.rotation.transpose();
  return table;
}

/// The source moved, its frames and its centroid with it.
inline CorrespondenceSet with_moved_source(CorrespondenceSet table, const RigidTransform& moved_from_source) {
  move_points(table.source_points, moved_from_source);
  for (auto& frame : table.source_frames) frame = frame * moved_from_source.rotation.transpose();
  if (table.source_centroid) table.source_centroid = moved_from_source * *table.source_centroid;
  return table;
}

/// Source and target change places. The centroid is that of the old source and goes.
inline CorrespondenceSet with_sides_swapped(CorrespondenceSet table) {
  table.source_points.swap(table.target_points);
  table.source_frames.swap(table.target_frames);
  table.source_keypoints.swap(table.target_keypoints);
  table.source_centroid.reset();
  return table;
}

/// Whole multiples of 2^-20, so that sums with other such numbers are exact.
inline CorrespondenceSet on_a_grid(CorrespondenceSet table) {
  const auto round = [](const auto& lengths) { return ((lengths * 0x1p20).array().round().matrix() * 0x1p-20).eval(); };
  table.source_points = round(table.source_points);
  table.target_points = round(table.target_points);
  if (table.source_centroid) table.source_centroid = round(*table.source_centroid);
  return table;
}

}  // namespace corral::testing
