// SPDX-License-Identifier: MIT
// The options of match and run that decide what is matched, as a user types them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "tests/support/program.h"

namespace corral {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::lines_in;
using ::testing::Not;
using testing::Outcome;
using ::testing::StartsWith;
using testing::Workplace;

/// The table of a command that must work.
CorrespondenceSet table_of(const Workplace& place, const std::string& options) {
  const Outcome outcome = place.corral("match model.ply copy.ply -o table.csv " + options);
  EXPECT_EQ(outcome.status, 0) << options << ": " << outcome.err;
  EXPECT_EQ(outcome.err, "") << options;
  return read_matches(place / "table.csv");
}

TEST(MatchOptions, DefaultsAreWhatTheHelpSays) {
  const Workplace place;
  place.put_pair();
  table_of(place, "");
  const std::string expected = place.text("table.csv");
  table_of(place,
           "--resolution mean --detector harris --set harris.radius_pr=3 --descriptor shot --set shot.radius_pr=15 "
           "--frames shot --normals auto --set shot.form=additive --matcher exact --threads 0");
  EXPECT_EQ(place.text("table.csv"), expected);
}

TEST(MatchOptions, EachOneChangesTheTable) {
  const Workplace place;
  place.put_pair();
  std::set<std::string> tables;
  const std::string options[] = {
      "",
      "--detector harris-mesh",
      "--detector harris-mesh --set harris-mesh.neighborhood=rings --set harris-mesh.rings=3",
      "--detector harris-mesh --set harris-mesh.neighborhood=ball",
      "--detector harris-mesh --set harris-mesh.selection=clustering --set harris-mesh.separation=0.05",
      "--detector harris-mesh --set harris-mesh.fraction=0.02",
      "--detector harris-mesh --set harris-mesh.extent=0.05",
      "--detector uniform",
      "--detector uniform --set uniform.spacing_pr=5",
      "--normals origin",
      "--normals origin --sensor 10,-20,30.5",
      "--normals origin --sensor -1e1,2,-3",
      "--set shot.form=pcl-bug",
      "--set shot.radius_pr=10",
      "--frames none",
      "--set shot.form=product",
      "--mutual"};
  for (const std::string& option : options) {
    EXPECT_GT(table_of(place, option).size(), 3) << option;
    EXPECT_TRUE(tables.insert(place.text("table.csv")).second) << option << " gives a table seen before";
  }
}

TEST(MatchOptions, UniformPutsOneKeypointIntoEachCube) {
  const Workplace place;
  place.put_pair();
  const CorrespondenceSet few = table_of(place, "--detector uniform --set uniform.spacing_pr=8"),
                          many = table_of(place, "--detector uniform --set uniform.spacing_pr=4");
  EXPECT_GT(many.size(), 3 * few.size());
}

TEST(MatchOptions, SensorIsThreeNumbersOfAnySign) {
  const Workplace place;
  place.put_pair();
  for (const char* sensor : {"--sensor -1,-2,-3", "--sensor=-1,-2,-3", "--sensor -1 -2 -3"})
    table_of(place, "--normals origin " + std::string(sensor));
  for (const char* bad : {"1,2", "1,2,3,4", "a,b,c", "1,2,nan", "''", "inf,0,0"}) {
    const Outcome outcome = place.corral("match model.ply copy.ply -o bad.csv --sensor " + std::string(bad));
    EXPECT_EQ(outcome.status, 2) << bad;
    EXPECT_THAT(outcome.err, HasSubstr("--sensor")) << bad;
  }
}

TEST(MatchOptions, NormalsOfFacesDoNotAskForTheSensorUnlessItIsNamed) {
  const Workplace place;
  place.put_pair();
  table_of(place, "");
  const std::string by_faces = place.text("table.csv");
  table_of(place, "--normals mesh --sensor 100,200,-300");
  EXPECT_EQ(place.text("table.csv"), by_faces);
  table_of(place, "--sensor 100,200,-300");
  const std::string by_sensor = place.text("table.csv");
  EXPECT_NE(by_sensor, by_faces);
  table_of(place, "--normals origin --sensor 100,200,-300");
  EXPECT_EQ(place.text("table.csv"), by_sensor);
}

TEST(MatchOptions, MutualMatchesArePartOfAll) {
  const Workplace place;
  place.put_pair();
  const CorrespondenceSet all = table_of(place, ""), mutual = table_of(place, "--mutual");
  EXPECT_LT(mutual.size(), all.size());
  EXPECT_GT(mutual.size(), 10);
  std::set<int> taken;
  int row = 0;
  for (int i = 0; i < mutual.size(); ++i, ++row) {
    const auto at = static_cast<std::size_t>(i);
    while (row < all.size() && all.source_keypoints[static_cast<std::size_t>(row)] != mutual.source_keypoints[at])
      ++row;
    ASSERT_LT(row, all.size()) << "in their order";
    EXPECT_EQ(all.target_keypoints[static_cast<std::size_t>(row)], mutual.target_keypoints[at]);
    EXPECT_EQ(all.feature_distance(row), mutual.feature_distance(i));
    EXPECT_TRUE(taken.insert(mutual.target_keypoints[at]).second) << "each target once";
  }
}

TEST(MatchOptions, FlannFindsNearlyTheSame) {
  const Workplace place;
  place.put_pair();
  const CorrespondenceSet exact = table_of(place, ""), found = table_of(place, "--matcher flann");
  ASSERT_EQ(found.source_keypoints, exact.source_keypoints);
  int same = 0;
  for (std::size_t i = 0; i < exact.target_keypoints.size(); ++i)
    same += found.target_keypoints[i] == exact.target_keypoints[i];
  EXPECT_GT(same, 0.9 * exact.size());
  EXPECT_GT(table_of(place, "--matcher flann --mutual").size(), 10);
}

TEST(MatchOptions, ThreadsDoNotMatter) {
  const Workplace place;
  place.put_pair();
  for (const char* options : {"", "--mutual --set shot.form=product", "--detector harris-mesh"}) {
    table_of(place, std::string(options) + " --threads 1");
    const std::string expected = place.text("table.csv");
    for (const char* threads : {"0", "2", "5"}) {
      table_of(place, std::string(options) + " --threads " + threads);
      EXPECT_EQ(place.text("table.csv"), expected) << threads;
    }
  }
}

TEST(MatchOptions, BadValuesAreRefusedInOneSentence) {
  const Workplace place;
  place.put_pair();
  const std::pair<std::string, std::string> said[] = {
      {"--detector sift", "expected harris|harris-mesh|"},
      {"--descriptor sift", "expected shot|fpfh"},
      {"--detector Harris", "--detector is 'Harris'"},
      {"--normals outward", "expected auto|mesh|file|origin"},
      {"--frames some", "expected shot|none"},
      {"--set shot.form=quadrilinear", "expected additive|product|pcl-bug"},
      {"--matcher kdtree", "expected exact|flann"},
      {"--threads -1", "--threads"},
      {"--threads 257", "--threads"},
      {"--threads 1.5", "--threads"},
      {"--threads many", "--threads"},
      {"--mutual=perhaps", "mutual"},
      {"--detector harris-mesh --set harris-mesh.rings=0", "rings"},
      {"--detector harris-mesh --set harris-mesh.neighborhood=spatial", "expected adaptive|rings|ball"},
      {"--detector harris-mesh --set harris-mesh.selection=best", "expected fraction|clustering"},
      {"--detector harris-mesh --set harris-mesh.fraction=2", "fraction"},
      {"--detector harris-mesh --set harris-mesh.extent=nan", "extent"},
      {"--set harris.radius_pr=0", "radius_pr is 0"},
      {"--set harris.radius=3", "expected radius_pr"},
      {"--set uniform.spacing_pr=3", "uniform is not in use here, expected an option of harris, shot"},
      {"--set haris.radius_pr=3", "did you mean 'harris'?"},
      {"--set radius_pr=3", "expected NAME.OPTION=VALUE"},
      {"--set harris.=3", "expected NAME.OPTION=VALUE"},
      {"--set harris.radius_pr=3 --set harris.radius_pr=4", "set twice"},
      {"--resolution median", "--resolution is 'median'"}};
  const auto before = place.names();
  for (const char* command : {"match", "run"})
    for (const auto& [option, sentence] : said) {
      SCOPED_TRACE(std::string(command) + " " + option);
      const Outcome outcome = place.corral(std::string(command) + " model.ply copy.ply -o new " + option);
      EXPECT_EQ(outcome.status, 2);
      EXPECT_EQ(outcome.out, "");
      EXPECT_THAT(outcome.err, HasSubstr(sentence));
      if (outcome.err.rfind("corral: ", 0) == 0) {
        EXPECT_EQ(lines_in(outcome.err), 1U) << outcome.err;
      }
      EXPECT_EQ(place.names(), before);
    }
}

TEST(MatchOptions, HarrisMeshNeedsFaces) {
  const Workplace place;
  Mesh cloud = testing::bumpy_sphere(3, 1);
  cloud.triangles.resize(0, 3);
  write_mesh(place / "cloud.ply", cloud);
  const Outcome outcome = place.corral("match cloud.ply cloud.ply --detector harris-mesh");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, HasSubstr("harris-mesh needs the faces of a mesh"));
  EXPECT_EQ(lines_in(outcome.err), 1U);
}

TEST(MatchReport, TheStagesAreATableInWordsAndAListInJson) {
  const Workplace place;
  place.put_pair();
  const Outcome outcome = place.corral("match model.ply copy.ply -o m.csv -v --json");
  ASSERT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, HasSubstr("\nstage "));
  EXPECT_THAT(outcome.err, HasSubstr("time ms  peak memory MB\n"));
  std::vector<std::string> names;
  double memory = 0;
  const auto report = outcome.json();
  for (const auto& stage : report["stages"]) {
    EXPECT_THAT(testing::keys_of(stage), ElementsAre("peak_memory_mb", "stage", "time_ms"));
    names.push_back(stage["stage"]);
    EXPECT_THAT(outcome.err, HasSubstr("\n" + names.back() + " "));
    EXPECT_GT(stage["time_ms"], 0);
    EXPECT_GE(stage["peak_memory_mb"], memory);
    memory = stage["peak_memory_mb"];
  }
  EXPECT_THAT(
      names, ElementsAre("topology of the source", "normals and resolution of the source", "topology of the target",
                         "normals and resolution of the target", "keypoints of the source", "descriptors of the source",
                         "keypoints of the target", "descriptors of the target", "matching"));
  EXPECT_GT(memory, 1);
  EXPECT_LT(memory, 4000);
  for (const char* side : {"source", "target"}) {
    EXPECT_THAT(
        testing::keys_of(report[side]),
        ElementsAre("candidates", "descriptors", "dropped_no_frame", "dropped_no_histogram", "dropped_small_support",
                    "faces", "keypoints", "median_spacing", "normals", "points", "resolution", "strays", "topology"));
    EXPECT_EQ(report[side]["topology"]["components"], 1);
    EXPECT_EQ(report[side]["topology"]["isolated"], 0);
    EXPECT_EQ(report[side]["descriptors"].get<int>() + report[side]["dropped_small_support"].get<int>() +
                  report[side]["dropped_no_frame"].get<int>() + report[side]["dropped_no_histogram"].get<int>(),
              report[side]["keypoints"]);
  }
}

TEST(RunOptions, AreThoseOfMatchAndAreWrittenDown) {
  const Workplace place;
  place.put_pair();
  const std::string options =
      "--detector uniform --set uniform.spacing_pr=6 --normals origin --sensor -1,2,3 --set shot.form=product --mutual "
      "--threads 2";
  const Outcome outcome =
      place.corral("run model.ply copy.ply --truth truth.txt --methods gc -o out --json " + options);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  table_of(place, options);
  EXPECT_EQ(place.text("out/matches.csv"), place.text("table.csv"));
  const auto matching = outcome.json()["details"]["matching"];
  EXPECT_EQ(matching["detector"], "uniform");
  EXPECT_EQ(matching["descriptor"], "shot");
  EXPECT_EQ(matching["options"]["uniform"]["spacing_pr"], 6);
  EXPECT_EQ(matching["normals"], "origin");
  EXPECT_EQ(matching["sensor"], nlohmann::json::parse("[-1.0, 2.0, 3.0]"));
  EXPECT_EQ(matching["options"]["shot"]["form"], "product");
  EXPECT_EQ(matching["frames"], "shot");
  EXPECT_EQ(matching["matcher"], "exact");
  EXPECT_EQ(matching["mutual"], true);
  EXPECT_FALSE(matching.contains("threads")) << "results do not depend on it";
  EXPECT_FALSE(matching["options"].contains("harris")) << "not in use";
  EXPECT_GT(outcome.json()["frame_repeatability"], 0);
  EXPECT_LE(outcome.json()["frame_repeatability"], 1);
  const auto other =
      place.corral("run model.ply copy.ply --methods gc --json --detector harris-mesh --set harris-mesh.rings=4")
          .json();
  EXPECT_EQ(other["details"]["matching"]["options"]["harris-mesh"]["rings"], 4);
  EXPECT_TRUE(other["frame_repeatability"].is_null()) << "without a truth";
}

TEST(RunOptions, VerboseHasTheStages) {
  const Workplace place;
  place.put_pair();
  const Outcome outcome = place.corral("run model.ply copy.ply --truth truth.txt --methods ss -v");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err,
              AllOf(StartsWith("source: 2562 points, 5120 faces, normals by the faces, 1 components, pr "),
                    HasSubstr("\nstage "), HasSubstr("\nmatching "), HasSubstr("\ndescriptors of the target ")));
  EXPECT_THAT(outcome.out, HasSubstr("% of the correct matches agree within 10 degrees"));
  EXPECT_THAT(outcome.err, Not(HasSubstr("hint: ")));
}

}  // namespace
}  // namespace corral
