// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "kernel/local_reference_frame.h"
#include "kernel/types.h"

namespace corral {

/// The table of matches between two surfaces: row i of every column belongs to match i. It carries its unit of length, so
/// that lengths in options can be in pr. An absent column is empty; the two point columns are always present.
struct CorrespondenceSet {
  Points source_points;                ///< M x 3, mesh units
  Points target_points;                ///< M x 3, mesh units
  LocalReferenceFrames source_frames;  ///< M or empty; rows are axes, a keypoint without a frame has the zero matrix
  LocalReferenceFrames target_frames;  ///< M or empty
  Indices source_keypoints;            ///< M or empty; vertex of the source mesh
  Indices target_keypoints;            ///< M or empty; vertex of the target mesh
  Eigen::VectorXd feature_distance;    ///< M or empty; L2 to the nearest target feature
  Eigen::VectorXd second_feature_distance;         ///< M or empty; L2 to the second nearest, 0 where there is none
  double resolution = 1.0;                         ///< mesh units per pr
  std::optional<Eigen::Vector3d> source_centroid;  ///< mean of all source vertices (3DHV votes for its image)

  int size() const { return static_cast<int>(source_points.rows()); }

  /// The stored centroid, else the mean of the source points (zero for an empty table).
  Eigen::Vector3d source_centroid_or_mean() const;

  /// Throws InvalidInput naming the first column that is ragged or holds a value that is not finite, or a resolution that
  /// is not finite and positive.
  void validate() const;
};

/// Throws InvalidInput naming the first of `rows` that is not a row of the table.
void check_rows(const CorrespondenceSet& matches, const Indices& rows, const std::string& who);

/// The table of these rows, in their order; a row may occur twice. Absent columns stay absent. Throws InvalidInput for a row
/// that is not in the table.
CorrespondenceSet select_rows(const CorrespondenceSet& matches, const Indices& rows);

/// The optional columns that a grouper may need.
enum class Column { SourceFrames, TargetFrames, FeatureDistance, SecondFeatureDistance };

/// validate(), then throws InvalidInput if a named column is absent: "gc: column feature_distance is absent, ...".
void require_columns(const CorrespondenceSet& matches, const std::string& who, std::initializer_list<Column> columns);

}  // namespace corral
