// SPDX-License-Identifier: MIT
// corral info, as a user types it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/mesh/mesh_file.h"
#include "kernel/surface/search/resolution.h"
#include "tests/support/meshes.h"
#include "tests/support/program.h"

namespace corral {
namespace {

using ::testing::AllOf;
using testing::expect_ok;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::Outcome;
using ::testing::StartsWith;
using testing::Workplace;

TEST(Info, TellsWhatAMeshIs) {
  const Workplace place;
  write_mesh(place / "ball.ply", testing::icosphere(2));
  place.put("square.off", "OFF\n6 2 0\n0 0 0\n1 0 0\n1 2 0\n0 2 0\n0 2 0\n5 5 0\n3 0 1 2\n3 0 2 3\n");
  const Outcome outcome = place.corral("info --json ball.ply square.off");
  expect_ok(outcome);
  const auto list = outcome.json();
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0]["path"], "ball.ply");
  EXPECT_EQ(list[0]["vertices"], 162);
  EXPECT_EQ(list[0]["faces"], 320);
  EXPECT_EQ(list[0]["components"], 1);
  EXPECT_EQ(list[0]["boundary_edges"], 0);
  EXPECT_EQ(list[0]["resolution"], point_resolution(testing::icosphere(2).vertices));
  EXPECT_THAT(list[0]["warnings"], IsEmpty());
  EXPECT_EQ(list[1]["boundary_edges"], 4);
  EXPECT_EQ(list[1]["duplicates"], 1);
  EXPECT_EQ(list[1]["isolated"], 2);
  EXPECT_EQ(list[1]["extent"], nlohmann::json::parse("[5.0, 5.0, 0.0]"));
  EXPECT_EQ(list[1]["warnings"].size(), 2U);
  const Outcome text = place.corral("info ball.ply square.off");
  expect_ok(text);
  EXPECT_THAT(text.out, AllOf(StartsWith("ball.ply\n"), HasSubstr("\nsquare.off\n"), HasSubstr("warning")));
}

TEST(Info, WhatAMeshLacksIsNull) {
  const Workplace place;
  place.put("point.off", "OFF\n1 0 0\n1 2 3\n");
  place.put("none.off", "OFF\n0 0 0\n");
  const Outcome outcome = place.corral("info point.off none.off --json");
  expect_ok(outcome);
  for (const auto& mesh : outcome.json()) EXPECT_TRUE(mesh["resolution"].is_null());
}

TEST(Info, TellsOfTheOtherMeshesIfOneIsBad) {
  const Workplace place;
  write_mesh(place / "ball.ply", testing::icosphere(1));
  const Outcome outcome = place.corral("info missing.ply ball.ply --json");
  EXPECT_EQ(outcome.status, 4);
  EXPECT_EQ(outcome.err, "corral: missing.ply: does not exist\n");
  EXPECT_EQ(outcome.json()[0]["error"], "missing.ply: does not exist");
  EXPECT_EQ(outcome.json()[1]["vertices"], 42);
  EXPECT_EQ(place.corral("info missing.ply").status, 3);
}

TEST(Info, BoundaryLoopsAreAbsentWhereNoHalfEdgesHoldTheFaces) {
  const Workplace place;
  const std::string vertices = "OFF\n5 COUNT 0\n0 0 0\n1 0 0\n0 1 0\n0 -1 0\n0 0 1\n3 0 1 2\n3 1 0 3\n";
  place.put("sheet.off", std::string(vertices).replace(vertices.find("COUNT"), 5, "2"));
  place.put("fin.off", std::string(vertices).replace(vertices.find("COUNT"), 5, "3") + "3 0 1 4\n");
  EXPECT_THAT(place.corral("info sheet.off").out, HasSubstr("boundary    4 edges in 1 loops\n"));
  const std::string fin = place.corral("info fin.off").out;
  EXPECT_THAT(fin, HasSubstr("boundary    6 edges\n"));
  EXPECT_THAT(fin, HasSubstr("1 non-manifold edges"));
  EXPECT_THAT(fin, HasSubstr("1 faces that no half-edge structure can hold"));
  EXPECT_THAT(place.corral("info sheet.off").out, Not(HasSubstr("half-edge")));
  const auto about = place.corral("info --json sheet.off fin.off").json();
  EXPECT_EQ(about[0]["boundary_loops"], 1);
  EXPECT_TRUE(about[1]["boundary_loops"].is_null());
  EXPECT_EQ(about[1]["boundary_edges"], 6);
}

}  // namespace
}  // namespace corral
