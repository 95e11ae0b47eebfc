// SPDX-License-Identifier: MIT
// corral transform, and the layouts and --truth-inverse of every command that takes a truth, as a user types them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/support/program.h"

namespace corral {
namespace {

using testing::expect_ok;
using ::testing::HasSubstr;
using testing::Outcome;
using ::testing::StartsWith;
using testing::Workplace;

const std::string kTurn = "0 -1 0 1\n1 0 0 2\n0 0 1 3\n0 0 0 1\n", kShift = "1 0 0 10\n0 1 0 0\n0 0 1 0\n0 0 0 1\n",
                  kLog = "0 3 4\n" + kTurn + "2 3 4\n" + kShift,
                  kThreeDigits = "0.783 -0.482 0.394 12.5\n0.549 0.833 -0.072 -7.25\n-0.293 0.272 0.916 30\n";

TEST(Transform, ConvertsBetweenLayouts) {
  const Workplace place;
  place.put("pose.txt", kTurn);
  for (const char* layout : {"4x4", "3x4", "kitti", "tum", "log", "conf", "json", "bop"}) {
    SCOPED_TRACE(layout);
    const Outcome there = place.corral("transform pose.txt --to " + std::string(layout));
    expect_ok(there);
    place.put("other.txt", there.out);
    expect_ok(place.corral("transform other.txt -o back.txt"));
    const RigidTransform back = read_transform(place / "back.txt"), pose = read_transform(place / "pose.txt");
    EXPECT_LT((back.rotation - pose.rotation).norm() + (back.translation - pose.translation).norm(), 1e-14);
  }
  EXPECT_EQ(place.corral("transform pose.txt --to 3x4").out, kTurn.substr(0, kTurn.size() - 8));
  EXPECT_EQ(place.corral("transform pose.txt --to log --key 3,0").out, "0 3 4\n" + kTurn);
}

TEST(Transform, ComposesFromLeftToRightAndInvertsTheWhole) {
  const Workplace place;
  place.put("turn.txt", kTurn);
  place.put("shift.txt", kShift);
  const Outcome composed = place.corral("transform turn.txt --compose shift.txt --compose shift.txt");
  expect_ok(composed);
  EXPECT_EQ(composed.out, "0 -1 0 21\n1 0 0 2\n0 0 1 3\n0 0 0 1\n") << "the turn first";
  EXPECT_EQ(place.corral("transform shift.txt --compose turn.txt").out, "0 -1 0 1\n1 0 0 12\n0 0 1 3\n0 0 0 1\n");
  EXPECT_EQ(place.corral("transform shift.txt --compose shift.txt --inverse").out,
            "1 0 0 -20\n0 1 0 -0\n0 0 1 -0\n0 0 0 1\n");
}

TEST(Transform, NamesOneOfSeveralAndSaysWhatItDid) {
  const Workplace place;
  place.put("gt.log", kLog);
  const Outcome stored = place.corral("transform gt.log:3,0"), inverse = place.corral("transform gt.log:0,3");
  expect_ok(stored);
  EXPECT_EQ(stored.out, kTurn);
  EXPECT_EQ(inverse.status, 0);
  EXPECT_EQ(inverse.err, "note: gt.log:0,3: it is the inverse of the stored pose, which maps 3 into 0\n");
  EXPECT_EQ(inverse.out, place.corral("transform gt.log:3,0 --inverse").out);
  place.put("round.txt", kThreeDigits);
  EXPECT_THAT(place.corral("transform round.txt").err, StartsWith("note: round.txt: the rotation is printed with 3"));
  const Outcome unknown = place.corral("transform gt.log:7,0");
  EXPECT_EQ(unknown.status, 3);
  EXPECT_THAT(unknown.err, HasSubstr("gt.log, pose 7,0: is not there, expected one of '3,0', '3,2'"));
}

TEST(Transform, MovesAMesh) {
  const Workplace place;
  const Mesh ball = testing::icosphere(1);
  write_mesh(place / "ball.ply", ball);
  place.put("pose.txt", kTurn);
  const Outcome moved = place.corral("transform pose.txt --apply ball.ply -o moved.ply");
  expect_ok(moved);
  EXPECT_EQ(moved.out, "");
  const Mesh read = read_mesh(place / "moved.ply");
  EXPECT_EQ(read.triangles, ball.triangles);
  for (Eigen::Index row = 0; row < ball.vertices.rows(); ++row) {
    const Eigen::RowVector3d p = ball.vertices.row(row);
    EXPECT_LT((read.vertices.row(row) - Eigen::RowVector3d(1 - p.y(), 2 + p.x(), 3 + p.z())).norm(), 1e-15);
  }
  EXPECT_EQ(place.corral("transform pose.txt --apply ball.ply --json -o moved.ply").json()["translation"][2], 3);
}

TEST(Transform, JsonHasAngleAndAxis) {
  const Workplace place;
  place.put("pose.txt", kTurn);
  const Outcome outcome = place.corral("transform pose.txt --json");
  expect_ok(outcome);
  const auto json = outcome.json();
  EXPECT_NEAR(json["rotation_deg"].get<double>(), 90, 1e-9);
  EXPECT_NEAR(json["axis"][2].get<double>(), 1, 1e-12);
  EXPECT_EQ(json["target_from_source"][1][3], 2);
  place.put("pose.json", outcome.out);
  EXPECT_EQ(place.corral("transform pose.json").out, kTurn) << "what --json writes is read";
}

TEST(Transform, RefusesWrongUsageAndItsOwnInputs) {
  const Workplace place;
  place.put("pose.txt", kTurn);
  place.put("gt.log", kLog);
  write_mesh(place / "ball.ply", testing::icosphere(0));
  std::filesystem::create_symlink("ball.ply", place / "link.ply");
  const auto before = place.names();
  for (const auto& [arguments, sentence] : std::vector<std::pair<std::string, std::string>>{
           {"pose.txt -o pose.txt", "pose.txt: is an input of this call, expected another name for the output"},
           {"gt.log:3,0 -o ./gt.log", "is an input"},
           {"pose.txt --compose gt.log:3,0 -o gt.log", "is an input"},
           {"pose.txt --apply ball.ply -o ball.ply", "is an input"},
           {"pose.txt --apply ball.ply -o link.ply", "is an input"},
           {"pose.txt --apply ball.ply", "--apply: needs --output"},
           {"pose.txt --apply ball.ply --to tum -o b.ply", "--to"},
           {"pose.txt --to xyz", "--to"},
           {"pose.txt --to log --key 3", "--key for --to log"},
           {"pose.txt --key 3", "--key for --to 4x4"},
           {"", "pose"}}) {
    SCOPED_TRACE(arguments);
    const Outcome outcome = place.corral("transform " + arguments);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, HasSubstr(sentence));
    EXPECT_EQ(outcome.out, "");
  }
  EXPECT_EQ(place.text("pose.txt"), kTurn);
  EXPECT_EQ(place.corral("transform pose.txt --apply ball.ply -o moved.off").status, 3) << "only PLY is written";
  EXPECT_EQ(place.names(), before);
}

// The inverse, in another layout and turned round again, gives the numbers of the truth.
TEST(Truth, EveryCommandTakesItInverted) {
  const Workplace place;
  place.put_pair();
  ASSERT_EQ(place.corral("run model.ply copy.ply --truth truth.txt --methods gc -o out").status, 0);
  expect_ok(place.corral("transform truth.txt --inverse --to json -o inverse.txt"));
  const std::string files = "out/matches.csv out/group_gc.csv ";
  for (const std::string& command : {"score " + files + "--json", std::string("run model.ply copy.ply --methods gc")}) {
    SCOPED_TRACE(command);
    const Outcome plain = place.corral(command + " --truth truth.txt"),
                  inverse = place.corral(command + " --truth inverse.txt --truth-inverse");
    ASSERT_EQ(inverse.status, 0) << inverse.err;
    const auto counts = [](const Outcome& outcome) { return outcome.out.substr(0, 120); };
    EXPECT_EQ(counts(plain), counts(inverse));
    EXPECT_NE(counts(plain), counts(place.corral(command + " --truth inverse.txt")));
    EXPECT_EQ(place.corral(command + " --truth-inverse").status, 2) << "needs a truth";
  }
  const auto error = [&](const std::string& truth) {
    const auto json = place.corral("refine " + files + "--json -o pose.txt --truth " + truth).json();
    return json["translation_error_pr"].get<double>();
  };
  EXPECT_NEAR(error("inverse.txt --truth-inverse"), error("truth.txt"), 1e-6);
  EXPECT_GT(error("inverse.txt"), 10 * error("truth.txt"));
  const std::string draw = "draw model.ply copy.ply --matches out/matches.csv --width 200 ";
  expect_ok(place.corral(draw + "--truth truth.txt -o a.png"));
  expect_ok(place.corral(draw + "--truth inverse.txt --truth-inverse -o b.png"));
  EXPECT_EQ(place.text("a.png"), place.text("b.png"));
}

TEST(Truth, WhatWasDoneToReadItIsSaid) {
  const Workplace place;
  place.put_problem();
  place.put("round.txt", kThreeDigits);
  for (const char* command : {"score matches.csv group.csv --truth round.txt",
                              "refine matches.csv group.csv -o pose.txt --json --truth round.txt",
                              "refine matches.csv group.csv -o pose.txt --json --start round.txt"})
    EXPECT_THAT(place.corral(command).err, StartsWith("note: round.txt: the rotation is printed with 3 digits"))
        << command;
}

TEST(Truth, PairsOfADataSetNameOneOfSeveral) {
  const Workplace place;
  place.put_pair();
  const RigidTransform truth = read_transform(place / "truth.txt");
  place.put("dataset.toml", "name = \"mine\"\n");
  place.put("gt.log", transform_text(truth, TransformLayout::Log, "0,3") +
                          transform_text(truth.inverse(), TransformLayout::Log, "4,5"));
  place.put("pairs.csv",
            "pair,source,target,truth\none,model.ply,copy.ply,\"gt.log:0,3\"\ntwo,copy.ply,model.ply,\"gt.log:3,0\"\n");
  const Outcome good = place.corral("dataset check .");
  EXPECT_EQ(good.status, 0) << good.out << good.err;
  place.put("pairs.csv",
            "pair,source,target,truth\none,model.ply,copy.ply,\"gt.log:4,5\"\ntwo,copy.ply,model.ply,\"gt.log:7,0\"\n");
  const Outcome bad = place.corral("dataset check .");
  EXPECT_EQ(bad.status, 3);
  EXPECT_THAT(bad.out + bad.err, HasSubstr("the truth fits inverted"));
  EXPECT_THAT(bad.out + bad.err, HasSubstr("pose 7,0: is not there"));
}

}  // namespace
}  // namespace corral
