// SPDX-License-Identifier: MIT
#include "apps/results/measures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "apps/results/summary.h"
#include "kernel/error.h"

namespace corral {
namespace {

using ::testing::IsNan;

StudyRecord judged() {
  StudyRecord record;
  record.matches = 8, record.true_matches = 4;
  return record;
}

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::count(names.begin(), names.end(), name) > 0;
}

TEST(Measures, AreNamedOnceAndCanBeHadOrWorkedOut) {
  std::set<std::string> names, words;
  for (const Measure& measure : measures()) {
    EXPECT_TRUE(names.insert(measure.name).second) << measure.name;
    EXPECT_TRUE(words.insert(measure.word()).second) << measure.name;
    const bool is_pooled = measure.average == Average::Pooled;
    EXPECT_EQ(measure.stored.is_anywhere() + (measure.derived != nullptr) + is_pooled, 1) << measure.name;
    if (is_pooled) {
      EXPECT_NO_THROW(corral::measure(measure.pooled_of.first)) << measure.name;
      EXPECT_NO_THROW(corral::measure(measure.pooled_of.second)) << measure.name;
    }
    EXPECT_TRUE(!measure.has(kHeadline) || measure.average == Average::Mean) << measure.name;
  }
  EXPECT_THROW(measure("f2"), InvalidInput);
}

TEST(Measures, WhatIsStoredIsAColumnAndWhatIsAveragedStandsInTheSummary) {
  std::vector<std::string> summary;
  for (const SummaryCell& cell : summary_cells({})) summary.push_back(cell.name);
  for (const Measure& measure : measures()) {
    EXPECT_EQ(measure.stored.is_anywhere(), has(record_columns(), measure.name)) << measure.name;
    EXPECT_EQ(measure.average != Average::None, has(summary, measure.name)) << measure.name;
    EXPECT_EQ(measure.has(kHeadline), has(summary, measure.name + "_high")) << measure.name;
  }
}

TEST(Measures, AreReadOffARecord) {
  StudyRecord record = judged();
  record.precision = 0.25, record.time_ms = 3, record.refined.mean_error_pr = 5, record.dense.rotation_error_deg = 2;
  EXPECT_EQ(measure("matches").of(record), 8);
  EXPECT_EQ(measure("precision").of(record), 0.25);
  EXPECT_EQ(measure("precision_nonempty").of(record), 0.25);
  EXPECT_EQ(measure("inlier_ratio").of(record), 0.5);
  EXPECT_EQ(measure("time_ms").of(record), 3);
  EXPECT_EQ(measure("refined_mean_error_pr").of(record), 5);
  EXPECT_EQ(measure("success_5pr").of(record), 1);        // at most 5 pr
  EXPECT_EQ(measure("dense_success_5pr").of(record), 0);  // a pose without a mean error: over no point
  EXPECT_FALSE(measure("initial_success_5pr").of(record));
  record.refined.mean_error_pr = 5.01;
  EXPECT_EQ(measure("success_5pr").of(record), 0);
  record.matches = 0, record.true_matches = 0;
  EXPECT_FALSE(measure("inlier_ratio").of(record));
}

TEST(Measures, AMeanTakesAnAbsentNumberAsTheTableSays) {
  const StudyRecord nothing = judged();
  const auto number = [&](const std::string& name) { return counted_number(measure(name), nothing, PairRole::Judged); };
  for (const char* name : {"precision", "recall", "f1", "success_5pr", "success_area", "selected", "correct"})
    EXPECT_EQ(number(name), 0) << name;
  for (const char* name : {"precision_nonempty", "time_ms"}) EXPECT_THAT(number(name), IsNan()) << name;
  for (const char* name : {"refined_rotation_error_deg", "initial_mean_error_pr"})
    EXPECT_EQ(number(name), std::numeric_limits<double>::infinity()) << name;
}

TEST(Measures, OnlyJudgedPairsHaveNumbersThatNeedATruth) {
  StudyRecord record = judged();
  record.precision = 0.5, record.selected = 3, record.time_ms = 2;
  for (const PairRole role : {PairRole::Excluded, PairRole::Failed}) {
    EXPECT_THAT(counted_number(measure("precision"), record, role), IsNan());
    EXPECT_THAT(counted_number(measure("selected"), record, role), IsNan());
    EXPECT_EQ(counted_number(measure("time_ms"), record, role), 2);  // that does not depend on the pair
  }
  record.precision = std::nullopt;
  EXPECT_THAT(counted_number(measure("precision"), record, PairRole::Unjudged), IsNan());
  EXPECT_THAT(counted_number(measure("success_area"), record, PairRole::Unjudged), IsNan());
  EXPECT_EQ(counted_number(measure("selected"), record, PairRole::Unjudged), 3);
}

TEST(PairRole, IsDecidedByTheMatchesAndTheTruth) {
  StudyRecord record = judged();
  EXPECT_EQ(role_of(record, 4), PairRole::Judged);
  EXPECT_EQ(role_of(record, 5), PairRole::Excluded);
  record.true_matches = 0;
  EXPECT_EQ(role_of(record, 0), PairRole::Excluded);  // whatever is asked for, recall needs one
  record.true_matches.reset();
  EXPECT_EQ(role_of(record, 5), PairRole::Unjudged);
  record.matches.reset();
  EXPECT_EQ(role_of(record, 5), PairRole::Failed);
}

}  // namespace
}  // namespace corral
