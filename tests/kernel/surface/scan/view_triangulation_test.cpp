// SPDX-License-Identifier: MIT
// Which triangles a view gets: Delaunay's, without those that are long or seen flat.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tests/support/meshes.h"
#include "tests/support/tables.h"
#include "tests/support/views.h"

namespace corral {
namespace {

using testing::points_of;
using testing::rough_view;
using testing::seen_along;
using testing::seen_from;
using testing::unlimited;

constexpr double kPi = 3.14159265358979323846;

Eigen::Vector3d normal_of(const Points& points, const Triangles& triangles, Eigen::Index face) {
  const Eigen::Vector3d a = points.row(triangles(face, 0)), b = points.row(triangles(face, 1)),
                        c = points.row(triangles(face, 2));
  return (b - a).cross(c - a).normalized();
}

Eigen::Vector3d middle_of(const Points& points, const Triangles& triangles, Eigen::Index face) {
  return points(Eigen::Vector3i(triangles.row(face)), Eigen::all).colwise().mean();
}

TEST(TriangulateView, AGridSeenFromAnywhereIsCutInHalfSquares) {
  const Mesh grid = testing::grid(9, 6);
  const Eigen::Vector3d up(0, 0, 1);
  for (const Eigen::Vector3d& sensor : {Eigen::Vector3d(4, 2.5, 20), Eigen::Vector3d(-11, 7, 13),
                                        Eigen::Vector3d(1, 2, -30), Eigen::Vector3d(3, -40, 29)})
    for (const ViewOptions& options : {seen_from(sensor), seen_along(Eigen::Vector3d(4, 2.5, 0) - sensor)}) {
      const ViewTriangulation view = triangulate_view(grid.vertices, 1, options);
      EXPECT_EQ(view.triangles.rows(), 2 * 8 * 5);
      EXPECT_EQ(view.dropped_long + view.dropped_grazing + view.hidden, 0);
      for (Eigen::Index face = 0; face < view.triangles.rows(); ++face)
        EXPECT_NEAR(normal_of(grid.vertices, view.triangles, face).dot(up), sensor.z() > 0 ? 1 : -1, 1e-12);
    }
}

// What is under test, written again without its tricks: images in the plane across the ray to the mean.
std::vector<Eigen::Vector2d> images_of(const Points& points, const ViewOptions& options) {
  const Eigen::Vector3d mean = points.colwise().mean();
  const Eigen::Vector3d d = options.direction.value_or(mean - options.sensor).normalized();
  const Eigen::Vector3d right = d.cross(Eigen::Vector3d(0.1, 0.8, 0.3)).normalized(), up = right.cross(d);
  std::vector<Eigen::Vector2d> images;
  for (const auto& row : points.rowwise()) {
    const Eigen::Vector3d x = row.transpose();
    if (options.direction)
      images.emplace_back(x.dot(right), x.dot(up));
    else
      images.push_back(Eigen::Vector2d((x - options.sensor).dot(right), (x - options.sensor).dot(up)) /
                       (x - options.sensor).dot(d));
  }
  return images;
}

double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

double angle_at(const Eigen::Vector2d& at, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::abs(std::atan2(turn(at, a, b), (a - at).dot(b - at)));
}

/// How far p is inside the circle through a, b, c (counter-clockwise), as an angle: of the two seen from either side of
/// the edge that parts p from the triangle, what exceeds a half turn.
double intrusion(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                 const Eigen::Vector2d& p) {
  double most = -kPi;
  bool inside = true;
  for (const auto& [from, to, across] : {std::array{a, b, c}, std::array{b, c, a}, std::array{c, a, b}})
    if (turn(from, to, p) < 0) {
      inside = false;
      most = std::max(most, angle_at(across, from, to) + angle_at(p, from, to) - kPi);
    }
  return inside ? kPi : most;
}

int hull_size(const std::vector<Eigen::Vector2d>& images) {
  int count = 0;
  for (const Eigen::Vector2d& a : images)
    for (const Eigen::Vector2d& b : images)
      count += &a != &b && std::none_of(images.begin(), images.end(), [&](const auto& p) { return turn(a, b, p) < 0; });
  return count;
}

TEST(TriangulateView, CirclesInTheImageAreEmptyAndTheHullIsFull) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    RandomStream random(seed);
    const Eigen::Vector3d side = (random.direction() + Eigen::Vector3d(0, 0, 1.5)).normalized();
    for (const ViewOptions& options : {seen_from(12 * side), seen_along(-side)}) {
      const Points points = rough_view(70, seed);
      const Triangles found = triangulate_view(points, 0.5, unlimited(options)).triangles;
      const auto images = images_of(points, options);
      EXPECT_EQ(found.rows(), 2 * 70 - 2 - hull_size(images));
      double most = -kPi;
      for (const auto& row : found.rowwise())
        for (int p = 0; p < 70; ++p) {
          const auto at = [&](int vertex) { return images[static_cast<std::size_t>(vertex)]; };
          if (p != row(0) && p != row(1) && p != row(2))
            most = std::max(most, intrusion(at(row(0)), at(row(1)), at(row(2)), at(p)));
        }
      EXPECT_LT(most, 1e-4) << seed;
      EXPECT_GT(most, -1) << "no circle is near a point: the measure is broken";
    }
  }
}

TEST(TriangulateView, AJumpInDepthIsCut) {
  Points points = testing::grid(20, 10).vertices;
  for (Eigen::Index row = 0; row < points.rows(); ++row) points(row, 2) = points(row, 0) < 10 ? 0 : -8;
  for (const ViewOptions& options : {seen_along({0, 0, -1}), seen_from({9.5, 4.5, 1e5})}) {
    const ViewTriangulation view = triangulate_view(points, 1, options);
    EXPECT_EQ(view.triangles.rows(), 2 * (2 * 9 * 9));
    // In perspective the lower rim lies inside the hull, and long triangles fill what is between.
    EXPECT_EQ(view.dropped_long, options.direction ? 2 * 9 : 2 * 9 + 2 * 9);
    EXPECT_EQ(view.dropped_grazing, 0);
    for (Eigen::Index face = 0; face < view.triangles.rows(); ++face)
      EXPECT_EQ(points(view.triangles(face, 0), 2) + points(view.triangles(face, 1), 2),
                2 * points(view.triangles(face, 2), 2));
  }
}

TEST(TriangulateView, TheLongestEdgeIsInclusiveAndInPr) {
  const Points points = points_of({{0, 0, 0}, {3, 0, 0}, {0, 4, 0}});
  ViewOptions options = seen_along({0, 0, -1});
  for (const double resolution : {1.0, 0.25}) {
    options.longest_edge_pr = 5 / resolution;
    EXPECT_EQ(triangulate_view(points, resolution, options).triangles.rows(), 1);
    options.longest_edge_pr *= 1 - 1e-12;
    const ViewTriangulation cut = triangulate_view(points, resolution, options);
    EXPECT_EQ(cut.triangles.rows(), 0);
    EXPECT_EQ(cut.dropped_long, 1);
  }
}

TEST(TriangulateView, ASlopeIsDroppedAtTheGrazingAngle) {
  for (const double tilt_deg : {30.0, 79.9, 80.1, 89.0}) {
    const double c = std::cos(tilt_deg * kPi / 180), s = std::sin(tilt_deg * kPi / 180);
    const Points points = points_of({{0, 0, 0}, {c, 0, s}, {0, 1, 0}});
    for (const ViewOptions& options : {seen_along({0, 0, -7}), seen_from({0, 0, 1e6})}) {
      const ViewTriangulation view = triangulate_view(points, 1, options);
      EXPECT_EQ(view.triangles.rows(), tilt_deg < 80 ? 1 : 0) << tilt_deg;
      EXPECT_EQ(view.dropped_grazing, tilt_deg < 80 ? 0 : 1) << tilt_deg;
    }
  }
}

TEST(TriangulateView, TheGrazingAngleIsThatOfTheRayNotOfTheAxis) {
  // Two small triangles on the floor, ten steps to either side below a sensor of height 1: seen at 84 degrees.
  const Points points =
      points_of({{-10.1, -0.1, 0}, {-9.9, -0.1, 0}, {-10, 0.2, 0}, {10.1, 0.1, 0}, {9.9, 0.1, 0}, {10, -0.2, 0}});
  ViewOptions options = seen_from({0, 0, 1});
  EXPECT_EQ(triangulate_view(points, 0.2, options).dropped_grazing, 2);
  EXPECT_EQ(triangulate_view(points, 0.2, options).triangles.rows(), 0);
  options.grazing_deg = 85;
  EXPECT_EQ(triangulate_view(points, 0.2, options).triangles.rows(), 2);
  EXPECT_EQ(triangulate_view(points, 0.2, seen_along({0, 0, -1})).triangles.rows(), 2);
}

TEST(TriangulateView, AHalfSphereKeepsItsNormalsAndLosesItsRim) {
  const Points sphere = testing::icosphere(4).vertices;
  const Eigen::Vector3d sensor(0.5, -4, 3);
  Indices seen;
  for (int row = 0; row < sphere.rows(); ++row)
    if (sphere.row(row).dot(sensor.transpose() - sphere.row(row)) > 0) seen.push_back(row);
  const Points points = sphere(seen, Eigen::all);
  const ViewTriangulation view = triangulate_view(points, 0.06, seen_from(sensor));
  EXPECT_GT(view.dropped_grazing, 20);
  EXPECT_GT(view.triangles.rows(), 1.5 * static_cast<double>(points.rows()));
  for (Eigen::Index face = 0; face < view.triangles.rows(); ++face) {
    const Eigen::Vector3d normal = normal_of(points, view.triangles, face);
    const Eigen::Vector3d middle = middle_of(points, view.triangles, face);
    const Eigen::Vector3d ray = (sensor - middle).normalized();
    EXPECT_GT(normal.dot(ray), std::cos(80 * kPi / 180));
    // Where the surface is seen flat, what is round in the image is long on the surface.
    const double within_deg = middle.normalized().dot(ray) > 0.5 ? 4 : 40;
    EXPECT_GT(normal.dot(middle.normalized()), std::cos(within_deg * kPi / 180));
  }
}

}  // namespace
}  // namespace corral
