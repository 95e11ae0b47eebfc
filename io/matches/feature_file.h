// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "io/array/number_table.h"
#include "kernel/types.h"

namespace corral {

/// Keypoints of a surface with a feature each, as a program for learned descriptors writes them.
struct FeaturePoints {
  Points points;
  Eigen::MatrixXd features;        ///< column i belongs to point i
  Indices vertices;                ///< of the points, if the file names vertices of the surface; else empty
  std::vector<std::string> notes;  ///< what a user should know: a sentence each, no full stop
};

/// Where they are, as text, .npy or .npz.
struct FeatureFiles {
  std::string features;        ///< rows x y z f1 .. fn; or rows f1 .. fn if `keypoints` is named; or a .npz of both
  std::string keypoints = {};  ///< rows x y z, or one vertex of the surface in each
  const Points* vertices = nullptr;  ///< of the surface, which such keypoints need
};

/// Reads them. Keypoints with a nan, in their place or feature, are left out and counted.
/// Throws    IoError naming file and line: no features, counts that differ, an infinite number, a vertex that is not there.
FeaturePoints read_features(const FeatureFiles& files);

/// The same of tables that have been read.
FeaturePoints features_of(const NumberTable& keypoints, const NumberTable& features, const Points* vertices = nullptr);

}  // namespace corral
