// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/correspondence_set.h"
#include "kernel/parallel.h"
#include "kernel/surface/descriptor.h"
#include "kernel/surface/mesh.h"

namespace corral {

/// The two nearest target features of every source feature.
struct FeatureMatches {
  Indices nearest;                  ///< column of the target features, per source feature
  Eigen::VectorXd distance;         ///< L2 to it
  Eigen::VectorXd second_distance;  ///< L2 to the second nearest, 0 where there is only one target feature
};

/// Exact L2 matching: one row per source feature (columns of D x N and D x M). Ties go to the lower target column.
/// Nothing is returned if either side is empty.
/// Cost      That of find_two_nearest().
FeatureMatches match_features(const Eigen::MatrixXd& source, const Eigen::MatrixXd& target,
                              const ParallelFor& parallel = one_by_one);

/// The table of matches of two described surfaces: row i is source keypoint i and its nearest target keypoint. Several
/// rows may share a target; no mutual check, no cut.
CorrespondenceSet make_correspondences(const Mesh& source, const Descriptors& source_descriptors, const Mesh& target,
                                       const Descriptors& target_descriptors, double resolution);

}  // namespace corral
