// SPDX-License-Identifier: MIT
#include "apps/pair/report_pair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "kernel/number_text.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Lost by its fit, registered by its refined pose, which recognises no object.
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
  record.initial_errors = PoseErrors{2.0 / 3, 7, PointError{9, 5.5}, 0.1, {}, 0.2};
  record.errors = PoseErrors{1.0 / 3, 5e-324, PointError{1e300, 0.25}, 1.0 / 7, {}, 0.05};
  return record;
}

MethodRecord failed_record() {
  MethodRecord record = full_record();
  record.method = "ss";
  record.failure = "a \"b\", c\nd";
  record.errors.reset();
  record.initial_errors.reset();
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

TEST(ScoreJson, AScoreHoldsItsCounts) {
  const Json json = to_json(GroupingScore{9, 0, 0, 0, std::nullopt, std::nullopt, std::nullopt});
  EXPECT_EQ(json.dump(),
            R"({"matches":9,"selected":0,"correct":0,"true_matches":0,"precision":null,"recall":null,"f1":null})");
}

TEST(MethodsCsv, ReadsBackAsTheSameNumbers) {
  const auto lines = lines_of(methods_csv({full_record()}));
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0],
            "method,selected,precision,recall,f1,time_ms,rotation_error_deg,translation_error_pr,rmse_pr,mean_error_pr,"
            "add_share,add_s_share,success_5pr,success_from_pr,success_add,success_add_s,"
            "initial_rotation_error_deg,initial_translation_error_pr,"
            "initial_rmse_pr,initial_mean_error_pr,initial_add_share,initial_add_s_share,initial_success_5pr,"
            "initial_success_from_pr,initial_success_add,initial_success_add_s,confidence,outcome,status");
  const auto fields = fields_of(lines[1]);
  ASSERT_EQ(fields.size(), 29U);
  EXPECT_EQ(fields[0], "gc");
  EXPECT_EQ(fields[1], "3");
  const std::vector<double> numbers = {2.0 / 3, 2.0 / 7, 0.4,  // the selection
                                       0.1,     1.0 / 3, 5e-324, 1e300, 0.25, 1.0 / 7, 0.05,
                                       1,       0.5,                                        // the refined pose
                                       0,       1,                                          //
                                       2.0 / 3, 7,       9,      5.5,   0.1,  0.2,     0};  // the fit
  for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_EQ(parse_double(fields[i + 2]).value(), numbers[i]);
  EXPECT_EQ(fields[23], "") << "no threshold of the curve is large enough";
  EXPECT_EQ(fields[24], "0") << "a tenth of the diameter is not below a tenth";
  EXPECT_EQ(fields[25], "0");
  EXPECT_EQ(fields[26], "") << "it was not asked for";
  EXPECT_EQ(fields[27], "saved");
  EXPECT_EQ(fields[28], "refined");
}

TEST(MethodsCsv, WhatIsUndefinedIsEmpty) {
  MethodRecord record = full_record();
  record.score = GroupingScore{9, 0, 0, 7, std::nullopt, 0.0, 0.0};
  record.found.selected.clear();
  record.errors.reset();
  record.initial_errors.reset();
  record.pose = RefinedPose();
  EXPECT_EQ(lines_of(methods_csv({record}))[1], "gc,0,,0,0,0.1,,,,,,,0,,0,0,,,,,,,0,,0,0,,lost,too few rows");
  record.score.reset();
  EXPECT_EQ(lines_of(methods_csv({record}))[1], "gc,0,,,,0.1,,,,,,,,,,,,,,,,,,,,,,,too few rows");
}

TEST(MethodsCsv, AFailureIsARowWithoutNumbers) {
  const auto lines = lines_of(methods_csv({full_record(), failed_record()}));
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[2], "ss,,,,,,,,,,,,,,,,,,,,,,,,,,,,failed: a ;b;; c;d");
}

TEST(MethodsText, HasARowPerMethod) {
  MethodRecord failed = failed_record();
  failed.failure = "no table";
  const auto lines = lines_of(methods_text({full_record(), failed}));
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_THAT(lines[0], StartsWith("grouper  selected  precision"));
  EXPECT_THAT(lines[1], StartsWith("gc              3      0.667"));
  EXPECT_THAT(lines[1], EndsWith("refined"));
  EXPECT_THAT(lines[2], StartsWith("ss              -          -"));
  EXPECT_THAT(lines[2], EndsWith("failed: no table"));
}

TEST(MethodsText, LeavesColumnsOutThatAreEmpty) {
  MethodRecord record = full_record();
  record.errors->points->rmse_pr = 2;
  EXPECT_EQ(
      lines_of(methods_text({record}))[0],
      "grouper  selected  precision  recall     F1  time ms  fit err pr  rot err deg  transl err pr  mean err pr  "
      "RMSE pr     ADD  outcome  status");
  record.score.reset();
  record.errors.reset();
  record.initial_errors.reset();
  EXPECT_EQ(methods_text({record}), "grouper  selected  time ms  status\ngc              3     0.10  refined\n");
}

TEST(ToJson, AMethodHasItsKeysInOrder) {
  std::vector<std::string> keys;
  const Json json = to_json(full_record());
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  EXPECT_THAT(
      keys, ElementsAre("method", "selected", "precision", "recall", "f1", "time_ms", "rotation_error_deg",
                        "translation_error_pr", "rmse_pr", "mean_error_pr", "add_share", "add_s_share", "success_5pr",
                        "success_from_pr", "success_add", "success_add_s", "initial_rotation_error_deg",
                        "initial_translation_error_pr", "initial_rmse_pr", "initial_mean_error_pr", "initial_add_share",
                        "initial_add_s_share", "initial_success_5pr", "initial_success_from_pr", "initial_success_add",
                        "initial_success_add_s", "confidence", "outcome", "status"));
  EXPECT_EQ(json["selected"].dump(), "3");
  EXPECT_EQ(json["rmse_pr"], 1e300);
}

TEST(ToJson, AFailureHasNothingButItsStatus) {
  const Json json = to_json(failed_record());
  EXPECT_EQ(json["status"], "failed: a \"b\", c\nd");
  for (const auto& [key, value] : json.items()) EXPECT_EQ(value.is_null(), key != "method" && key != "status") << key;
}

/// The members of a pose's errors, in order, as they are in JSON.
std::string errors_of(const std::optional<PoseErrors>& errors, bool is_judged) {
  Json json = Json::object();
  add_errors(json, "a_", errors, is_judged);
  std::string text;
  for (const auto& [key, value] : json.items()) text += (text.empty() ? "" : " ") + value.dump();
  return text;
}

TEST(AddErrors, SuccessStartsAtTheFirstThresholdThatHolds) {
  EXPECT_EQ(errors_of(PoseErrors{1, 2, PointError{3, 1.2}, 0.2, {}, 0.05}, true),
            "1.0 2.0 3.0 1.2 0.2 0.05 true 1.5 false true");
  EXPECT_EQ(errors_of(PoseErrors{1, 2, PointError{9, 5}, 0.1, {}}, true),
            "1.0 2.0 9.0 5.0 0.1 null true 5.0 false null");
  EXPECT_EQ(errors_of(PoseErrors{1, 2, PointError{3, 5.01}, 0.05, {}}, true),
            "1.0 2.0 3.0 5.01 0.05 null false null true null");
}

TEST(AddErrors, NoPoseHasFailedIfItWasJudged) {
  EXPECT_EQ(errors_of(std::nullopt, true), "null null null null null null false null false false");
  EXPECT_EQ(errors_of(std::nullopt, false), "null null null null null null null null null null");
}

TEST(AddErrors, WithoutPointsSuccessIsUnknown) {
  EXPECT_EQ(errors_of(PoseErrors{1, 2, std::nullopt, std::nullopt, {}}, false),
            "1.0 2.0 null null null null null null null null");
  EXPECT_EQ(errors_of(PoseErrors{1, 2, PointError{3, 1}, std::nullopt, {}}, true),
            "1.0 2.0 3.0 1.0 null null true 1.0 null null");
}

TEST(Dense, HasTheSameScores) {
  MethodRecord record = full_record();
  record.dense = RefinedSurface();
  record.dense->status = SurfaceStatus::Refined;
  record.dense->after = {0.5, 0.25};
  record.dense_errors = PoseErrors{1, 2, PointError{4, 3}, 0.05, {}};
  const Json dense = to_json(record)["dense"];
  EXPECT_EQ(dense["overlap"], 0.5);
  EXPECT_EQ(dense["mean_error_pr"], 3);
  EXPECT_EQ(dense["success_from_pr"], 3);
  EXPECT_EQ(dense["success_add"], true);
  EXPECT_EQ(lines_of(dense_csv({record, failed_record()})),
            (std::vector<std::string>{
                "method,overlap_before,overlap,residual_before_pr,residual_pr,rotation_error_deg,translation_error_pr,"
                "rmse_pr,mean_error_pr,add_share,add_s_share,success_5pr,success_from_pr,success_add,success_add_s,"
                "condition,status",
                "gc,0,0.5,0,0.25,1,2,4,3,0.05,,1,3,1,,0,refined", "ss,,,,,,,,,,,,,,,,no pose to start from"}));
  EXPECT_THAT(dense_text({record}), HasSubstr("gc"));
}

TEST(ToJson, APoseThatIsAbsentIsNull) {
  const Json json = pose_json(MethodRecord());
  EXPECT_EQ(json["status"], "too few rows");
  for (const char* key : {"target_from_source", "rotation_error_deg", "translation_error_pr", "rmse_pr",
                          "mean_error_pr", "success_5pr", "initial", "initial_rmse_pr", "initial_rms_pr",
                          "final_rms_pr", "initial_cost", "final_cost", "condition", "covariance"})
    EXPECT_TRUE(json.at(key).is_null()) << key;
}

}  // namespace
}  // namespace corral
