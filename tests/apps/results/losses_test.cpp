// SPDX-License-Identifier: MIT
#include "apps/results/losses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace corral {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

ExperimentInfo info_of(const std::vector<std::string>& methods = {"gc"}) {
  ExperimentInfo info;
  info.name = "e", info.dataset = "d", info.methods = methods;
  info.levels = {{"1", 1, 1}, {"2", 2, 2}};
  return info;
}

/// A method that kept 4 of 5 correct matches; mean errors in pr, absent without a pose.
StudyRecord record_of(const std::string& pair, const std::string& method, std::optional<double> fit,
                      std::optional<double> refined, int correct = 4) {
  StudyRecord record;
  record.experiment = "e", record.dataset = "d", record.level = "1", record.pair = pair, record.method = method;
  record.status = {refined ? MethodState::Refined : MethodState::TooFewRows};
  record.truth = "fits", record.matches = 100, record.keypoints_in_overlap = 50, record.true_matches = 5;
  record.selected = 5, record.correct = correct, record.precision = correct / 5.0;
  record.initial.mean_error_pr = fit, record.refined.mean_error_pr = refined;
  return record;
}

StudyRecord oracle_of(const std::string& pair, std::optional<double> refined) {
  return record_of(pair, "oracle", refined, refined, 5);
}

std::vector<LossRow> rows_of(const std::vector<StudyRecord>& records,
                             const std::vector<std::string>& methods = {"gc"}) {
  return losses_of({"", {info_of(methods)}, {}, records});
}

/// Of gc at the first level, on one pair: the stage that it ended at.
std::string stage_of_pair(const StudyRecord& record, const StudyRecord& oracle) {
  const LossRow row = rows_of({record, oracle}).front();
  EXPECT_EQ(row.method, "gc");
  EXPECT_EQ(row.pairs, 1);
  std::string ended;
  for (std::size_t stage = 0; stage < kStages; ++stage)
    if (row.ended[stage] == 1) ended += to_text(static_cast<Stage>(stage));
  return ended;
}

const StudyRecord kGood = oracle_of("a", 0.5), kBad = oracle_of("a", 5.01);

TEST(Losses, APairIsRegisteredByItsRefinedPose) {
  EXPECT_EQ(stage_of_pair(record_of("a", "gc", 1, 5), kGood), "registered") << "the limit is inclusive";
  EXPECT_EQ(stage_of_pair(record_of("a", "gc", 80, 1), kGood), "registered");
  EXPECT_EQ(stage_of_pair(record_of("a", "gc", 1, 1), kBad), "registered") << "although the oracle does not";
}

TEST(Losses, WhereAPerfectSelectionFailsTheMatchesOrKeypointsDo) {
  StudyRecord few = kBad;
  EXPECT_EQ(stage_of_pair(record_of("a", "gc", 9, 9), few), "matches");
  few.keypoints_in_overlap = 20;
  EXPECT_EQ(stage_of_pair(record_of("a", "gc", 9, 9), few), "matches");
  few.keypoints_in_overlap = 19;
  EXPECT_EQ(stage_of_pair(record_of("a", "gc", 9, 9), few), "keypoints");
  few.keypoints_in_overlap.reset();
  EXPECT_EQ(stage_of_pair(record_of("a", "gc", 9, 9), few), "matches") << "a table of matches";
}

TEST(Losses, APairThatIsExcludedFromMeansIsLostAtItsMatches) {
  StudyRecord nothing = record_of("a", "gc", {}, {}, 0), oracle = oracle_of("a", {});
  nothing.true_matches = oracle.true_matches = 0;
  oracle.selected = oracle.correct = 0, oracle.precision = std::nullopt;
  EXPECT_EQ(stage_of_pair(nothing, oracle), "matches");
}

TEST(Losses, WhereAPerfectSelectionSucceedsTheGrouperOrTheRefinementFails) {
  EXPECT_EQ(stage_of_pair(record_of("a", "gc", 80, 80, 2), kGood), "grouping");
  EXPECT_EQ(stage_of_pair(record_of("a", "gc", 80, 80, 4), kGood), "grouping") << "at rest at the wrong place";
  StudyRecord record = record_of("a", "gc", {}, {}, 4);
  record.status = {MethodState::DegenerateGeometry};
  EXPECT_EQ(stage_of_pair(record, kGood), "grouping");
  record.status = {MethodState::Diverged};
  EXPECT_EQ(stage_of_pair(record, kGood), "pose");
  record.correct = 2, record.precision = 0.4;
  EXPECT_EQ(stage_of_pair(record, kGood), "grouping");
  record = record_of("a", "gc", 80, 80, 4);
  record.status = {MethodState::NotConverged};
  EXPECT_EQ(stage_of_pair(record, kGood), "pose");
  EXPECT_EQ(stage_of_pair(record_of("a", "gc", 1, 6, 2), kGood), "pose") << "it left a good start";
  EXPECT_EQ(stage_of_pair(record_of("a", "gc", 1, 6, 2), kBad), "pose");
}

TEST(Losses, ATruthThatDoesNotFitCountsForAllWhateverTheirPoses) {
  StudyRecord record = record_of("a", "gc", 1, 1), oracle = kGood;
  record.truth = oracle.truth = "does not fit";
  EXPECT_EQ(stage_of_pair(record, oracle), "truth");
}

TEST(Losses, NoAnswerIsAFailure) {
  StudyRecord failed = record_of("a", "gc", {}, {});
  failed.status = {MethodState::Failed, "of the grouper"};
  EXPECT_EQ(stage_of_pair(failed, kGood), "failed");
  failed.status = {MethodState::TooLarge, "needs 8 GB"};
  EXPECT_EQ(stage_of_pair(failed, kGood), "failed");
  StudyRecord oracle = oracle_of("a", {});
  for (StudyRecord* record : {&failed, &oracle}) {
    record->status = {MethodState::Failed, "no such file"};
    record->matches.reset(), record->true_matches.reset(), record->truth = "";
  }
  EXPECT_EQ(stage_of_pair(failed, oracle), "failed") << "the pair could not be matched";
}

TEST(Losses, CountEachGrouperOverItsPairs) {
  const auto pair = [](const std::string& name, double gc, double oracle) {
    return std::vector<StudyRecord>{record_of(name, "gc", gc, gc), record_of(name, "hough", 80, 80, 1),
                                    oracle_of(name, oracle), record_of(name, "baseline", 80, 80, 1)};
  };
  std::vector<StudyRecord> records;
  for (const auto& [name, gc, oracle] : {std::tuple("a", 1., 1.), std::tuple("b", 80., 1.), std::tuple("c", 80., 80.)})
    for (const StudyRecord& record : pair(name, gc, oracle)) records.push_back(record);
  StudyRecord unjudged = record_of("d", "gc", {}, {});
  unjudged.true_matches.reset();
  records.push_back(unjudged);                                 // without bounds
  records[1].status = {MethodState::NotApplicable, "column"};  // hough on a
  const std::vector<LossRow> rows = rows_of(records, {"gc", "hough"});
  ASSERT_EQ(rows.size(), 8u);  // two levels
  EXPECT_EQ(rows[0].pairs, 3);
  EXPECT_EQ(rows[0].of(Stage::Registered), 1);
  EXPECT_EQ(rows[0].of(Stage::Grouping), 1);
  EXPECT_EQ(rows[0].of(Stage::Matches), 1);
  EXPECT_DOUBLE_EQ(rows[0].share(Stage::Matches), 1. / 3);
  EXPECT_EQ(rows[1].pairs, 2);
  EXPECT_EQ(rows[1].of(Stage::Grouping), 1);
  EXPECT_EQ(rows[2].method, "oracle");
  EXPECT_EQ(rows[2].of(Stage::Registered), 2);
  EXPECT_EQ(rows[2].of(Stage::Grouping), 0);
  EXPECT_EQ(rows[3].of(Stage::Grouping), 2) << "without any grouper";
  EXPECT_EQ(rows[4].level, "2");
  EXPECT_EQ(rows[4].pairs, 0);
  const std::string text = losses_text(rows);
  EXPECT_THAT(text, StartsWith("experiment,dataset,level,method,pairs,registered,keypoints,matches,grouping,pose,truth,"
                               "failed\ne,d,1,gc,3,0.3333333333333333,0,"));
  EXPECT_THAT(text, HasSubstr("\ne,d,2,gc,0,,,,,,,\n"));
}

TEST(Losses, RepeatsAreOnePairAndTablesOfOnePairAreSeveral) {
  StudyRecord again = record_of("a", "gc", 80, 80, 1);
  again.repeat = 1;
  const std::vector<StudyRecord> table = {record_of("a", "gc", 1, 1), again, kGood};
  std::vector<StudyRecord> records = table;
  records.insert(records.end(), table.begin(), table.end());
  EXPECT_EQ(rows_of(table)[0].pairs, 1);
  EXPECT_EQ(rows_of(table)[0].of(Stage::Registered), 0.5);
  EXPECT_EQ(rows_of(table)[0].of(Stage::Grouping), 0.5);
  EXPECT_EQ(rows_of(records)[0].pairs, 2);
  EXPECT_EQ(rows_of(records)[0].of(Stage::Registered), 1);
  EXPECT_EQ(rows_of(records)[1].pairs, 2);
}

TEST(Losses, OverLevelsAddsPairs) {
  StudyRecord other = record_of("a", "gc", 80, 80, 1), oracle = kGood;
  other.level = oracle.level = "2";
  const std::vector<LossRow> sums = over_levels(rows_of({record_of("a", "gc", 1, 1), kGood, other, oracle}));
  ASSERT_EQ(sums.size(), 3u);
  EXPECT_EQ(sums[0].method, "gc");
  EXPECT_EQ(sums[0].pairs, 2);
  EXPECT_EQ(sums[0].share(Stage::Registered), 0.5);
  EXPECT_EQ(sums[1].share(Stage::Registered), 1);
}

TEST(Losses, AStageForEveryCause) {
  EXPECT_EQ(stage_of(Cause::NormalsOpposed), Stage::Matches);
  EXPECT_EQ(stage_of(Cause::Spoiled), Stage::Pose);
  EXPECT_EQ(stage_of(Cause::NoAnswer), Stage::Failed);
}

}  // namespace
}  // namespace corral
