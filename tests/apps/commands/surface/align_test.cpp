// SPDX-License-Identifier: MIT
// corral align as a user types it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <string>

#include "apps/align/alignment_files.h"
#include "io/text/csv_file.h"
#include "kernel/number_text.h"
#include "tests/support/object_views.h"
#include "tests/support/program.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ObjectViews;
using testing::Outcome;
using testing::Workplace;

/// a.ply, b.ply and c.txt, three neighbouring views.
ObjectViews put_views(const Workplace& place) {
  ObjectViews object = testing::object_views(9, 3);
  object.views.resize(3);
  write_mesh(place / "a.ply", object.views[0]);
  write_mesh(place / "b.ply", object.views[1]);
  std::string list;
  for (const auto& point : object.views[2].vertices.rowwise())
    list += to_text(point(0)) + "," + to_text(point(1)) + "," + to_text(point(2)) + "\n";
  place.put("c.txt", list);
  return object;
}

void put_poses(const Workplace& place, const ObjectViews& object) {
  RigidTransform wrong = object.between(0, 2);
  wrong.rotation = wrong.rotation * Eigen::AngleAxisd(2, Eigen::Vector3d::UnitZ());
  place.put("ab.xf", transform_text(object.between(0, 1)));
  place.put("bc.xf", transform_text(object.between(1, 2)));
  place.put("ac.xf", transform_text(wrong));
  place.put("poses.csv", "source,target,transform,weight\na,b,ab.xf,1\nb,c,bc.xf,2\na,c,ac.xf,1\n");
}

TEST(Align, WritesWhereEachViewIsAndWhatSpeaksForIt) {
  const Workplace place;
  const ObjectViews object = put_views(place);
  const Outcome outcome = place.corral("align a.ply b.ply c.txt -o out --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto report = outcome.json();
  EXPECT_THAT(testing::keys_of(report), ElementsAre("converged", "pairs", "views"));
  EXPECT_THAT(testing::keys_of(report["pairs"][0]),
              ElementsAre("closed_loops", "confidence", "error_pr", "in_front", "loops", "median_pr", "origin",
                          "overlap", "source", "target", "target_from_source", "verdict"));
  ASSERT_EQ(report["views"].size(), 3U);
  EXPECT_EQ(report["views"][2]["name"], "c");
  const RigidTransform c = read_transform(place / "out/c.xf"), truth = object.between(2, 0);
  EXPECT_TRUE(read_transform(place / "out/a.xf").rotation.isIdentity(0)) << "the first view is the world";
  EXPECT_TRUE(c.rotation.isApprox(truth.rotation, 0.02));
  EXPECT_LT((c.translation - truth.translation).norm(), 0.15);
  // What came out can be handed back.
  const Outcome again = place.corral("align a.ply b.ply c.txt --poses out/pairs.csv -o again");
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(place.text("again/c.xf"), place.text("out/c.xf"));
  EXPECT_THAT(again.out, HasSubstr("part 1 of 1: a b c\n"));
}

// The same views, each moved so that the origin lies behind its surface: what the faces tell is enough.
TEST(Align, WhereTheSensorStoodIsTakenFromTheFaces) {
  const Workplace place;
  put_views(place);
  for (const std::string name : {"a", "b"}) {
    ASSERT_EQ(place.corral("triangulate " + name + ".ply -o " + name + "-moved.ply").status, 0);
    Mesh view = read_mesh(place / (name + "-moved.ply"));
    view.vertices.col(2).array() -= 1.5 * view.vertices.col(2).minCoeff();
    write_mesh(place / (name + ".ply"), view);
  }
  const Outcome told = place.corral("align a.ply b.ply -o out");
  EXPECT_EQ(told.status, 0);
  EXPECT_THAT(told.err, HasSubstr("note: a.ply: the sensor looks along "));
  EXPECT_THAT(told.err, HasSubstr(", by the side of its faces or normals"));
  EXPECT_THAT(told.out, HasSubstr("part 1 of 1: a b\n"));
  const Outcome wrong = place.corral("align a.ply b.ply --direction 0,0,1 -o out");
  EXPECT_THAT(wrong.err, HasSubstr("warning: a.ply: the sensor sees the back of "));
  EXPECT_THAT(wrong.err, HasSubstr("hint: no two views were connected"));
}

TEST(Align, GivenPosesAreJudgedAndNothingElse) {
  const Workplace place;
  put_poses(place, put_views(place));
  const Outcome outcome = place.corral("align a.ply b.ply c.txt --poses poses.csv -o out");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("doubtful: a -> c, contradicts\n"));
  EXPECT_THAT(outcome.out, HasSubstr("doubtful: a -> b, unchecked\n")) << "only the wrong one leads there too";
  const CsvTable pairs = read_csv(place / "out/pairs.csv");
  ASSERT_EQ(pairs.rows.size(), 3U);
  EXPECT_EQ(pairs.rows[1][std::size_t(pairs.column("verdict"))], "contradicts");
  // A later, shorter list leaves no pose of the earlier one behind.
  place.put("poses.csv", "source,target,transform\na,b,ab.xf\n");
  const Outcome shorter = place.corral("align a.ply b.ply c.txt --poses poses.csv -o out");
  EXPECT_THAT(shorter.out, HasSubstr("part 1 of 2: a b\npart 2 of 2: c\n"));
  EXPECT_THAT(shorter.err, HasSubstr("the views form 2 unconnected parts"));
  EXPECT_FALSE(std::filesystem::exists(place / "out/poses/2.xf"));
}

TEST(Align, WhatIsWrongIsNamed) {
  const Workplace place;
  put_poses(place, put_views(place));
  const auto refusal = [&](const std::string& arguments, int status) {
    const Outcome outcome = place.corral("align " + arguments + " -o out");
    EXPECT_EQ(outcome.status, status) << arguments;
    return outcome.err;
  };
  EXPECT_THAT(refusal("a.ply", 2), HasSubstr("at least two views"));
  EXPECT_THAT(refusal("a.ply ./a.ply", 2), HasSubstr("two views are named 'a'"));
  EXPECT_THAT(refusal("a.ply b.ply --direction 0,0,0", 2), HasSubstr("--direction"));
  EXPECT_THAT(refusal("a.ply none.ply", 3), HasSubstr("none.ply"));
  EXPECT_THAT(refusal("a.ply b.ply --sensor 0,0,-8", 3), HasSubstr("in front of"));
  const std::string three = "a.ply b.ply c.txt --poses ";
  place.put("bad.csv", "source,target\na,b\n");
  EXPECT_THAT(refusal(three + "bad.csv", 3), HasSubstr("source, target and transform"));
  place.put("bad.csv", "source,target,transform\na,d,ab.xf\n");
  EXPECT_THAT(refusal(three + "bad.csv", 3), HasSubstr("'d'"));
  place.put("bad.csv", "source,target,transform\na,a,ab.xf\n");
  EXPECT_THAT(refusal(three + "bad.csv", 3), HasSubstr("with itself"));
  place.put("bad.csv", "source,target,transform,weight\na,b,ab.xf,0\n");
  EXPECT_THAT(refusal(three + "bad.csv", 3), HasSubstr("weight '0'"));
  place.put("bad.csv", "source,target,transform\na,b,ef.xf\n");
  EXPECT_THAT(refusal(three + "bad.csv", 3), HasSubstr("ef.xf"));
}

}  // namespace
}  // namespace corral
