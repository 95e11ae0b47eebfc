// SPDX-License-Identifier: MIT
#include "apps/pair/explain.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace corral {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const PairCounts kCounts{500, 300, 40, 4};

PairCounts with_misfit() {
  PairCounts counts = kCounts;
  counts.misfit = "the truth fits inverted";
  return counts;
}

PairCounts with_opposed_normals(double share) {
  PairCounts counts{500, 300, 0, 4};
  counts.opposed_share = share;
  counts.source_side = "by the faces";
  counts.target_side = "towards the origin";
  return counts;
}

/// A judged record: mean errors of fit and refined pose in pr, below 0 where there is no such pose.
MethodRecord record_of(double fit, double refined, int selected = 30, int correct = 24) {
  MethodRecord record;
  record.method = "mine";
  record.score = GroupingScore{500, selected, correct, 40, std::nullopt, correct / 40.0, std::nullopt};
  if (selected > 0) record.score->precision = static_cast<double>(correct) / selected;
  const auto errors = [](double mean) { return PoseErrors{1, 1, PointError{2 * mean, mean}, std::nullopt, {}}; };
  if (fit >= 0) record.initial_errors = errors(fit), record.pose.initial = RigidTransform();
  record.pose.status = RefineStatus::Diverged;
  if (refined < 0) return record;
  record.errors = errors(refined);
  record.pose.target_from_source = RigidTransform();
  record.pose.status = RefineStatus::Refined;
  record.pose.converged = true;
  return record;
}

const MethodRecord kGoodOracle = record_of(0.1, 0.05, 40, 40);

Explanation explain(const MethodRecord& record, const MethodRecord& oracle = kGoodOracle,
                    const PairCounts& counts = kCounts) {
  const auto explanations = explain_pair(counts, oracle, {record});
  EXPECT_EQ(explanations.size(), 2U);
  EXPECT_EQ(explanations[0].method, "pair");
  EXPECT_EQ(explanations[1].method, "mine");
  return explanations[1];
}

Explanation explain_pair_of(const MethodRecord& oracle, const PairCounts& counts) {
  return explain_pair(counts, oracle, {}).at(0);
}

TEST(ExplainPair, APairThatTheOracleRegisters) {
  const Explanation pair = explain_pair_of(kGoodOracle, kCounts);
  EXPECT_EQ(pair.cause, Cause::Found);
  EXPECT_EQ(
      pair.text,
      "can be registered: 40 of 500 matches are correct within 4.0 pr, and the refinement of all of them ends at 0.05 "
      "pr; 300 of 500 matched source keypoints lie in the overlap (a pair is registered by a mean error over the "
      "overlap of at most 5 pr)");
  EXPECT_EQ(explain_pair_of(record_of(9, 5), kCounts).cause, Cause::Found) << "the limit is inclusive";
}

TEST(ExplainPair, TooFewKeypointsInTheOverlap) {
  const MethodRecord oracle = record_of(8, 7, 4, 4);
  const Explanation pair = explain_pair_of(oracle, {500, 19, 4, 4});
  EXPECT_EQ(pair.cause, Cause::TooFewKeypoints);
  EXPECT_THAT(pair.text, AllOf(HasSubstr("19 of 500 matched source keypoints lie in the overlap"), HasSubstr("20"),
                               HasSubstr("4 of 500 matches are correct within 4.0 pr")));
  EXPECT_EQ(explain_pair_of(oracle, {500, 20, 4, 4}).cause, Cause::TooFewTrueMatches);
  EXPECT_EQ(explain_pair_of(kGoodOracle, {500, 5, 4, 4}).cause, Cause::Found) << "few, but they were enough";
}

TEST(ExplainPair, TooFewTrueMatches) {
  MethodRecord oracle = record_of(-1, -1, 2, 2);
  oracle.pose.status = RefineStatus::TooFewRows;
  const Explanation two = explain_pair_of(oracle, {500, 300, 2, 4});
  EXPECT_EQ(two.cause, Cause::TooFewTrueMatches);
  EXPECT_THAT(two.text, HasSubstr("2 of 500 matches are correct within 4.0 pr, and a pose needs 3"));
  const Explanation bad = explain_pair_of(record_of(13, 12.25, 5, 5), {500, 300, 5, 4});
  EXPECT_EQ(bad.cause, Cause::TooFewTrueMatches);
  EXPECT_THAT(bad.text,
              AllOf(HasSubstr("but the refinement of all of them ends at 12.2 pr"), HasSubstr("at most 5 pr")));
  oracle.pose.status = RefineStatus::DegenerateGeometry;
  EXPECT_THAT(explain_pair_of(oracle, {500, 300, 6, 4}).text, HasSubstr("gives no pose (degenerate geometry)"));
}

TEST(ExplainMethod, FoundOrSaved) {
  const Explanation found = explain(record_of(0.75, 0.1));
  EXPECT_EQ(found.cause, Cause::Found);
  EXPECT_EQ(
      found.text,
      "registered by the fit: kept 24 of the 40 correct matches among 30 rows (precision 0.800, recall 0.600); their "
      "fit is at 0.75 pr, the refinement ends at 0.10 pr");
  const Explanation saved = explain(record_of(7.5, 0.1));
  EXPECT_EQ(saved.cause, Cause::Saved);
  EXPECT_THAT(saved.text, AllOf(HasSubstr("registered by the refinement"), HasSubstr("fit is at 7.50 pr, above 5 pr"),
                                HasSubstr("ends at 0.10 pr")));
}

TEST(ExplainMethod, ASuccessIsOneEvenWhereTheOracleFails) {
  EXPECT_EQ(explain(record_of(1, 1), record_of(9, 9)).cause, Cause::Found);
  EXPECT_EQ(explain(record_of(9, 1), record_of(9, 9)).cause, Cause::Saved);
}

TEST(ExplainMethod, LostWithThePair) {
  const Explanation few = explain(record_of(9, 9), record_of(9, 9), {500, 7, 4, 4});
  EXPECT_EQ(few.cause, Cause::TooFewKeypoints);
  EXPECT_THAT(few.text, HasSubstr("lost with the pair (too few keypoints)"));
  EXPECT_EQ(explain(record_of(9, 9), record_of(9, 9)).cause, Cause::TooFewTrueMatches);
}

TEST(ExplainMethod, TheGrouperMissedTheRightMatches) {
  const Explanation missed = explain(record_of(90, 80, 30, 2));
  EXPECT_EQ(missed.cause, Cause::GrouperMissed);
  EXPECT_THAT(missed.text, HasSubstr("too few correct matches kept: kept 2 of the 40 correct matches among 30 rows"));
  const Explanation drowned = explain(record_of(90, 80, 30, 14));
  EXPECT_EQ(drowned.cause, Cause::GrouperMissed) << "more than half of it wrong, at rest";
  EXPECT_THAT(drowned.text, HasSubstr("too many incorrect matches kept: kept 14 of"));
  const Explanation astray = explain(record_of(90, 80, 30, 15));
  EXPECT_EQ(astray.cause, Cause::GrouperMissed);
  EXPECT_THAT(astray.text, HasSubstr("the correct matches kept do not determine the pose: kept 15 of"));
  EXPECT_EQ(explain(record_of(90, -1, 30, 14)).cause, Cause::GrouperMissed) << "no optimiser can do with that";
  MethodRecord nothing = record_of(-1, -1, 0, 0);
  nothing.pose.status = RefineStatus::TooFewRows;
  EXPECT_EQ(explain(nothing).cause, Cause::GrouperMissed);
  EXPECT_THAT(explain(nothing).text, AllOf(HasSubstr("among 0 rows, the refinement gives no pose (too few rows)"),
                                           Not(HasSubstr("precision"))));
}

TEST(ExplainMethod, FewerThanThreeRightMatchesAreTheGroupersFault) {
  MethodRecord two = record_of(-1, -1, 2, 2);
  two.pose.status = RefineStatus::TooFewRows;
  EXPECT_EQ(explain(two).cause, Cause::GrouperMissed) << "however precise";
  MethodRecord line = record_of(-1, -1, 3, 2);
  line.pose.status = RefineStatus::DegenerateGeometry;
  EXPECT_EQ(explain(line).cause, Cause::GrouperMissed);
}

TEST(ExplainMethod, ASelectionThatFixesNoPose) {
  MethodRecord record = record_of(-1, -1, 5, 4);
  record.pose.status = RefineStatus::DegenerateGeometry;
  EXPECT_EQ(explain(record).cause, Cause::DegenerateSelection);
  EXPECT_THAT(explain(record).text, HasSubstr("on one line or at one point"));
  EXPECT_EQ(explain(record, record_of(9, 9)).cause, Cause::TooFewTrueMatches) << "no grouper could do better";
}

TEST(ExplainMethod, TheOptimiserLostIt) {
  EXPECT_EQ(explain(record_of(9, -1)).cause, Cause::Diverged) << "mostly right rows, no pose";
  EXPECT_EQ(explain(record_of(1, -1, 30, 5)).cause, Cause::Diverged) << "a good start, no pose";
  MethodRecord moving = record_of(9, 8);
  moving.pose.converged = false;
  moving.pose.iterations = 500;
  EXPECT_EQ(explain(moving).cause, Cause::NotConverged);
  EXPECT_THAT(explain(moving).text, HasSubstr("did not converge within 500 iterations"));
  moving.initial_errors->points->mean_pr = 1;
  EXPECT_EQ(explain(moving).cause, Cause::NotConverged);
  const Explanation spoiled = explain(record_of(1, 8, 30, 5));
  EXPECT_EQ(spoiled.cause, Cause::Spoiled);
  EXPECT_THAT(spoiled.text,
              AllOf(HasSubstr("lost by the refinement"), HasSubstr("fit is at 1.00 pr"), HasSubstr("ends at 8.00 pr")));
  EXPECT_EQ(explain(record_of(1, 8), record_of(9, 9)).cause, Cause::Spoiled) << "the start was good all the same";
}

TEST(ExplainMethod, NoAnswer) {
  MethodRecord record;
  record.method = "mine";
  record.failure = "column x is absent";
  EXPECT_EQ(explain(record).cause, Cause::NoAnswer);
  EXPECT_EQ(explain(record).text, "gave no answer: failed: column x is absent");
}

TEST(ExplainMethod, TheDensePoseIsToldApart) {
  MethodRecord lost = record_of(90, 80, 30, 2);
  EXPECT_THAT(explain(lost).text, Not(HasSubstr("surface")));
  lost.dense_errors = PoseErrors{1, 1, PointError{0.5, 0.5}, std::nullopt, {}};
  EXPECT_EQ(explain(lost).cause, Cause::GrouperMissed) << "it is not the correspondences' merit";
  EXPECT_THAT(explain(lost).text, HasSubstr("the dense refinement ends at 0.50 pr, which registers the pair"));
  lost.dense_errors->points->mean_pr = 70;
  EXPECT_THAT(explain(lost).text, HasSubstr("the dense refinement ends at 70.0 pr, lost"));
}

TEST(ExplainMethod, EveryCauseHasAName) {
  EXPECT_STREQ(to_text(Cause::TooFewKeypoints), "too few keypoints");
  EXPECT_STREQ(to_text(Cause::TooFewTrueMatches), "too few true matches");
  EXPECT_STREQ(to_text(Cause::DegenerateSelection), "degenerate selection");
  EXPECT_STREQ(to_text(Cause::NoAnswer), "no answer");
}

// Even where the oracle is right by it: all matches would be right by their own pose.
TEST(Explain, ATruthThatDoesNotFitComesFirst) {
  for (const MethodRecord& oracle : {kGoodOracle, record_of(-1, -1, 0, 0)}) {
    const auto explanations = explain_pair(with_misfit(), oracle, {record_of(20, 20, 30, 0)});
    EXPECT_EQ(explanations[0].cause, Cause::TruthDoesNotFit);
    EXPECT_THAT(explanations[0].text, HasSubstr("the truth fits inverted"));
    EXPECT_EQ(explanations[1].cause, Cause::TruthDoesNotFit);
  }
  EXPECT_STREQ(to_text(Cause::TruthDoesNotFit), "truth does not fit");
}

TEST(Explain, NamesNormalsOnOppositeSides) {
  const MethodRecord nothing = record_of(-1, -1, 0, 0);
  const auto explanations = explain_pair(with_opposed_normals(0.98), nothing, {nothing});
  EXPECT_EQ(explanations[0].cause, Cause::NormalsOpposed);
  EXPECT_THAT(explanations[0].text, AllOf(HasSubstr("source (by the faces)"), HasSubstr("target (towards the origin)"),
                                          HasSubstr("98 % of the overlap"), HasSubstr("--sensor")));
  EXPECT_EQ(explain_pair(with_opposed_normals(0.2), nothing, {})[0].cause, Cause::TooFewTrueMatches);
  EXPECT_EQ(explain_pair(with_opposed_normals(0.98), kGoodOracle, {})[0].cause, Cause::Found) << "it does not matter";
}

}  // namespace
}  // namespace corral
