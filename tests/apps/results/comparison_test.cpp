// SPDX-License-Identifier: MIT
#include "apps/results/comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/runtime/workers.h"
#include "kernel/error.h"
#include "kernel/random.h"
#include "tests/support/program.h"
#include "tests/support/simulated_run.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::Scores;
using ::testing::StartsWith;
using testing::step;

/// GC is better than ST by 0.2 on every pair, NNSR by chance now above and now below ST; the others are as ST.
StudyFolder run_of(bool same_pairs) {
  StudyFolder run;
  testing::add_experiment(run, {"noise",
                                "b3r",
                                {step(0.1), step(0.2)},
                                12,
                                same_pairs,
                                0.2,
                                [](const std::string& method, const StudyLevel& level, int pair) {
                                  const double st = 0.3 + 0.03 * pair;
                                  if (method == "gc") return Scores{st + 0.2, 0.5};
                                  const double sign = (pair + (level.low > 0.15)) % 2 == 0 ? 1 : -1;
                                  return Scores{method == "nnsr" ? st + sign * 0.01 * (1 + pair) : st, 0.5};
                                }});
  return run;
}

const MethodPair& find(const MethodComparison& comparison, const std::string& first, const std::string& second) {
  for (const MethodPair& pair : comparison.tests)
    if (pair.first == first && pair.second == second) return pair;
  throw InvalidInput("test", "pair", first + " " + second, "one that was tested");
}

TEST(Comparison, IsTheSameForAnyNumberOfThreads) {
  const ExperimentTable table = experiment_tables(run_of(false)).at(0);
  const MethodComparison one = compare_methods(table, measure("f1")),
                         three = compare_methods(table, measure("f1"), workers(3));
  ASSERT_EQ(one.tests.size(), 21u);
  ASSERT_EQ(three.tests.size(), 21u);
  for (std::size_t i = 0; i < one.tests.size(); ++i) {
    EXPECT_EQ(three.tests[i].first + three.tests[i].second, one.tests[i].first + one.tests[i].second);
    EXPECT_EQ(three.tests[i].difference.low, one.tests[i].difference.low);
    EXPECT_EQ(three.tests[i].adjusted_p, one.tests[i].adjusted_p);
  }
  ASSERT_EQ(three.levels.size(), one.levels.size());
  for (std::size_t i = 0; i < one.levels.size(); ++i) EXPECT_EQ(three.levels[i].mean.high, one.levels[i].mean.high);
  EXPECT_EQ(rank_methods(table, measure("f1")).ranks.average_ranks, one.ranks.average_ranks);
}

TEST(Comparison, MeasuresOfALevelAreDrawnAsIfAlone) {
  const LevelTable level = experiment_tables(run_of(false)).at(0).levels.at(0);
  const Measure &f1 = measure("f1"), &precision = measure("precision"), &time = measure("time_ms");
  const auto all = level_means("noise", level, "nnsr", {&f1, &time, &precision});
  const auto alone = level_means("noise", level, "nnsr", {&precision});
  EXPECT_FALSE(all.at(1)) << "no time was taken";
  EXPECT_EQ(all.at(2)->low, alone.at(0)->low);
  EXPECT_EQ(all.at(2)->high, alone.at(0)->high);
  EXPECT_NE(all.at(0)->low, alone.at(0)->low);
}

TEST(Comparison, TellsDifferenceFromChance) {
  const MethodComparison comparison = compare_methods(experiment_tables(run_of(false)).at(0), measure("precision"));
  EXPECT_EQ(comparison.pairs, 24);
  EXPECT_EQ(comparison.tests.size(), 21u);
  const MethodPair& clear = find(comparison, "st", "gc");
  EXPECT_NEAR(clear.difference.mean, -0.2, 1e-12);
  EXPECT_NEAR(clear.difference.high, -0.2, 1e-12);
  EXPECT_LT(clear.adjusted_p, 0.001);
  EXPECT_GE(clear.adjusted_p, clear.p);
  const MethodPair& chance = find(comparison, "nnsr", "st");
  EXPECT_GT(chance.p, 0.5);
  EXPECT_LT(chance.difference.low, 0);
  EXPECT_GT(chance.difference.high, 0);
  EXPECT_EQ(find(comparison, "ss", "ransac").p, 1);  // nothing differs
  EXPECT_EQ(comparison.ranks.average_ranks[4], 1);   // gc
  EXPECT_LT(comparison.ranks.p, 1e-6);
  EXPECT_EQ(comparison.levels.size(), 14u);
  EXPECT_EQ(comparison.levels[4].pairs, 12);
  EXPECT_NEAR(comparison.levels[4].mean.mean, 0.3 + 0.03 * 5.5 + 0.2, 1e-12);
}

TEST(Comparison, TakesAPairAtSeveralLevelsAsOne) {
  const MethodComparison comparison = compare_methods(experiment_tables(run_of(true)).at(0), measure("precision"));
  EXPECT_EQ(comparison.pairs, 12);
  EXPECT_NEAR(find(comparison, "nnsr", "st").difference.mean, 0, 1e-12);  // above at one level and below at the other
  EXPECT_LT(find(comparison, "st", "gc").p, 0.01);
}

TEST(Comparison, TestsSuccessesByMcNemar) {
  // A success is a precision above 0.5: ST on the pairs 7 .. 11, GC on 1 .. 11.
  const MethodComparison comparison = compare_methods(experiment_tables(run_of(false)).at(0), measure("success_5pr"));
  const MethodPair& pair = find(comparison, "st", "gc");
  EXPECT_NEAR(pair.difference.mean, -6 / 12.0, 1e-12);
  EXPECT_NEAR(pair.p, 2 / 4096.0, 1e-12);  // 12 pairs are GC's alone, none ST's
  EXPECT_TRUE(pair.is_exact);
}

TEST(Comparison, LeavesOutPairsThatAMethodLacks) {
  StudyFolder run = run_of(false);
  const auto is_lost = [](const StudyRecord& record) { return record.method == "si" && record.pair == "pair0 at 0.1"; };
  run.records.erase(std::remove_if(run.records.begin(), run.records.end(), is_lost), run.records.end());
  for (StudyRecord& record : run.records)
    if (record.pair == "pair1 at 0.1") record.true_matches = 0;
  EXPECT_EQ(compare_methods(experiment_tables(run).at(0), measure("f1")).pairs, 22);
}

TEST(Comparison, HasNothingToSayOfOneMethod) {
  StudyFolder run = run_of(false);
  run.experiments[0].methods = {"gc"};
  const MethodComparison comparison = compare_methods(experiment_tables(run).at(0), measure("f1"));
  EXPECT_TRUE(comparison.tests.empty());
  EXPECT_EQ(comparison.levels.size(), 2u);
  EXPECT_THROW(metric_of("f2"), InvalidInput);
}

TEST(CompareCommand, PrintsTablesAndJson) {
  const testing::Workplace place;
  StudyFolder run = run_of(false);
  run.folder = place / "run";
  testing::write_run(run);
  const testing::Outcome text = place.corral("compare run --metric precision");
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_THAT(text.out, StartsWith("noise: precision on 24 pairs"));
  EXPECT_THAT(text.out, HasSubstr("st - gc"));
  EXPECT_THAT(text.out, HasSubstr("Friedman"));
  const auto json = place.corral("compare run --metric success --json").json();
  EXPECT_THAT(
      testing::keys_of(json.at("experiments").at(0)),
      ElementsAre("cliques", "critical_difference", "experiment", "friedman", "levels", "methods", "pairs", "tests"));
  EXPECT_EQ(json.at("experiments").at(0).at("tests").size(), 21u);
  EXPECT_EQ(place.corral("compare run --experiment density").status, 2);
  EXPECT_EQ(place.corral("compare run --metric f2").status, 2);
  EXPECT_EQ(place.corral("compare nowhere").status, 3);
}

TEST(ClaimsCommand, PrintsVerdictsAndSlips) {
  const testing::Workplace place;
  StudyFolder run = testing::simulated_study(5, 6);
  run.folder = place / "run";
  testing::write_run(run);
  const testing::Outcome text = place.corral("claims run");
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_THAT(text.out, StartsWith("noise (a)\n"));
  for (const char* expected : {"\nC69 ", "75 claims: ", ", 0 undecidable", "\n10. "})
    EXPECT_THAT(text.out, HasSubstr(expected));
  const auto json = place.corral("claims run --json").json();
  ASSERT_EQ(json.at("claims").size(), 75u);
  EXPECT_EQ(json.at("slips").size(), 10u);
  for (const auto& claim : json.at("claims")) EXPECT_TRUE(claim.at("margin").is_number()) << claim.at("id");
  EXPECT_EQ(place.corral("claims run run").status, 3);
  EXPECT_EQ(place.corral("claims nowhere").status, 3);
}

TEST(ClaimsCommand, ReadsClaimsOfOnesOwn) {
  const testing::Workplace place;
  StudyFolder run = run_of(false);
  run.folder = place / "run";
  testing::write_run(run);
  const std::string head = "methods = [\"gc\", \"st\"]\n[[claim]]\nid = \"mine\"\nparts = [{ experiment = \"noise\", ";
  place.put("mine.toml", head + "of = \"precision\", is = [\"gc >= st + 0.15\"] }]\n");
  const auto claim = place.corral("claims run --claims mine.toml --json").json().at("claims").at(0);
  EXPECT_EQ(claim.at("verdict"), "holds");
  EXPECT_NEAR(claim.at("margin").get<double>(), 0.05, 1e-12);
  EXPECT_EQ(claim.at("parts").at(0).at("levels"), "2 of 2 levels: 0.1 0.2");
  place.put("wrong.toml", head + "of = \"precison\", is = [\"gc >= st\"] }]\n");
  const testing::Outcome wrong = place.corral("claims run --claims wrong.toml");
  EXPECT_EQ(wrong.status, 3);
  EXPECT_THAT(wrong.err, HasSubstr("wrong.toml, line 4"));
}

}  // namespace
}  // namespace corral
