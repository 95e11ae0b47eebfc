// SPDX-License-Identifier: MIT
// corral triangulate as a user types it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "kernel/surface/scan/view_triangulation.h"
#include "kernel/surface/search/resolution.h"
#include "tests/support/program.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Outcome;
using testing::Workplace;

/// 10 x 8 points at depth -50 below a sensor at the origin, the right half a step of 9 behind.
Mesh stepped_view() {
  Mesh view{testing::grid(10, 8).vertices, Triangles(0, 3)};
  view.vertices.col(2).setConstant(-50);
  for (Eigen::Index row = 0; row < view.vertices.rows(); ++row)
    if (view.vertices(row, 0) > 4.5) view.vertices.row(row) *= 59.0 / 50;
  return view;
}

TEST(Triangulate, GivesAViewFacesAndTellsWhatItDropped) {
  const Workplace place;
  const Mesh view = stepped_view();
  write_mesh(place / "view.ply", view);
  const Outcome outcome = place.corral("triangulate view.ply -o faces.ply");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, "faces.ply: 112 faces kept, 14 long and 0 grazing ones dropped, 0 points hidden\n");
  const Mesh made = read_mesh(place / "faces.ply");
  EXPECT_EQ(made.vertices, view.vertices);
  EXPECT_EQ(made.triangles, triangulate_view(view.vertices, point_resolution(view.vertices)).triangles);
  EXPECT_EQ(place.corral("triangulate view.ply -o again.ply").status, 0);
  EXPECT_EQ(place.text("faces.ply"), place.text("again.ply"));
}

TEST(Triangulate, OptionsReachTheTriangulation) {
  const Workplace place;
  write_mesh(place / "view.ply", stepped_view());
  const auto report = [&](const std::string& options) {
    return place.corral("triangulate view.ply -o faces.ply --json " + options).json();
  };
  const auto usual = report("");
  EXPECT_THAT(testing::keys_of(usual),
              ElementsAre("direction", "dropped_grazing", "dropped_long", "faces", "grazing_deg", "hidden",
                          "longest_edge_pr", "replaced_faces", "resolution", "sensor", "vertices"));
  EXPECT_EQ(usual["vertices"], 80);
  EXPECT_EQ(usual["faces"], 112);
  EXPECT_EQ(usual["dropped_long"], 14);
  EXPECT_EQ(usual["sensor"], nlohmann::json::parse("[0.0, 0.0, 0.0]"));
  EXPECT_TRUE(usual["direction"].is_null());
  EXPECT_EQ(usual["resolution"], point_resolution(stepped_view().vertices));
  EXPECT_EQ(usual["longest_edge_pr"], 6);
  EXPECT_EQ(usual["grazing_deg"], 80);
  EXPECT_EQ(report("--longest-edge-pr 12")["dropped_grazing"], 14) << "as steep as it is long";
  EXPECT_EQ(report("--longest-edge-pr 12 --grazing-deg 90")["faces"], 126);
  const auto moved = report("--sensor -1,2.5,1e3");
  EXPECT_EQ(moved["sensor"], nlohmann::json::parse("[-1.0, 2.5, 1000.0]"));
  EXPECT_EQ(read_mesh(place / "faces.ply").triangles.rows(), moved["faces"]);
  const auto parallel = report("--direction 0,0.5,-2");
  EXPECT_TRUE(parallel["sensor"].is_null());
  EXPECT_EQ(parallel["direction"], nlohmann::json::parse("[0.0, 0.5, -2.0]"));
  EXPECT_EQ(report("--direction 0,0,1")["faces"], report("--direction 0,0,-1")["faces"]);
}

TEST(Triangulate, TheSideOfTheSensorIsThatOfTheNormals) {
  const Workplace place;
  write_mesh(place / "flat.ply", Mesh{testing::grid(5, 5).vertices, Triangles(0, 3)});
  for (const auto& [options, side] : {std::pair{"--direction 0,0,-1", 1},
                                      {"--direction 0,0,1", -1},
                                      {"--sensor 2,2,9", 1},
                                      {"--sensor 2,2,-9", -1}}) {
    ASSERT_EQ(place.corral("triangulate flat.ply -o faces.ply " + std::string(options)).status, 0);
    const Points normals = area_weighted_normals(read_mesh(place / "faces.ply"));
    EXPECT_GT((normals.col(2) * side).minCoeff(), 0) << options;
  }
}

TEST(Triangulate, SaysThatItReplacesFaces) {
  const Workplace place;
  write_mesh(place / "grid.ply", testing::grid(6, 4));
  const Outcome outcome = place.corral("triangulate grid.ply --direction 0,0,-1 -o faced.ply --json");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, HasSubstr("note: 30 faces of grid.ply are replaced\n"));
  EXPECT_EQ(outcome.json()["replaced_faces"], 30);
  EXPECT_EQ(read_mesh(place / "faced.ply").triangles.rows(), 30);
}

TEST(Triangulate, HintsAtASensorThatWasElsewhere) {
  const Workplace place;
  Mesh ball = testing::icosphere(3);
  ball.triangles.resize(0, 3);
  write_mesh(place / "ball.ply", ball);
  EXPECT_THAT(place.corral("triangulate ball.ply --sensor 0,0,5 -o faces.ply").err, HasSubstr("\nhint: so many"));
  write_mesh(place / "view.ply", stepped_view());
  EXPECT_THAT(place.corral("triangulate view.ply -o faces.ply").err, Not(HasSubstr("hint")));
}

TEST(Triangulate, RefusesASensorAmongThePoints) {
  const Workplace place;
  write_mesh(place / "ball.ply", testing::icosphere(2));
  const Outcome outcome = place.corral("triangulate ball.ply --sensor 0.5,0,0 -o faces.ply");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_EQ(testing::lines_in(outcome.err), 1U);
  EXPECT_THAT(outcome.err, HasSubstr("points not in front of it, expected"));
  EXPECT_THAT(outcome.err, HasSubstr("--sensor"));
  EXPECT_THAT(place.names(), ElementsAre("ball.ply"));
}

TEST(Triangulate, RefusesWhatIsNoVectorAngleOrLength) {
  const Workplace place;
  write_mesh(place / "view.ply", stepped_view());
  const auto expect_usage = [&](const std::string& options, const std::string& says) {
    const Outcome outcome = place.corral("triangulate view.ply -o faces.ply " + options);
    EXPECT_EQ(outcome.status, 2) << options;
    EXPECT_EQ(outcome.out, "") << options;
    EXPECT_THAT(outcome.err, HasSubstr(says));
  };
  for (const char* bad : {"1,2", "1,2,3,4", "1,2,x", "1,nan,3", "1,2,inf", "''", "1,,3", "1,2,"}) {
    expect_usage("--sensor " + std::string(bad), "--sensor: found '");
    expect_usage("--direction " + std::string(bad), "--direction: found '");
  }
  expect_usage("--direction 0,0,0", "--direction: expected a vector that is not zero");
  expect_usage("--direction 0,0,1 --sensor 0,0,1", "excludes");
  for (const char* bad : {"0", "-1", "nan", "inf", "x"}) {
    expect_usage("--longest-edge-pr " + std::string(bad), "--longest-edge-pr");
    expect_usage("--grazing-deg " + std::string(bad), "--grazing-deg");
  }
  expect_usage("--grazing-deg 91", "--grazing-deg");
  EXPECT_EQ(place.corral("triangulate view.ply").status, 2);
  EXPECT_EQ(place.corral("triangulate view.ply -o faces.off").status, 3);
  EXPECT_THAT(place.names(), ElementsAre("view.ply"));
}

TEST(Triangulate, InfoTellsACloudOfIt) {
  const Workplace place;
  write_mesh(place / "view.ply", stepped_view());
  EXPECT_THAT(place.corral("info view.ply").out, HasSubstr("'corral triangulate' gives faces to a range scan"));
}

}  // namespace
}  // namespace corral
