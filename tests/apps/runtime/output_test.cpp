// SPDX-License-Identifier: MIT
#include "apps/runtime/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/io/scratch.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Fixed, HasSoManyDecimals) {
  EXPECT_EQ(fixed(1.25, 3), "1.250");
  EXPECT_EQ(fixed(2.0 / 3, 2), "0.67");
  EXPECT_EQ(fixed(-7, 0), "-7");
  EXPECT_EQ(fixed(std::nullopt, 3), "");
}

TEST(Fixed, LargeNumbersAreNotCutShort) { EXPECT_EQ(std::stod(fixed(1e300, 3)), 1e300); }

TEST(TextTable, AlignsNumbersToTheRight) {
  TextTable table({"name", "count", "status"});
  table.add({"a", "1", "fine"});
  table.add({"longer", "123456", "x"});
  table.add({"b", "", ""});
  EXPECT_EQ(table.str(),
            "name     count  status\n"
            "a            1  fine\n"
            "longer  123456  x\n"
            "b            -  -\n");
}

TEST(TextTable, MarkdownEscapesItsBars) {
  TextTable table({"a", "b"});
  table.add({"x|y", ""});
  EXPECT_EQ(table.markdown(), "| a | b |\n| --- | --- |\n| x\\|y |  |\n");
}

TEST(ToJson, ATransformIsFourRowsOfFour) {
  RigidTransform pose;
  pose.rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  pose.translation << 7, 8, 9;
  EXPECT_EQ(to_json(pose).dump(), "[[0.0,-1.0,0.0,7.0],[1.0,0.0,0.0,8.0],[0.0,0.0,1.0,9.0],[0.0,0.0,0.0,1.0]]");
}

TEST(ToJson, AScoreHoldsItsCounts) {
  const Json json = to_json(GroupingScore{9, 0, 0, 0, std::nullopt, std::nullopt, std::nullopt});
  EXPECT_EQ(json.dump(),
            R"({"matches":9,"selected":0,"correct":0,"true_matches":0,"precision":null,"recall":null,"f1":null})");
}

TEST(StageReport, SaysTheCountsAndTheHints) {
  MatchReport report;
  report.source.points = 12;
  report.target.dropped_no_frame = 5;
  report.matches = 77;
  report.hints = {"do this"};
  const std::string text = stage_report(report);
  for (const char* piece :
       {"source: 12 points", "target: 0 points", "5 without a frame", "77 matches", "\nhint: do this"})
    EXPECT_THAT(text, HasSubstr(piece));
}

TEST(StageReport, HasATableOfTheStages) {
  MatchReport report;
  report.stages = {{"resolution of the source", 1.25, 30}, {"matching", 1234.56, 128.04}};
  EXPECT_THAT(stage_report(report), HasSubstr("\nstage                     time ms  peak memory MB\n"
                                              "resolution of the source      1.2            30.0\n"
                                              "matching                   1234.6           128.0"));
  const Json stages = to_json(report)["stages"];
  ASSERT_EQ(stages.size(), 2U);
  EXPECT_EQ(stages[1].dump(), R"({"stage":"matching","time_ms":1234.56,"peak_memory_mb":128.04})");
}

TEST(StageReport, TellsWhatTheInspectionFound) {
  MatchReport report;
  report.source.faces = 7;
  EXPECT_THAT(stage_report(report), ::testing::Not(HasSubstr("components"))) << "not inspected";
  EXPECT_TRUE(to_json(report)["source"]["topology"].is_null());
  report.source.topology = Topology();
  report.source.topology->components = 3;
  report.source.topology->misoriented_faces = 4;
  EXPECT_THAT(stage_report(report), HasSubstr("7 faces, 3 components, 4 misoriented faces, pr"));
  EXPECT_EQ(to_json(report)["source"]["topology"]["components"], 3);
}

TEST(ToJson, SettingsAreWhatResultsDependOn) {
  MatchSettings settings;
  std::vector<std::string> keys;
  const Json json = to_json(settings);
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  EXPECT_THAT(keys, ElementsAre("resolution_rule", "detector", "keypoint_radius_pr", "support_radius_pr", "normals",
                                "sensor", "shot", "matcher", "mutual"));
  settings.threads = 7;
  EXPECT_EQ(to_json(settings), json);
  settings.detector = "harris-mesh";
  EXPECT_EQ(to_json(settings)["harris_mesh"]["neighborhood"], "adaptive");
}

TEST(Put, WritesAFileOrStandardOutput) {
  const testing::ScratchFolder folder;
  put(folder / "a.txt", std::string("text"));
  put(folder / "a.json", Json{{"a", 0.1}});
  EXPECT_EQ(testing::text_of(folder / "a.txt"), "text");
  EXPECT_EQ(testing::text_of(folder / "a.json"), "{\n  \"a\": 0.1\n}\n");
  ::testing::internal::CaptureStdout();
  put("", std::string("text\n"));
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "text\n");
}

}  // namespace
}  // namespace corral
