// SPDX-License-Identifier: MIT
#include "apps/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "kernel/number_text.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

MethodRecord full_record() {
  MethodRecord record;
  record.method = "gc";
  record.found.selected = {1, 2, 5};
  record.time_ms = 0.1;
  record.score = GroupingScore{9, 3, 2, 7, 2.0 / 3, 2.0 / 7, 0.4};
  record.pose.status = RefineStatus::Refined;
  record.pose.converged = true;
  record.pose.initial = RigidTransform();
  record.pose.target_from_source = RigidTransform();
  record.pose.covariance = PoseCovariance::Identity();
  record.errors = PoseErrors{1.0 / 3, 5e-324, PointError{1e300, 0.25}, std::nullopt};
  return record;
}

MethodRecord failed_record() {
  MethodRecord record = full_record();
  record.method = "ss";
  record.failure = "a \"b\", c\nd";
  record.errors.reset();
  return record;
}

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  for (const char letter : line) {
    if (letter == ',')
      fields.emplace_back();
    else
      fields.back() += letter;
  }
  return fields;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

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

TEST(MethodsCsv, ReadsBackAsTheSameNumbers) {
  const auto lines = lines_of(methods_csv({full_record()}));
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0],
            "method,selected,precision,recall,f1,time_ms,rotation_error_deg,translation_error_pr,rmse_pr,status");
  const auto fields = fields_of(lines[1]);
  ASSERT_EQ(fields.size(), 10U);
  EXPECT_EQ(fields[0], "gc");
  EXPECT_EQ(fields[1], "3");
  const std::vector<double> numbers = {2.0 / 3, 2.0 / 7, 0.4, 0.1, 1.0 / 3, 5e-324, 1e300};
  for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_EQ(parse_double(fields[i + 2]).value(), numbers[i]);
  EXPECT_EQ(fields[9], "refined");
}

TEST(MethodsCsv, WhatIsUndefinedIsEmpty) {
  MethodRecord record = full_record();
  record.score = GroupingScore{9, 0, 0, 7, std::nullopt, 0.0, 0.0};
  record.found.selected.clear();
  record.errors.reset();
  record.pose = RefinedPose();
  EXPECT_EQ(lines_of(methods_csv({record}))[1], "gc,0,,0,0,0.1,,,,too few rows");
  record.score.reset();
  EXPECT_EQ(lines_of(methods_csv({record}))[1], "gc,0,,,,0.1,,,,too few rows");
}

TEST(MethodsCsv, AFailureIsARowWithoutNumbers) {
  const auto lines = lines_of(methods_csv({full_record(), failed_record()}));
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[2], "ss,,,,,,,,,failed: a ;b;; c;d");
}

TEST(MethodsText, HasARowPerMethod) {
  MethodRecord failed = failed_record();
  failed.failure = "no table";
  const auto lines = lines_of(methods_text({full_record(), failed}));
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_THAT(lines[0], StartsWith("method  selected  precision"));
  EXPECT_THAT(lines[1], StartsWith("gc             3      0.667"));
  EXPECT_THAT(lines[1], EndsWith("refined"));
  EXPECT_THAT(lines[2], StartsWith("ss             -          -"));
  EXPECT_THAT(lines[2], EndsWith("failed: no table"));
}

TEST(ToJson, AMethodHasItsKeysInOrder) {
  std::vector<std::string> keys;
  const Json json = to_json(full_record());
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  EXPECT_THAT(keys, ElementsAre("method", "selected", "precision", "recall", "f1", "time_ms", "rotation_error_deg",
                                "translation_error_pr", "rmse_pr", "status"));
  EXPECT_EQ(json["selected"].dump(), "3");
  EXPECT_EQ(json["rmse_pr"], 1e300);
}

TEST(ToJson, AFailureHasNothingButItsStatus) {
  const Json json = to_json(failed_record());
  EXPECT_EQ(json["status"], "failed: a \"b\", c\nd");
  for (const auto& [key, value] : json.items()) EXPECT_EQ(value.is_null(), key != "method" && key != "status") << key;
}

TEST(ToJson, APoseThatIsAbsentIsNull) {
  const Json json = to_json(RefinedPose(), std::nullopt);
  EXPECT_EQ(json["status"], "too few rows");
  for (const char* key :
       {"target_from_source", "rotation_error_deg", "translation_error_pr", "rmse_pr", "mean_error_pr", "initial",
        "initial_rms_pr", "final_rms_pr", "initial_cost", "final_cost", "condition", "covariance"})
    EXPECT_TRUE(json.at(key).is_null()) << key;
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
