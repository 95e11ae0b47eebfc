// SPDX-License-Identifier: MIT
// The criteria that the field states in degrees and metres, and quantiles of errors.
#include <gtest/gtest.h>

#include "apps/results/measures.h"
#include "apps/results/summary.h"

namespace corral {
namespace {

StudyRecord record_with(double rotation_deg, double translation_pr, double metres_per_pr) {
  StudyRecord record;
  record.experiment = "e", record.dataset = "d", record.level = "1", record.method = "gc";
  record.status = {MethodState::Refined};
  record.matches = 10, record.true_matches = 5, record.selected = 4, record.correct = 3;
  record.refined.rotation_error_deg = rotation_deg;
  record.refined.translation_error_pr = translation_pr;
  record.refined.rmse_pr = translation_pr;
  record.metres_per_pr = metres_per_pr;
  return record;
}

TEST(FieldCriteria, AreInDegreesAndMetresInclusive) {
  const auto value = [](const char* name, const StudyRecord& record) { return *measure(name).of(record); };
  // A pr of an eighth of a metre, so that 2.4 pr are 0.3 m to the last bit.
  EXPECT_EQ(value("success_3dmatch", record_with(15, 2.4, 0.125)), 1);
  EXPECT_EQ(value("success_3dmatch", record_with(15.001, 2.4, 0.125)), 0);
  EXPECT_EQ(value("success_3dmatch", record_with(15, 2.401, 0.125)), 0);
  EXPECT_EQ(value("success_3dmatch_rmse", record_with(90, 1.6, 0.125)), 1);
  EXPECT_EQ(value("success_3dmatch_rmse", record_with(0, 1.601, 0.125)), 0);
  EXPECT_EQ(value("success_kitti", record_with(5, 4.8, 0.125)), 1);
  EXPECT_EQ(value("success_kitti", record_with(5, 4.801, 0.125)), 0);
  EXPECT_EQ(value("success_kitti_2m", record_with(5, 16, 0.125)), 1);
  EXPECT_EQ(value("success_kitti_2m", record_with(5.001, 16, 0.125)), 0);
}

TEST(FieldCriteria, AreAbsentWithoutMetresOrAPose) {
  StudyRecord record = record_with(1, 1, 0.1);
  record.metres_per_pr = std::nullopt;
  for (const char* name : {"success_3dmatch", "success_3dmatch_rmse", "success_kitti", "success_kitti_2m"})
    EXPECT_FALSE(measure(name).of(record)) << name;
  record = record_with(1, 1, 0.1);
  record.refined = {};
  for (const char* name : {"success_3dmatch", "success_kitti", "success_add"})
    EXPECT_EQ(counted_number(measure(name), record, PairRole::Judged), 0) << "no pose is a failure: " << name;
}

TEST(FieldCriteria, StandInTheSummaryWithQuantilesOfErrors) {
  ExperimentInfo info;
  info.name = "e", info.dataset = "d", info.levels = {{"1", 1, 1}}, info.methods = {"gc"};
  StudyFolder run;
  run.experiments = {info};
  for (int i = 0; i < 21; ++i) {  // errors of 0 .. 20 degrees and as many pr
    run.records.push_back(record_with(i, i, 0.125));
    run.records.back().pair = "p" + std::to_string(i);
    run.records.back().refined.mean_error_pr = i;
  }
  const SummaryRow row = summarize(experiment_tables(run)).at(0);
  EXPECT_EQ(row.of("refined_rotation_error_deg").value, 10);
  EXPECT_EQ(row.of("refined_rotation_error_deg_q75").value, 15);
  EXPECT_EQ(row.of("refined_translation_error_pr_q95").value, 19);
  EXPECT_DOUBLE_EQ(*row.of("success_3dmatch").value, 3.0 / 21);   // up to 2.4 pr
  EXPECT_DOUBLE_EQ(*row.of("success_kitti_2m").value, 6.0 / 21);  // up to 5 degrees
  run.records[0].refined = {};                                    // no pose: the largest error there is
  EXPECT_EQ(summarize(experiment_tables(run)).at(0).of("refined_mean_error_pr_q75").value, 16);
}

TEST(FieldCriteria, AreAveragedOverScenesToo) {
  ExperimentInfo info;
  info.name = "e", info.dataset = "d", info.levels = {{"1", 1, 1}}, info.methods = {"gc"};
  StudyFolder run;
  run.experiments = {info};
  const auto add = [&](const char* scene, double translation_pr) {
    run.records.push_back(record_with(0, translation_pr, 0.125));
    run.records.back().pair = "p" + std::to_string(run.records.size());
    run.records.back().scene = scene;
  };
  for (const double error : {1, 1, 1, 9}) add("kitchen", error);  // 2.4 pr are 0.3 m
  add("lounge", 9);
  add("", 1);  // belongs to none
  SummaryRow row = summarize(experiment_tables(run)).at(0);
  EXPECT_DOUBLE_EQ(*row.of("success_3dmatch").value, 4.0 / 6);
  EXPECT_DOUBLE_EQ(*row.of("success_3dmatch_scenes").value, (0.75 + 0) / 2);
  EXPECT_DOUBLE_EQ(*row.of("success_3dmatch_rmse_scenes").value, (0.75 + 0) / 2);
  run.records[4].refined = {};  // no pose is a failure there too
  EXPECT_DOUBLE_EQ(*summarize(experiment_tables(run)).at(0).of("success_3dmatch_scenes").value, 0.375);
  for (StudyRecord& record : run.records) record.scene = "";
  EXPECT_FALSE(summarize(experiment_tables(run)).at(0).of("success_3dmatch_scenes").value);
}

TEST(FieldCriteria, AddSRecognisesBelowATenth) {
  StudyRecord record = record_with(1, 1, 0.1);
  EXPECT_FALSE(measure("success_add_s").of(record));
  record.refined.add_s_share = 0.0999;
  record.refined.add_share = 0.5;
  EXPECT_EQ(measure("success_add_s").of(record), 1);
  EXPECT_EQ(measure("success_add").of(record), 0);
  record.refined.add_s_share = 0.1;
  EXPECT_EQ(measure("success_add_s").of(record), 0);
}

}  // namespace
}  // namespace corral
