// SPDX-License-Identifier: MIT
#pragma once

// Every stage of the surface room on one mesh, to compare runs with each other.

#include <gtest/gtest.h>

#include <string>

#include "kernel/surface/feature_matching.h"
#include "kernel/surface/harris.h"
#include "kernel/surface/normals.h"
#include "kernel/surface/search/resolution.h"
#include "kernel/surface/shot.h"

namespace corral::testing {

struct SurfaceStages {
  double resolution = 0;
  Points normals;
  Eigen::VectorXd response;
  Keypoints keypoints;
  Descriptors descriptors;
};

inline SurfaceStages run_stages(const Mesh& mesh, const ParallelFor& parallel = one_by_one,
                                ShotForm form = ShotForm::Additive) {
  SurfaceStages stages;
  stages.resolution = point_resolution(mesh.vertices, parallel);
  stages.normals = estimate_normals(mesh, {}, parallel);
  stages.response = harris_response(mesh.vertices, 3 * stages.resolution, parallel);
  stages.keypoints = detect_harris(mesh.vertices, stages.resolution, {}, parallel);
  stages.descriptors = describe_shot(mesh.vertices, stages.normals, stages.keypoints.vertices, stages.resolution,
                                     {8, 10, form}, parallel);
  return stages;
}

/// To the last bit.
inline void expect_identical(const SurfaceStages& found, const SurfaceStages& expected) {
  EXPECT_EQ(found.resolution, expected.resolution);
  EXPECT_TRUE(found.normals == expected.normals);
  EXPECT_TRUE(found.response == expected.response);
  EXPECT_EQ(found.keypoints.vertices, expected.keypoints.vertices);
  EXPECT_EQ(found.keypoints.candidates, expected.keypoints.candidates);
  EXPECT_EQ(found.descriptors.vertices, expected.descriptors.vertices);
  EXPECT_TRUE(found.descriptors.frames == expected.descriptors.frames);
  EXPECT_TRUE(found.descriptors.features == expected.descriptors.features);
}

}  // namespace corral::testing
