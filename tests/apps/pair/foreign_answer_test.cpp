// SPDX-License-Identifier: MIT
#include "apps/pair/foreign_answer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/pose/transform_file.h"
#include "kernel/synthetic.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

using namespace testing;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// 60 correct ones among 100 matches, with noise, and their truth.
class Foreign : public ::testing::Test {
 protected:
  Foreign() {
    SyntheticOptions options;
    options.matches = 100;
    options.inlier_ratio = 0.6;
    options.noise_pr = 0.3;
    options.resolution = 0.25;
    made_ = make_synthetic_problem(options);
    truth_.target_from_source = made_.truth;
    truth_.overlap = made_.matches.source_points(made_.inliers, Eigen::all);
  }

  std::string labels(const Indices& rows) const {
    std::string text;
    for (const int row : rows) text += std::to_string(row) + "\n";
    return put_text(folder_ / "labels.txt", text);
  }
  /// The truth, moved by so many pr.
  std::string pose(double shift_pr) const {
    RigidTransform moved = made_.truth;
    moved.translation(0) += shift_pr * made_.matches.resolution;
    return put_text(folder_ / "pose.txt", transform_text(moved));
  }
  MethodRecord evaluate(const ForeignAnswer& answer) const {
    return evaluate_answer("mac", answer, "p", made_.matches, truth_);
  }

  SyntheticProblem made_;
  PairTruth truth_;
  const ScratchFolder folder_;
};

TEST_F(Foreign, LabelsAreScoredAndRefinedAsTheSelectionOfAGrouper) {
  Indices rows = made_.inliers;
  rows.resize(40);
  const ConfiguredGrouper grouper = {[&](const CorrespondenceSet&) {
                                       return GroupingResult{rows, {}, std::nullopt, {}, {}};
                                     },
                                     {}};
  const MethodRecord own = evaluate_method("own", grouper, made_.matches, truth_, 1);
  const MethodRecord other = evaluate({labels(rows), "", "", 12.5});
  EXPECT_EQ(other.failure, "");
  EXPECT_EQ(other.found.selected, own.found.selected);
  EXPECT_EQ(other.score->precision, 1);
  EXPECT_EQ(other.score->recall, own.score->recall);
  EXPECT_EQ(other.pose.target_from_source->rotation, own.pose.target_from_source->rotation);
  EXPECT_EQ(other.errors->points->mean_pr, own.errors->points->mean_pr);
  EXPECT_EQ(other.stated_time_ms, 12.5);
  EXPECT_FALSE(other.time_ms) << "it was not measured";
}

TEST_F(Foreign, AStatedPoseIsTheStartInPlaceOfTheFit) {
  const MethodRecord record = evaluate({labels(made_.inliers), pose(2), "", {}});
  EXPECT_NEAR(record.initial_errors->translation_error_pr, 2, 1e-9);
  EXPECT_LT(record.errors->translation_error_pr, 0.5);
  EXPECT_EQ(to_text(record.status()), "refined");
}

TEST_F(Foreign, APoseAloneStandsForTheMatchesItBringsNear) {
  const MethodRecord record = evaluate({"", pose(2), "", {}});
  Indices expected;
  const auto near = label_correct(made_.matches, *record.found.target_from_source, 5);
  for (int row = 0; row < 100; ++row)
    if (near[static_cast<std::size_t>(row)]) expected.push_back(row);
  EXPECT_EQ(record.found.selected, expected);
  EXPECT_GE(record.score->recall.value(), 0.99);
  EXPECT_NEAR(record.initial_errors->translation_error_pr, 2, 1e-9);
  EXPECT_LT(record.errors->translation_error_pr, 0.5);
}

TEST_F(Foreign, AStatedPoseStandsWhereTheSelectionGivesNone) {
  const MethodRecord alone = evaluate({"", pose(1000), "", {}});
  EXPECT_LT(alone.found.selected.size(), 3u);
  EXPECT_EQ(to_text(alone.status()), "too few rows");
  EXPECT_NEAR(alone.errors->translation_error_pr, 1000, 1e-6);
  const MethodRecord both = evaluate({labels({1, 2}), pose(1), "", {}});
  EXPECT_EQ(to_text(both.status()), "too few rows");
  EXPECT_NEAR(both.errors->translation_error_pr, 1, 1e-9) << "nothing refined it";
  EXPECT_TRUE(is_registered(both.errors));
}

TEST_F(Foreign, WhatCannotBeReadIsAFailureOfTheMethod) {
  const auto failure = [&](const ForeignAnswer& answer) {
    const MethodRecord record = evaluate(answer);
    EXPECT_EQ(record.status().state, MethodState::Failed);
    EXPECT_FALSE(record.score);
    return record.failure;
  };
  const std::string good = labels(made_.inliers), missing = folder_ / "missing.txt";
  EXPECT_EQ(failure({missing, "", "", {}}), missing + ": does not exist: no answer to this pair");
  EXPECT_THAT(failure({good, missing + ":4,0", "", {}}), HasSubstr("no answer to this pair"));
  EXPECT_THAT(failure({put_text(folder_ / "l.txt", "1\n100\n"), "", "", {}}), HasSubstr("l.txt, line 2"));
  EXPECT_THAT(failure({"", put_text(folder_ / "p.txt", "1 0 0 nan\n0 1 0 0\n0 0 1 0\n"), "", {}}), HasSubstr("p.txt"));
  EXPECT_THAT(failure({"", put_text(folder_ / "s.txt", "2 0 0 0\n0 2 0 0\n0 0 2 0\n"), "", {}}), HasSubstr("s.txt"));
}

TEST_F(Foreign, StatesATimeForEachPair) {
  const auto time = [&](const std::string& csv) {
    return evaluate({labels(made_.inliers), "", put_text(folder_ / "times.csv", csv), {}});
  };
  EXPECT_EQ(time("pair,ms\nq,3\np,0.75\n").stated_time_ms, 0.75);
  EXPECT_FALSE(time("pair,ms\nq,3\np,\n").stated_time_ms);
  const MethodRecord none = time("pair,ms\nq,3\n");
  EXPECT_FALSE(none.stated_time_ms);
  EXPECT_EQ(none.failure, "") << "a time is not an answer";
  EXPECT_THAT(time("pair,ms\np,fast\n").failure, HasSubstr("times.csv, row 1: ms is 'fast', expected a time"));
  EXPECT_THAT(time("pair,ms\np,-1\n").failure, HasSubstr("expected a time"));
  EXPECT_THAT(time("pair,seconds\np,1\n").failure, HasSubstr("expected the columns pair and ms"));
}

}  // namespace
}  // namespace corral
