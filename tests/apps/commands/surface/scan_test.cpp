// SPDX-License-Identifier: MIT
// corral scan as a user types it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "kernel/surface/scan/range_scan.h"
#include "kernel/surface/search/resolution.h"
#include "tests/support/program.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::Workplace;

Workplace& with_ball(Workplace& place) {
  write_mesh(place / "ball.ply", testing::bumpy_sphere(4, 1));
  return place;
}

TEST(Scan, WritesTheViewAndItsPose) {
  Workplace place;
  with_ball(place);
  const Outcome outcome = place.corral("scan ball.ply -o view.ply --truth truth.txt --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto said = outcome.json();
  EXPECT_THAT(testing::keys_of(said),
              ElementsAre("faces", "mesh_resolution", "occlusion", "vertices", "view_from_mesh", "view_resolution"));
  const Mesh mesh = read_mesh(place / "ball.ply"), view = read_mesh(place / "view.ply");
  EXPECT_EQ(view.vertices.rows(), said["vertices"]);
  EXPECT_EQ(view.triangles.rows(), said["faces"]);
  EXPECT_NEAR(said["view_resolution"].get<double>() / said["mesh_resolution"].get<double>(), 1, 0.1);
  EXPECT_GT(said["occlusion"], 0.5);
  EXPECT_LT(said["occlusion"], 0.75);
  const RigidTransform truth = read_transform(place / "truth.txt");
  EXPECT_EQ(truth.translation, ring_sensor(mesh, 0, 8).sensor_from_world().translation);
  // Back in the frame of the mesh every point lies on it, also after a way through the files.
  const SurfaceTree surface(mesh);
  const Eigen::Vector3d sensor = truth.inverse() * Eigen::Vector3d::Zero();
  const Points back = truth.inverse().apply(view.vertices);
  for (Eigen::Index row = 0; row < back.rows(); ++row) {
    const Eigen::Vector3d way = back.row(row).transpose() - sensor;
    const auto hit = surface.first_hit(sensor, way.normalized());
    ASSERT_TRUE(hit);
    ASSERT_NEAR(hit->distance, way.norm(), 1e-9);
  }
  EXPECT_THAT(outcome.err, HasSubstr("view.ply: " + std::to_string(view.vertices.rows()) + " points, "));
}

TEST(Scan, TheSameBytesOnAnyThreads) {
  Workplace place;
  with_ball(place);
  ASSERT_EQ(place.corral("scan ball.ply -o one.ply --noise-pr 0.2 --threads 1").status, 0);
  ASSERT_EQ(place.corral("scan ball.ply -o three.ply --noise-pr 0.2 --threads 3").status, 0);
  ASSERT_EQ(place.corral("scan ball.ply -o other.ply --noise-pr 0.2 --seed 2").status, 0);
  EXPECT_EQ(place.text("one.ply"), place.text("three.ply"));
  EXPECT_NE(place.text("one.ply"), place.text("other.ply"));
}

TEST(Scan, OptionsReachTheScanner) {
  Workplace place;
  with_ball(place);
  const auto report = [&](const std::string& options) {
    return place.corral("scan ball.ply -o view.ply --json " + options).json();
  };
  const auto usual = report("");
  EXPECT_EQ(report("--view 1/8"), usual);
  EXPECT_NE(report("--view 2/8")["view_from_mesh"], usual["view_from_mesh"]);
  EXPECT_NEAR(report("--spacing-pr 2")["vertices"].get<double>() / usual["vertices"].get<double>(), 0.25, 0.02);
  EXPECT_GT(report("--grazing-deg 40")["occlusion"].get<double>(), usual["occlusion"].get<double>() + 0.1);
  EXPECT_EQ(report("--noise-pr 0.3")["vertices"], usual["vertices"]);
  const auto from = report("--from 0,-9,0.5");
  RangeSensor sensor;
  const Points& vertices = testing::bumpy_sphere(4, 1).vertices;
  const Eigen::Vector3d low = vertices.colwise().minCoeff(), high = vertices.colwise().maxCoeff();
  sensor.position = {0, -9, 0.5}, sensor.target = (low + high) / 2;
  EXPECT_EQ(from["view_from_mesh"][2][3], sensor.sensor_from_world().translation.z());
}

TEST(Scan, RefusesWhatMakesNoView) {
  Workplace place;
  with_ball(place);
  const auto expect = [&](int status, const std::string& options, const std::string& says) {
    const Outcome outcome = place.corral("scan " + options);
    EXPECT_EQ(outcome.status, status) << options;
    EXPECT_EQ(outcome.out, "") << options;
    EXPECT_THAT(outcome.err, HasSubstr(says)) << options;
  };
  for (const char* bad : {"0/8", "9/8", "1", "1/", "/8", "x/8", "1/8/2", "-1/8"})
    expect(2, "ball.ply -o view.ply --view " + std::string(bad), "--view: found '");
  for (const char* bad : {"1,2", "1,nan,3", "''"})
    expect(2, "ball.ply -o view.ply --from " + std::string(bad), "--from");
  for (const char* bad : {"0", "-1", "nan", "inf"})
    expect(2, "ball.ply -o view.ply --spacing-pr " + std::string(bad), "--spacing-pr");
  for (const char* bad : {"-1", "nan", "inf"})
    expect(2, "ball.ply -o view.ply --noise-pr " + std::string(bad), "--noise-pr");
  for (const char* bad : {"0", "91", "nan"})
    expect(2, "ball.ply -o view.ply --grazing-deg " + std::string(bad), "--grazing-deg");
  expect(2, "ball.ply -o view.ply --from 0,0,9 --view 1/8", "excludes");
  expect(2, "ball.ply -o view.ply --threads -1", "--threads");
  expect(3, "ball.ply -o view.off", "expected a name that ends in .ply");
  expect(3, "ball.ply -o view.ply --from 0,0,0.1", "not in front of it");
  expect(3, "ball.ply -o view.ply --spacing-pr 1e-6", "2^26 rays");
  write_mesh(place / "cloud.ply", Mesh{testing::grid(4, 4).vertices, Triangles(0, 3)});
  expect(3, "cloud.ply -o view.ply", "cloud.ply: has no faces");
  EXPECT_THAT(place.names(), ElementsAre("ball.ply", "cloud.ply"));
}

}  // namespace
}  // namespace corral
