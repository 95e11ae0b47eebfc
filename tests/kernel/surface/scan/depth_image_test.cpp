// SPDX-License-Identifier: MIT
#include "kernel/surface/scan/depth_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/meshes.h"
#include "tests/support/tables.h"
#include "tests/support/views.h"

namespace corral {
namespace {

using ::testing::HasSubstr;
using testing::points_of;
using testing::refusal_of;

/// A wall 40 x 40 about the axis, a point at every unit, at depth 50 before a sensor that looks along -z.
Points wall() {
  Points points = testing::grid(41, 41).vertices;
  points.col(0).array() -= 20;
  points.col(1).array() -= 20;
  points.col(2).setConstant(-50);
  return points;
}

TEST(DepthImage, WhatIsNearerThanTheWallIsInFront) {
  for (const ViewOptions& sensor : {ViewOptions(), testing::seen_along({0, 0, -2})}) {
    const DepthImage image(wall(), 2, sensor);
    EXPECT_EQ(image.share_in_front(points_of({{0, 0, -40}}), 5), 1);
    EXPECT_EQ(image.share_in_front(points_of({{0, 0, -46}}), 5), 0) << "nearer than the margin";
    EXPECT_EQ(image.share_in_front(points_of({{0, 0, -44}, {0, 0, -46}, {1, 2, -44}, {0, 0, -60}}), 5), 0.5);
    EXPECT_EQ(image.share_in_front(wall(), 0.5), 0) << "the wall is not in front of itself";
  }
}

TEST(DepthImage, ThePerspectiveIsThatOfTheSensor) {
  const Points beside = points_of({{15, 0, -25}});  // its ray meets the plane of the wall at 30, beyond the wall
  EXPECT_EQ(DepthImage(wall(), 2).share_in_front(beside, 5), 0);
  EXPECT_EQ(DepthImage(wall(), 2, testing::seen_along({0, 0, -1})).share_in_front(beside, 5), 1);
  EXPECT_EQ(DepthImage(wall(), 2, testing::seen_from({15, 0, 10})).share_in_front(beside, 5), 1);
}

TEST(DepthImage, BesideTheViewAndInItsHolesNothingIsKnown) {
  const DepthImage image(wall(), 2);
  EXPECT_EQ(image.share_in_front(points_of({{35, 0, -40}, {0, 1e9, -1}, {0, 0, 5}, {0, 0, 0}, {NAN, 0, -40}}), 5), 0);
  Indices ring;
  const Points points = wall();
  for (Eigen::Index row = 0; row < points.rows(); ++row)
    if (points.row(row).head<2>().norm() > 10) ring.push_back(static_cast<int>(row));
  const Points holed = points(ring, Eigen::all);
  EXPECT_EQ(DepthImage(holed, 2).share_in_front(points_of({{0, 0, -40}}), 5), 0);
}

TEST(DepthImage, NextToANearerSurfaceAPointIsNotInFront) {
  Points step = wall();
  for (Eigen::Index row = 0; row < step.rows(); ++row)
    if (step(row, 0) > 0) step.row(row) *= 0.7;
  const DepthImage image(step, 2);
  EXPECT_EQ(image.share_in_front(points_of({{-1, 0, -40}}), 5), 0) << "a pose that is nearly right may do that";
  EXPECT_EQ(image.share_in_front(points_of({{-8, 0, -40}}), 5), 1);
}

TEST(DepthImage, AVeryWideViewGetsLargerCells) {
  Points wide = wall();
  wide.col(0) *= 1e5;
  wide.col(1) *= 1e5;
  wide.col(2) *= 1e5;
  const DepthImage image(wide, 1e-3);
  EXPECT_EQ(image.share_in_front(wide, 5), 0);
  EXPECT_EQ(image.share_in_front(wide * 0.5, 5), 1 * image.share_in_front(wide * 0.6, 5));
}

TEST(DepthImage, WhatIsWrongIsNamed) {
  EXPECT_THAT(refusal_of([] { DepthImage(wall(), 0); }), HasSubstr("cell"));
  EXPECT_THAT(refusal_of([] { DepthImage(Points(0, 3), 1); }), HasSubstr("no points"));
  EXPECT_THAT(refusal_of([] { DepthImage(wall(), 1, testing::seen_from({0, 0, -50})); }), HasSubstr("vertex 0"));
  EXPECT_THAT(refusal_of([] { DepthImage(points_of({{0, 0, -1}, {0, NAN, -1}}), 1); }), HasSubstr("vertex"));
}

}  // namespace
}  // namespace corral
