// SPDX-License-Identifier: MIT
#include "apps/advise/advise.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "io/disk/file.h"
#include "io/matches/matches_file.h"
#include "io/pose/transform_file.h"
#include "kernel/error.h"
#include "kernel/synthetic.h"
#include "tests/support/program.h"

namespace corral {
namespace {

using ::testing::HasSubstr;
using testing::Workplace;

/// A data set of tables with this share of correct matches.
Dataset tables(const Workplace& place, int count, double share, bool with_truth) {
  Dataset set;
  for (int i = 0; i < count; ++i) {
    SyntheticOptions options;
    options.matches = 200;
    options.inlier_ratio = share;
    options.seed = static_cast<std::uint64_t>(i + 1);
    const SyntheticProblem problem = make_synthetic_problem(options);
    const std::string name = "t" + std::to_string(i);
    write_file(place / (name + ".csv"), matches_text(problem.matches));
    write_file(place / (name + ".txt"), transform_text(problem.truth));
    set.pairs.push_back({name, "", "", with_truth ? place / (name + ".txt") : "", {}, place / (name + ".csv")});
  }
  return set;
}

const MethodOutcome& outcome(const Advice& advice, const std::string& method) {
  return *std::find_if(advice.methods.begin(), advice.methods.end(),
                       [&](const MethodOutcome& each) { return each.method == method; });
}

TEST(Advise, CountsWhatEachMethodRegisters) {
  const Workplace place;
  AdviceOptions options;
  options.sample = 3;
  const Advice advice = advise(tables(place, 7, 0.3, true), options);
  EXPECT_TRUE(advice.by_truth);
  EXPECT_EQ(advice.facts.pairs, 7);
  EXPECT_EQ(advice.facts.sampled, 3);
  EXPECT_EQ(advice.facts.judged, 3);
  EXPECT_NEAR(advice.facts.correct_percent->median, 30, 1);
  EXPECT_EQ(advice.methods.size(), 17U);
  EXPECT_EQ(advice.methods.front().registered, 3);
  EXPECT_EQ(advice.perfect.registered, 3);
  EXPECT_LT(advice.methods.front().low, 0.5) << "three pairs say little";
  EXPECT_EQ(advice.methods.front().high, 1);
  for (std::size_t i = 1; i < advice.methods.size(); ++i)
    EXPECT_GE(advice.methods[i - 1].success, advice.methods[i].success);
  EXPECT_FALSE(advice.ties().empty());
}

TEST(Advise, WithoutTruthsSurePosesJudge) {
  const Workplace place;
  const Advice sure = advise(tables(place, 2, 0.4, false), {});
  EXPECT_FALSE(sure.by_truth);
  EXPECT_EQ(sure.facts.judged, 2);
  EXPECT_EQ(outcome(sure, "gc").registered, 2);
  const Advice none = advise(tables(place, 2, 0, false), {});
  EXPECT_EQ(none.facts.judged, 0);
  EXPECT_THAT(advice_text(none, {}), HasSubstr("nothing to judge methods by"));
  EXPECT_TRUE(to_json(none)["use"].is_null());
}

TEST(Advise, ABudgetLeavesSlowMethodsOut) {
  const Workplace place;
  AdviceOptions options;
  options.budget_ms = 1e-6;
  const Advice none = advise(tables(place, 1, 0.4, true), options);
  EXPECT_FALSE(none.methods.front().is_affordable);
  EXPECT_THAT(advice_text(none, options), HasSubstr("No method stays within"));
}

TEST(Advise, APairThatCannotBeReadIsNamed) {
  const Workplace place;
  Dataset set = tables(place, 2, 0.4, true);
  set.pairs[0].matches = place / "none.csv";
  const Advice advice = advise(set, {});
  EXPECT_EQ(advice.facts.sampled, 1);
  ASSERT_EQ(advice.facts.failures.size(), 1U);
  EXPECT_THAT(advice.facts.failures[0], HasSubstr("none.csv"));
  set.pairs.resize(1);
  EXPECT_THROW(advise(set, {}), InvalidInput);
}

TEST(Advise, TriesOtherKeypointsWhereThereAreSurfaces) {
  const Workplace place;
  place.put_pair();
  const auto outcome = place.corral("advise model.ply copy.ply --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto others = outcome.json()["other_matchings"];
  ASSERT_FALSE(others.empty());
  EXPECT_EQ(others[0]["name"], "keypoints at half the spacing");
  EXPECT_GT(others[0]["correct_ratio"].get<double>(), 1.5);
  EXPECT_EQ(outcome.json()["facts"]["judged"], 1);
  EXPECT_THAT(place.corral("advise model.ply copy.ply").out, HasSubstr("use "));
}

TEST(Advise, WhatIsWrongIsSaid) {
  const Workplace place;
  place.put_problem();
  EXPECT_EQ(place.corral("advise matches.csv --prefer recall").status, 0);
  EXPECT_EQ(place.corral("advise matches.csv --sample 0").status, 2);
  EXPECT_EQ(place.corral("advise matches.csv --budget-ms -1").status, 2);
  EXPECT_EQ(place.corral("advise a.ply").status, 2);
  EXPECT_EQ(place.corral("advise none.csv").status, 3);
}

}  // namespace
}  // namespace corral
