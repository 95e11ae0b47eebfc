// SPDX-License-Identifier: MIT
#include "apps/runtime/json.h"

#include <gtest/gtest.h>

namespace corral {
namespace {

TEST(ToJson, ATransformIsFourRowsOfFour) {
  RigidTransform pose;
  pose.rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  pose.translation << 7, 8, 9;
  EXPECT_EQ(to_json(pose).dump(), "[[0.0,-1.0,0.0,7.0],[1.0,0.0,0.0,8.0],[0.0,0.0,1.0,9.0],[0.0,0.0,0.0,1.0]]");
}

}  // namespace
}  // namespace corral
