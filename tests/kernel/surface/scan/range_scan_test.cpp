// SPDX-License-Identifier: MIT
// The virtual range scanner: every point where its truth says, areas as in closed form and as dense sampling finds them.
#include "kernel/surface/scan/range_scan.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/error.h"
#include "kernel/random.h"
#include "kernel/surface/scan/visibility.h"
#include "kernel/surface/search/resolution.h"
#include "tests/support/execution.h"
#include "tests/support/scanned.h"

namespace corral {
namespace {

using testing::bumpy_sphere;
using testing::icosphere;
using testing::looking_at;
using testing::shift;
using testing::with_spacing;

constexpr double kPi = 3.14159265358979323846;

void expect_same(const RangeScan& a, const RangeScan& b) {
  EXPECT_TRUE(a.points.rows() == b.points.rows() && a.points == b.points);
  EXPECT_EQ(a.surfaces, b.surfaces);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.image_rows, b.image_rows);
  EXPECT_EQ(a.image_columns, b.image_columns);
  EXPECT_EQ(a.patch_areas, b.patch_areas);
}

/// Distance of a point to the plane of a triangle, and how far outside the triangle it is at the most.
double off_triangle(const Mesh& mesh, int face, const Eigen::Vector3d& point) {
  const Eigen::Vector3d corners[] = {mesh.vertices.row(mesh.triangles(face, 0)),
                                     mesh.vertices.row(mesh.triangles(face, 1)),
                                     mesh.vertices.row(mesh.triangles(face, 2))};
  const Eigen::Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  double off = std::abs(normal.dot(point - corners[0]));
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d inwards = normal.cross(corners[(i + 1) % 3] - corners[i]).normalized();
    off = std::max(off, -inwards.dot(point - corners[i]));
  }
  return off;
}

/// Two bumpy balls of which the near one hides a part of the far one.
struct HalfHidden {
  SurfaceTree near_ball{bumpy_sphere(4, 1)}, far_ball{bumpy_sphere(4, 2)};
  RandomStream random{3};
  PosedSurfaces scene{{&near_ball, {random.rotation(), {0, -2, 0}}}, {&far_ball, {random.rotation(), {0.6, 1, 0}}}};
  RangeSensor sensor = looking_at({0, 0, 0}, {0, -15, 2});
};

TEST(RangeScan, ThePoseThatGoesInComesOut) {
  const HalfHidden world;
  const RangeScan scan = scan_range(world.scene, world.sensor, with_spacing(0.03));
  ASSERT_GT(scan.points.rows(), 5000);
  for (std::size_t i = 0; i < scan.surfaces.size(); ++i) {
    const PosedSurface& posed = world.scene[static_cast<std::size_t>(scan.surfaces[i])];
    const RigidTransform sensor_from_mesh = scan.sensor_from_world * posed.world_from_mesh;
    const Eigen::Vector3d point = scan.points.row(static_cast<Eigen::Index>(i)).transpose();
    ASSERT_LT(off_triangle(posed.surface->mesh(), scan.triangles[i], sensor_from_mesh.inverse() * point), 1e-12 * 15);
  }
  EXPECT_GT(std::count(scan.surfaces.begin(), scan.surfaces.end(), 0), 1000);
  EXPECT_GT(std::count(scan.surfaces.begin(), scan.surfaces.end(), 1), 500);
}

TEST(RangeScan, TheFrameIsThatOfTheSensor) {
  const SurfaceTree ball(icosphere(3));
  const RangeSensor sensor = looking_at({0, 0, 0}, {7, 0, 1});
  const RangeScan scan = scan_range({{&ball, {}}}, sensor, with_spacing(0.05));
  EXPECT_LT((scan.sensor_from_world * sensor.position).norm(), 1e-14);
  EXPECT_TRUE(is_rotation(scan.sensor_from_world.rotation, 1e-14));
  const Eigen::Vector3d target = scan.sensor_from_world * sensor.target;
  EXPECT_NEAR(target.z(), -std::sqrt(50.0), 1e-12);
  EXPECT_LT(target.head(2).norm(), 1e-12);
  EXPECT_GT((scan.sensor_from_world.rotation * sensor.up).y(), 0.9);
  EXPECT_LT(scan.points.col(2).maxCoeff(), 0);
  // From the top to the bottom, from the left to the right.
  for (Eigen::Index i = 1; i < scan.points.rows(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    ASSERT_LT(std::make_pair(scan.image_rows[at - 1], scan.image_columns[at - 1]),
              std::make_pair(scan.image_rows[at], scan.image_columns[at]));
    const double step = 0.05 / std::sqrt(50.0);
    ASSERT_NEAR(scan.points(i, 0) / -scan.points(i, 2), step * scan.image_columns[at], 1e-12);
    ASSERT_NEAR(scan.points(i, 1) / -scan.points(i, 2), -step * scan.image_rows[at], 1e-12);
  }
}

/// Of a ball of radius 1 seen from `distance`, what is met at most `grazing` off its normals.
double cap_area(double distance, double grazing) {
  return 2 * kPi * (1 - std::cos(grazing - std::asin(std::sin(grazing) / distance)));
}

TEST(RangeScan, AreaOfABallIsThatOfItsCap) {
  const SurfaceTree ball(icosphere(6));
  for (const double distance : {3.0, 20.0})
    for (const double grazing : {40.0, 60.0, 80.0}) {
      RangeScanOptions options = with_spacing(0.02);
      options.grazing_deg = grazing;
      const RangeScan scan = scan_range({{&ball, {}}}, looking_at({0, 0, 0}, {0, -distance, 0}), options);
      const double expected = cap_area(distance, grazing * kPi / 180);
      // The mesh of the ball has edges of a degree, which make the rim of the cap a little uneven.
      EXPECT_NEAR(scan.patch_areas[0], expected, 0.01 * expected) << distance << " " << grazing;
    }
}

/// Occlusion and clutter by random points of the surfaces, each asked whether the sensor sees it.
std::vector<Visibility> sampled_visibility(const HalfHidden& world, int samples, double grazing_deg) {
  RandomStream random(4);
  std::vector<double> seen, area;
  for (const PosedSurface& posed : world.scene) {
    const Mesh mesh = move_mesh(posed.surface->mesh(), posed.world_from_mesh);
    std::vector<double> sums;
    for (Eigen::Index face = 0; face < mesh.triangles.rows(); ++face)
      sums.push_back((sums.empty() ? 0 : sums.back()) + triangle_area(mesh.vertices.row(mesh.triangles(face, 0)),
                                                                      mesh.vertices.row(mesh.triangles(face, 1)),
                                                                      mesh.vertices.row(mesh.triangles(face, 2))));
    int visible = 0;
    for (int i = 0; i < samples; ++i) {
      const double at = random.uniform(0, sums.back());
      const auto face = std::upper_bound(sums.begin(), sums.end(), at) - sums.begin();
      const Eigen::Vector3d a = mesh.vertices.row(mesh.triangles(face, 0)),
                            b = mesh.vertices.row(mesh.triangles(face, 1)),
                            c = mesh.vertices.row(mesh.triangles(face, 2));
      double u = random.uniform(), v = random.uniform();
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Eigen::Vector3d point = a + u * (b - a) + v * (c - a), way = point - world.sensor.position;
      const Eigen::Vector3d ray = way.normalized();
      bool hidden = std::abs((b - a).cross(c - a).normalized().dot(ray)) < std::cos(grazing_deg * kPi / 180);
      for (const PosedSurface& other : world.scene) {
        const RigidTransform from_world = other.world_from_mesh.inverse();
        const auto hit = other.surface->first_hit(from_world * world.sensor.position, from_world.rotation * ray);
        hidden = hidden || (hit && hit->distance < way.norm() - 1e-9);
      }
      visible += !hidden;
    }
    area.push_back(sums.back());
    seen.push_back(sums.back() * visible / samples);
  }
  const double whole = seen[0] + seen[1];
  return {{1 - seen[0] / area[0], 1 - seen[0] / whole}, {1 - seen[1] / area[1], 1 - seen[1] / whole}};
}

TEST(RangeScan, OcclusionAndClutterAgreeWithDenseSamplingWithinAPoint) {
  const HalfHidden world;
  for (const double grazing : {60.0, 80.0}) {
    RangeScanOptions options = with_spacing(0.03);
    options.grazing_deg = grazing;
    const RangeScan scan = scan_range(world.scene, world.sensor, options);
    const auto measured = measure_visibility(world.scene, scan), sampled = sampled_visibility(world, 30000, grazing);
    for (int i = 0; i < 2; ++i) {
      const auto at = static_cast<std::size_t>(i);
      EXPECT_NEAR(measured[at].occlusion, sampled[at].occlusion, 0.01) << i << " at " << grazing;
      EXPECT_NEAR(measured[at].clutter, sampled[at].clutter, 0.01) << i << " at " << grazing;
    }
    EXPECT_GT(measured[1].occlusion, measured[0].occlusion + 0.1) << "the far one is hidden by the near one";
    EXPECT_NEAR(measured[0].clutter + measured[1].clutter, 1, 1e-12);
  }
}

TEST(RangeScan, WhatIsMetTooFlatSendsNothingBack) {
  const HalfHidden world;
  RangeScanOptions all = with_spacing(0.05), few = all;
  all.grazing_deg = 90, few.grazing_deg = 40;
  const RangeScan whole = scan_range(world.scene, world.sensor, all), part = scan_range(world.scene, world.sensor, few);
  Eigen::Index next = 0;
  for (std::size_t i = 0; i < whole.surfaces.size(); ++i) {
    const PosedSurface& posed = world.scene[static_cast<std::size_t>(whole.surfaces[i])];
    const Mesh& mesh = posed.surface->mesh();
    const Eigen::Vector3d a = mesh.vertices.row(mesh.triangles(whole.triangles[i], 0)),
                          b = mesh.vertices.row(mesh.triangles(whole.triangles[i], 1)),
                          c = mesh.vertices.row(mesh.triangles(whole.triangles[i], 2));
    const Eigen::Vector3d ray = whole.points.row(static_cast<Eigen::Index>(i)).transpose().normalized();
    const RigidTransform sensor_from_mesh = whole.sensor_from_world * posed.world_from_mesh;
    const double angle =
        std::acos(std::abs((sensor_from_mesh.rotation * (b - a).cross(c - a)).normalized().dot(ray))) * 180 / kPi;
    if (angle > 40 + 1e-9) continue;
    ASSERT_LT(next, part.points.rows());
    ASSERT_EQ(part.points.row(next++), whole.points.row(static_cast<Eigen::Index>(i)));
  }
  EXPECT_EQ(next, part.points.rows());
  EXPECT_LT(next, whole.points.rows() * 2 / 3);
}

TEST(RangeScan, NoiseIsAlongTheRays) {
  const HalfHidden world;
  RangeScanOptions options = with_spacing(0.03);
  const RangeScan clean = scan_range(world.scene, world.sensor, options);
  options.noise = 0.01;
  const RangeScan noisy = scan_range(world.scene, world.sensor, options);
  ASSERT_EQ(noisy.points.rows(), clean.points.rows());
  const Eigen::VectorXd before = clean.points.rowwise().norm(), after = noisy.points.rowwise().norm();
  EXPECT_LT((clean.points.array().colwise() / before.array() - noisy.points.array().colwise() / after.array())
                .abs()
                .maxCoeff(),
            1e-14);
  const Eigen::VectorXd off = after - before;
  EXPECT_NEAR(off.mean(), 0, 0.0005);
  EXPECT_NEAR(std::sqrt(off.squaredNorm() / static_cast<double>(off.size())), 0.01, 0.0005);
  EXPECT_EQ(noisy.patch_areas, clean.patch_areas);
  options.seed = 2;
  EXPECT_NE(scan_range(world.scene, world.sensor, options).points, noisy.points);
}

TEST(RangeScan, TheSameOnAnyThreads) {
  const HalfHidden world;
  RangeScanOptions options = with_spacing(0.05);
  options.noise = 0.01;
  const RangeScan expected = scan_range(world.scene, world.sensor, options);
  expect_same(scan_range(world.scene, world.sensor, options, testing::last_first), expected);
  expect_same(scan_range(world.scene, world.sensor, options, testing::on_three_threads), expected);
}

TEST(RangeScan, ResolutionIsThatOfTheRays) {
  const SurfaceTree ball(bumpy_sphere(4, 5));
  for (const double spacing : {0.02, 0.05}) {
    const RangeScan scan = scan_range({{&ball, {}}}, ring_sensor(ball.mesh(), 0, 8), with_spacing(spacing));
    EXPECT_NEAR(point_resolution(scan.points) / spacing, kScanResolution, 0.08);
  }
}

TEST(RangeScan, FacesLookAtTheSensorAndSpanNoJump) {
  const HalfHidden world;
  const RangeScan scan = scan_range(world.scene, world.sensor, with_spacing(0.03));
  const Mesh view = triangulated(scan);
  EXPECT_EQ(view.vertices, scan.points);
  EXPECT_GT(view.triangles.rows(), 1.7 * static_cast<double>(scan.points.rows()));
  int mixed = 0;
  for (Eigen::Index face = 0; face < view.triangles.rows(); ++face) {
    const Eigen::Vector3d a = view.vertices.row(view.triangles(face, 0)),
                          b = view.vertices.row(view.triangles(face, 1)),
                          c = view.vertices.row(view.triangles(face, 2));
    ASSERT_LT((b - a).cross(c - a).dot(a), 0);
    const auto surface = [&](int i) { return scan.surfaces[static_cast<std::size_t>(view.triangles(face, i))]; };
    mixed += surface(0) != surface(1) || surface(0) != surface(2);
  }
  EXPECT_LT(mixed, 5);
}

TEST(RangeScan, NeighboursOnTheRingOverlap) {
  const Mesh mesh = bumpy_sphere(4, 6);
  const SurfaceTree ball(mesh);
  std::vector<RangeScan> views;
  for (int i = 0; i < 16; ++i) views.push_back(scan_range({{&ball, {}}}, ring_sensor(mesh, i, 16), with_spacing(0.05)));
  const auto overlap = [&](std::size_t i, std::size_t steps) {
    const RangeScan &source = views[i], &target = views[(i + steps) % 16];
    const RigidTransform truth = target.sensor_from_world * source.sensor_from_world.inverse();
    return overlap_share(source.points, target.points, truth, 0.11);
  };
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_GT(overlap(i, 1), 0.7) << i;
    EXPECT_LT(overlap(i, 1), 0.97) << i;
    EXPECT_GT(overlap(i, 3), 0.4) << i;
    EXPECT_LT(overlap(i, 3), 0.7) << i;
    EXPECT_LT(overlap(i, 8), 0.3) << i << ": the other side";
  }
  EXPECT_THROW(ring_sensor(mesh, 8, 8), InvalidInput);
  EXPECT_THROW(ring_sensor(mesh, -1, 8), InvalidInput);
}

TEST(RangeScan, LooksStraightDownToo) {
  const SurfaceTree ball(icosphere(2));
  const RangeScan scan = scan_range({{&ball, {}}}, looking_at({0, 0, 0}, {0, 0, 5}), with_spacing(0.1));
  EXPECT_TRUE(is_rotation(scan.sensor_from_world.rotation, 1e-14));
  EXPECT_NEAR(scan.points.col(2).maxCoeff(), -4, 0.01);
}

TEST(RangeScan, RefusesWhatItCannotScan) {
  const SurfaceTree ball(icosphere(2));
  const PosedSurfaces scene{{&ball, {}}, {&ball, shift(3, 0, 0)}};
  const RangeSensor sensor = looking_at({0, 0, 0}, {0, -9, 0});
  const auto expect_refused = [&](const PosedSurfaces& surfaces, const RangeSensor& from, const RangeScanOptions& how) {
    EXPECT_THROW(scan_range(surfaces, from, how), InvalidInput);
  };
  expect_refused({}, sensor, with_spacing(0.1));
  expect_refused(scene, looking_at({0, 0, 0}, {0, 0, 0}), with_spacing(0.1));
  expect_refused(scene, looking_at({0, 0, 0}, {3, 0.5, 0}), with_spacing(0.1));  // within the second one
  expect_refused(scene, sensor, with_spacing(1e-5));                             // too many rays
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    expect_refused(scene, sensor, with_spacing(bad));
    RangeScanOptions options = with_spacing(0.1);
    options.grazing_deg = bad;
    expect_refused(scene, sensor, options);
    options = with_spacing(0.1);
    options.noise = bad == 0 ? -1 : bad;
    expect_refused(scene, sensor, options);
    expect_refused(scene, looking_at({0, 0, 0}, {0, std::numeric_limits<double>::quiet_NaN(), bad}), with_spacing(0.1));
  }
}

}  // namespace
}  // namespace corral
