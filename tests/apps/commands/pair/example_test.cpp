// SPDX-License-Identifier: MIT
// The pair in data/example, and what can be wrong with such a pair: each time the true cause is named.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "io/pairs/dataset_file.h"
#include "tests/support/program.h"

namespace corral {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::Workplace;

const std::string kExample = CORRAL_SOURCE_DIR "/data/example/";

class ExamplePair : public ::testing::Test {
 protected:
  ExamplePair() : source_(read_mesh(kExample + "source.ply")), target_(read_mesh(kExample + "target.ply")) {
    truth_ = read_transform(kExample + "truth.txt");
  }

  /// Of GC, with the truth; the meshes and the truth are what the test has made of them.
  Outcome run(const std::string& options = "") {
    write_mesh(place_ / "source.ply", source_);
    write_mesh(place_ / "target.ply", target_);
    place_.put("truth.txt", transform_text(truth_));
    return place_.corral("run source.ply target.ply --truth truth.txt --methods gc --explain --json " + options);
  }

  /// As the pair is: 8 of 11 matches are correct, and the refined pose is within half a pr.
  static void expect_registered(const Outcome& outcome) {
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const auto json = outcome.json();
    EXPECT_EQ(json["matches"], 11);
    EXPECT_EQ(json["true_matches"], 8);
    EXPECT_EQ(json["explanation"]["cause"], "found");
    EXPECT_LT(json["methods"][0]["translation_error_pr"], 0.5);
  }

  static std::string cause(const Outcome& outcome) { return outcome.json()["explanation"]["cause"]; }

  void flip_target() { target_.triangles.col(1).swap(target_.triangles.col(2)); }

  static void add_stray(Mesh& mesh) {
    mesh.vertices.conservativeResize(mesh.vertices.rows() + 1, 3);
    mesh.vertices.bottomRows(1) << 0, 0, 3000;
  }

  Workplace place_;
  Mesh source_, target_;
  RigidTransform truth_;
};

TEST_F(ExamplePair, IsRegisteredWithoutAWord) {
  const Outcome outcome = run();
  expect_registered(outcome);
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(outcome.json()["truth_fit"]["verdict"], "fits");
  EXPECT_TRUE(outcome.json()["warnings"].empty());
}

TEST_F(ExamplePair, AnInverseTruthIsNamed) {
  truth_ = truth_.inverse();
  const Outcome outcome = run();
  EXPECT_THAT(outcome.err, HasSubstr("warning: truth does not fit: the truth fits inverted: 100 % within 2 pr"));
  EXPECT_EQ(cause(outcome), "truth does not fit");
  EXPECT_EQ(outcome.json()["explanation"]["methods"][0]["cause"], "truth does not fit");
  EXPECT_EQ(outcome.json()["truth_fit"]["verdict"], "inverted");
  EXPECT_FALSE(outcome.json()["truth_fit"]["belongs"]);
}

TEST_F(ExamplePair, ATruthInMetresIsNamed) {
  truth_.translation *= 0.001;
  const Outcome outcome = run();
  EXPECT_EQ(outcome.json()["truth_fit"]["verdict"], "translation times 1000");
  EXPECT_EQ(cause(outcome), "truth does not fit");
}

TEST_F(ExamplePair, ScoreWarnsOfATruthThatDoesNotFit) {
  truth_ = truth_.inverse();
  run("-o folder");
  const Outcome outcome = place_.corral(
      "score folder/matches.csv folder/group_gc.csv --truth truth.txt --source source.ply --target target.ply");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, HasSubstr("warning: truth does not fit: the truth fits inverted"));
}

TEST_F(ExamplePair, AStrayVertexIsNamedAndCanBeLeftOut) {
  add_stray(source_), add_stray(target_);
  const Outcome moved = run();
  EXPECT_THAT(moved.err, AllOf(HasSubstr("warning: source: stray point: vertex 900 "),
                               HasSubstr("warning: target: stray"), HasSubstr("--drop-stray")));
  EXPECT_EQ(moved.json()["warnings"].size(), 2U);
  const Outcome without = run("--drop-stray");
  expect_registered(without);
  EXPECT_THAT(without.err, HasSubstr("note: source.ply: 1 stray vertex left out, the first is 900"));
}

TEST_F(ExamplePair, AStrayVertexOnOneSideIsTheCauseOfAnErrorInUnits) {
  source_.vertices.conservativeResize(901, 3);
  source_.vertices.bottomRows(1) << 0, 0, 30000;
  const Outcome outcome = run();
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("both in the same unit"), HasSubstr("source: stray point: vertex 900")));
  expect_registered(run("--drop-stray"));
}

TEST_F(ExamplePair, AFlippedSideIsNamedAndASensorMendsIt) {
  flip_target();
  EXPECT_EQ(cause(run()), "normals opposed");
  EXPECT_THAT(run().json()["explanation"]["text"].get<std::string>(), HasSubstr("100 % of the overlap"));
  expect_registered(run("--sensor 0,0,1000"));
}

TEST_F(ExamplePair, AMeshThatMeetsACloudGetsAHint) {
  target_.triangles.resize(0, 3);
  const Outcome outcome = run();
  EXPECT_THAT(outcome.err, HasSubstr("hint: the normals of the target point towards the origin"));
  EXPECT_EQ(cause(outcome), "normals opposed");
  expect_registered(run("--sensor 0,0,1000"));
}

TEST_F(ExamplePair, MillimetresAgainstHalfMillimetresAreNamed) {
  truth_.translation = 2 * truth_.translation;
  target_.vertices *= 2;
  EXPECT_EQ(run().err, "") << "by a truth that fits they are of different sizes";
  EXPECT_THAT(place_.corral("match source.ply target.ply -o matches.csv").err,
              HasSubstr("warning: units may differ: the target's pr is 1.9"));
}

/// Every command that writes refuses to write over what it reads, before any work.
TEST_F(ExamplePair, OutputsNeverReplaceInputs) {
  ASSERT_EQ(run("-o folder").status, 0);
  place_.put("folder/start.txt", transform_text(truth_));
  ASSERT_EQ(std::system(("ln -s source.ply '" + (place_ / "link.ply") + "'").c_str()), 0);
  const std::vector<std::string> calls = {
      "match source.ply target.ply -o source.ply",
      "match source.ply target.ply -o ./target.ply",
      "match link.ply target.ply -o source.ply",
      "run source.ply target.ply --truth folder/pose_gc.txt -o folder",
      "group folder/matches.csv --method gc -o folder/matches.csv",
      "refine folder/matches.csv folder/group_gc.csv -o folder/group_gc.csv",
      "refine folder/matches.csv folder/group_gc.csv --start folder/start.txt -o folder/start.txt",
      "refine folder/matches.csv folder/group_gc.csv --truth truth.txt -o truth.txt",
      "perturb source.ply -o source.ply",
      "perturb source.ply -o copy.ply --truth source.ply",
      "align source.ply target.ply --poses poses.csv -o aligned",
      "scan source.ply -o source.ply",
      "triangulate source.ply -o folder/../source.ply",
      "align source.ply target.ply --poses folder/pairs.csv -o folder",
  };
  place_.put("folder/pairs.csv", "source,target,pose\n");
  std::filesystem::create_directories(place_ / "aligned/poses");
  place_.put("aligned/poses/2.xf", transform_text(truth_));
  place_.put("poses.csv", "source,target,transform\nsource,target,aligned/poses/2.xf\n");
  const std::vector<std::string> files = {"source.ply",         "target.ply",          "truth.txt",
                                          "folder/matches.csv", "folder/group_gc.csv", "folder/pose_gc.txt",
                                          "aligned/poses/2.xf", "folder/start.txt",    "folder/pairs.csv"};
  std::vector<std::string> before;
  for (const std::string& file : files) before.push_back(place_.text(file));
  for (const std::string& call : calls) {
    const Outcome outcome = place_.corral(call);
    EXPECT_EQ(outcome.status, 2) << call << "\n" << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("is an input of this call")) << call;
    for (std::size_t i = 0; i < files.size(); ++i)
      EXPECT_EQ(place_.text(files[i]), before[i]) << call << ": " << files[i];
  }
}

TEST_F(ExamplePair, TwoOutputsAreTwoFiles) {
  run();
  const Outcome outcome = place_.corral("perturb source.ply -o copy.ply --truth ./copy.ply");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("is named for two outputs"));
}

TEST_F(ExamplePair, FlippedNormalsAreNamedWithoutAskingForAnExplanation) {
  flip_target();
  run("-o folder");
  const Outcome outcome = place_.corral("run source.ply target.ply --truth truth.txt --methods gc");
  EXPECT_THAT(outcome.err, HasSubstr("warning: the normals of the surfaces point to opposite sides on 100 %"));
}

TEST_F(ExamplePair, SurfacesInOtherUnitsComeBeforeTheTruth) {
  target_.vertices *= 10;
  EXPECT_THAT(run().err, HasSubstr("warning: truth does not fit: units may differ: the target's pr is 9.9"));
  target_.vertices *= 100;
  const Outcome outcome = run();
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, HasSubstr("units differ by a factor of 99"));
}

TEST_F(ExamplePair, AStudyNamesStrayVerticesAndFlippedSides) {
  add_stray(source_);
  flip_target();
  run();
  Dataset set;
  set.name = "set";
  std::filesystem::create_directory(place_ / "set");
  place_.put("set/dataset.toml", dataset_toml_text(set));
  place_.put("set/pairs.csv", "pair,source,target,truth\na,../source.ply,../target.ply,../truth.txt\n");
  place_.put("small.toml",
             "name = \"small\"\ndataset = \"set\"\nattribute = \"threshold_pr\"\nlevels = [4]\ngroupers = [\"gc\"]\n"
             "[matching]\nresolution = \"target\"\n");
  const Outcome outcome = place_.corral("evaluate small.toml --data set -o study");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("warning: pair a: source: stray point: vertex 900"),
                                 HasSubstr("warning: pair a: the normals of the surfaces point to opposite sides")));
  target_.vertices *= 3;
  run();
  EXPECT_THAT(place_.corral("evaluate small.toml --data set -o other").err,
              HasSubstr("warning: truth does not fit: pair a: "));
  source_ = read_mesh(kExample + "source.ply");
  run();
  EXPECT_THAT(place_.corral("evaluate small.toml --data set -o third").err,
              HasSubstr("warning: pair a: units may differ: the target's pr is 2.9"));
}

}  // namespace
}  // namespace corral
