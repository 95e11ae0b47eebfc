// SPDX-License-Identifier: MIT
// What the groupers after the seven promise beside the contract of all: they are functions of the set of rows, and a pose
// selects the rows that agree with it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "grouping/pose/pose_score.h"
#include "grouping/registry.h"
#include "kernel/evaluation.h"
#include "tests/support/degenerate_tables.h"
#include "tests/support/random_tables.h"
#include "tests/support/row_order.h"
#include "tests/support/same_result.h"
#include "tests/support/table_changes.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using testing::harsh_table;
using ::testing::HasSubstr;
using testing::synthetic;

constexpr std::size_t kGroupersOf2017 = 7;

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (std::size_t i = kGroupersOf2017; i < groupers().size(); ++i) all.push_back(groupers()[i].name);
  return all;
}

class SetGrouper : public ::testing::TestWithParam<std::string> {
 protected:
  const Grouper& grouper() const { return find_grouper(GetParam()); }
  bool has_option(const std::string& name) const {
    return std::any_of(grouper().options.begin(), grouper().options.end(),
                       [&](const OptionValue& option) { return option.name == name; });
  }
  GroupingResult group(const CorrespondenceSet& matches, const OptionOverrides& overrides = {}) const {
    return grouper().configure(overrides).group(matches);
  }
  bool estimates_a_pose() const { return has_option("tolerance_pr"); }
};
INSTANTIATE_TEST_SUITE_P(Groupers, SetGrouper, ::testing::ValuesIn(names()), [](const auto& test) {
  std::string name = test.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

/// Hard ones, with ties, and some that are small.
std::vector<CorrespondenceSet> tables() {
  std::vector<CorrespondenceSet> all = {harsh_table(250, 0.1, 1), harsh_table(120, 0.4, 2),
                                        synthetic(300, 0.03, 3).matches, synthetic(80, 0.9, 4).matches};
  for (int number = 0; number < 60; ++number) {
    RandomStream random = testing::stream_of_case(number);
    all.push_back(number % 2 == 0 ? testing::random_table(random) : testing::table_on_the_limits(random));
  }
  return all;
}

void expect_same_pose(const GroupingResult& found, const GroupingResult& expected) {
  ASSERT_EQ(found.target_from_source.has_value(), expected.target_from_source.has_value());
  if (!found.target_from_source) return;
  EXPECT_EQ(found.target_from_source->rotation, expected.target_from_source->rotation);
  EXPECT_EQ(found.target_from_source->translation, expected.target_from_source->translation);
}

/// Rows that are alike in all columns may change places.
bool is_like(const CorrespondenceSet& table, const CorrespondenceSet& other) {
  return table.source_points == other.source_points && table.target_points == other.target_points &&
         table.feature_distance == other.feature_distance;
}

TEST_P(SetGrouper, OrderOfRowsDoesNotMatter) {
  std::size_t selected = 0;
  for (const CorrespondenceSet& matches : tables()) {
    const GroupingResult expected = group(matches);
    for (const std::uint64_t seed : {1, 2}) {
      const Indices old_row = testing::shuffled_rows(matches.size(), seed);
      const CorrespondenceSet shuffled = select_rows(matches, old_row);
      const GroupingResult found = group(shuffled);
      expect_same_pose(found, expected);
      const Indices named = testing::by_old_name(found.selected, old_row);
      if (named != expected.selected) {
        EXPECT_TRUE(is_like(select_rows(matches, named), select_rows(matches, expected.selected)));
      }
      for (std::size_t i = 0; i < found.scores.size(); ++i)
        EXPECT_EQ(found.scores[i], expected.scores[static_cast<std::size_t>(old_row[i])]);
    }
    selected += expected.selected.size();
  }
  EXPECT_GT(selected, 300U);
}

TEST_P(SetGrouper, UnitOfLengthDoesNotMatter) {
  for (const CorrespondenceSet& matches : tables())
    for (const double factor : {1024.0, 0x1p-30}) {
      const GroupingResult found = group(testing::scaled(matches, factor)), expected = group(matches);
      EXPECT_EQ(found.selected, expected.selected);
      EXPECT_EQ(found.scores, expected.scores);
    }
}

TEST_P(SetGrouper, MotionOfTheTargetMovesThePose) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const CorrespondenceSet matches = synthetic(200, 0.3, seed).matches;
    RigidTransform motion;
    motion.rotation = RandomStream(seed).rotation();
    motion.translation = {100, -50, 30};
    const GroupingResult found = group(testing::with_moved_target(matches, motion)), expected = group(matches);
    EXPECT_EQ(found.selected, expected.selected);
    ASSERT_EQ(found.target_from_source.has_value(), expected.target_from_source.has_value());
    if (!found.target_from_source) continue;
    const RigidTransform moved = motion * *expected.target_from_source;
    EXPECT_LT(rotation_error_deg(*found.target_from_source, moved), 1e-6);
    EXPECT_LT(translation_error_pr(*found.target_from_source, moved, matches.resolution), 1e-6);
  }
}

TEST_P(SetGrouper, AnswerIsInGoodFormAndTheSameOnEveryTarget) {
  const GroupFunction bound = [this](const CorrespondenceSet& matches) { return group(matches); };
  for (const auto& [name, matches] : testing::degenerate_tables()) {
    SCOPED_TRACE(name);
    const GroupingResult result = group(matches);
    EXPECT_TRUE(std::is_sorted(result.selected.begin(), result.selected.end(), std::less_equal<>()));
    for (const int row : result.selected) EXPECT_TRUE(row >= 0 && row < matches.size());
    for (const double score : result.scores) EXPECT_TRUE(std::isfinite(score));
    if (result.target_from_source) {
      EXPECT_TRUE(is_rotation(result.target_from_source->rotation, 1e-9));
    }
    testing::expect_same_on_every_target(bound, matches);
  }
  for (const CorrespondenceSet& matches : tables()) testing::expect_same_on_every_target(bound, matches);
}

TEST_P(SetGrouper, RaggedAndNonFiniteColumnsAreNamed) {
  CorrespondenceSet ragged = testing::full_table(), bad = ragged;
  ragged.target_points = ragged.target_points.topRows(4).eval();
  bad.source_points(3, 1) = std::nan("");
  EXPECT_THAT(testing::refusal_of([&] { group(ragged); }), HasSubstr("target_points"));
  EXPECT_THAT(testing::refusal_of([&] { group(bad); }), HasSubstr("source_points"));
}

/// Four corners that stay, and a row that goes astray.
TEST_P(SetGrouper, FourCornersAreSelected) {
  if (!estimates_a_pose()) return;
  CorrespondenceSet matches =
      testing::table_of_points({{0, 0, 0}, {20, 0, 0}, {0, 20, 0}, {0, 0, 20}, {20, 20, 0}},
                               {{0, 0, 0}, {20, 0, 0}, {0, 20, 0}, {0, 0, 20}, {100, 100, 100}});
  testing::set_identity_frames(matches);
  const GroupingResult result = group(matches);
  EXPECT_THAT(result.selected, ElementsAre(0, 1, 2, 3));
  ASSERT_TRUE(result.target_from_source);
  EXPECT_TRUE(result.target_from_source->rotation.isIdentity(1e-9));
  EXPECT_LT(result.target_from_source->translation.norm(), 1e-9);
}

TEST_P(SetGrouper, SelectedAreTheRowsThatAgreeWithThePose) {
  if (!estimates_a_pose()) return;
  int poses = 0;
  for (const CorrespondenceSet& matches : tables()) {
    const GroupingResult result = group(matches);
    if (!result.target_from_source) {
      EXPECT_TRUE(result.selected.empty());
      continue;
    }
    ++poses;
    std::vector<double> residuals;
    measure_residuals(matches, *result.target_from_source, residuals);
    EXPECT_EQ(result.selected, rows_within(residuals, 5 * matches.resolution));
    EXPECT_GE(result.selected.size(), 3U);
  }
  EXPECT_GT(poses, 20);
}

TEST_P(SetGrouper, RunnersUpAreApart) {
  if (!has_option("keep")) return;
  std::size_t kept = 0;
  for (const CorrespondenceSet& matches : tables()) {
    const GroupingResult alone = group(matches), result = group(matches, {{"keep", "5"}});
    EXPECT_TRUE(alone.runner_up.empty());
    EXPECT_EQ(result.selected, alone.selected);
    EXPECT_LE(result.runner_up.size(), 5U);
    std::vector<RigidTransform> poses;
    if (result.target_from_source) poses.push_back(*result.target_from_source);
    for (const ScoredPose& pose : result.runner_up) {
      for (const RigidTransform& other : poses)
        EXPECT_GT(point_error(pose.target_from_source, other, matches.source_points, matches.resolution)->mean_pr,
                  10 - 1e-6);
      poses.push_back(pose.target_from_source);
      ++kept;
    }
  }
  EXPECT_GT(kept, 10U);
}

}  // namespace
}  // namespace corral
