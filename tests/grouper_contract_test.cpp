// SPDX-License-Identifier: MIT
// The contract of every registered grouper.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "grouping/registry.h"
#include "kernel/evaluation.h"
#include "tests/support/same_result.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using testing::easy_problem;
using testing::harsh_table;
using ::testing::HasSubstr;
using testing::refusal_of;
using testing::synthetic;

class GrouperContract : public ::testing::TestWithParam<std::string> {
 protected:
  GroupingResult group(const CorrespondenceSet& matches, const OptionOverrides& overrides = {}) const {
    return find_grouper(GetParam()).configure(overrides).group(matches);
  }
};

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const Grouper& grouper : groupers()) all.push_back(grouper.name);
  return all;
}
INSTANTIATE_TEST_SUITE_P(Groupers, GrouperContract, ::testing::ValuesIn(names()), [](const auto& test) {
  std::string name = test.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(Registry, BeginsWithTheSevenGroupersInTheOrderOfThePaper) {
  std::vector<std::string> first = names();
  first.resize(7);
  EXPECT_THAT(first, ::testing::ElementsAre("ss", "nnsr", "ransac", "st", "gc", "hough", "si"));
}

TEST(Registry, WordsStandForSeveralNames) {
  EXPECT_EQ(expand_groupers({"all"}), names());
  EXPECT_THAT(expand_groupers({"paper", "tcf", "mine"}),
              ::testing::ElementsAre("ss", "nnsr", "ransac", "st", "gc", "hough", "si", "tcf", "mine"));
}

TEST(Registry, UnknownNameListsTheKnownOnes) {
  const std::string text = refusal_of([] { find_grouper("pcl"); });
  EXPECT_THAT(text, HasSubstr("pcl"));
  for (const std::string& name : names()) EXPECT_THAT(text, HasSubstr(name));
}

TEST_P(GrouperContract, EmptyTableGivesEmptyAnswer) {
  const GroupingResult result = group(CorrespondenceSet());
  EXPECT_TRUE(result.selected.empty());
  EXPECT_TRUE(result.scores.empty());
  EXPECT_FALSE(result.target_from_source.has_value());
}

TEST_P(GrouperContract, SameAnswerTwiceOnAHardProblem) {
  for (const CorrespondenceSet& matches : {synthetic(400, 0.05, 1).matches, harsh_table(300, 0.05, 2)}) {
    const GroupingResult first = group(matches);
    testing::expect_same_result(group(matches), first);
  }
}

TEST_P(GrouperContract, EasyProblemIsSolved) {
  // ss and nnsr use feature distances only, whose two classes overlap in the synthetic tables: of the correct matches,
  // 4/5 pass the ratio test, and those with d1 < 0.35 or so are above any threshold that parts the classes.
  const std::map<std::string, double> lowest_recall = {{"ss", 0.5}, {"nnsr", 0.7}};
  const std::map<std::string, double> lowest_precision = {{"nnsr", 0.85}};
  const auto bar = [&](const std::map<std::string, double>& bars) {
    return bars.count(GetParam()) ? bars.at(GetParam()) : 0.9;
  };
  for (const std::uint64_t seed : {1, 2, 3}) {
    const SyntheticProblem problem = easy_problem(seed);
    const auto score =
        score_grouping(label_correct(problem.matches, problem.truth, 4), group(problem.matches).selected);
    EXPECT_GT(score.recall.value(), bar(lowest_recall)) << "seed " << seed;
    EXPECT_GT(score.precision.value(), bar(lowest_precision)) << "seed " << seed;
  }
}

TEST_P(GrouperContract, PoseSolvesTheEasyProblem) {
  const std::set<std::string> without_pose = {"ss", "nnsr", "st", "gc", "hough", "si", "gtm", "cv"};
  const SyntheticProblem problem = easy_problem(4);
  const auto pose = group(problem.matches).target_from_source;
  EXPECT_NE(pose.has_value(), without_pose.count(GetParam()) > 0);
  if (!pose) return;
  EXPECT_LT(rotation_error_deg(*pose, problem.truth), 2);
  EXPECT_LT(translation_error_pr(*pose, problem.truth, problem.matches.resolution), 5);
}

TEST_P(GrouperContract, OptionsRoundTrip) {
  const Grouper& grouper = find_grouper(GetParam());
  OptionOverrides defaults;
  for (const OptionValue& option : grouper.options) {
    defaults[option.name] = option.value;
    EXPECT_NE(option.meaning, "") << option.name;
    EXPECT_NE(option.accepted, "") << option.name;
  }
  const ConfiguredGrouper configured = grouper.configure(defaults);
  ASSERT_EQ(configured.options.size(), grouper.options.size());
  for (std::size_t i = 0; i < grouper.options.size(); ++i) {
    EXPECT_EQ(configured.options[i].name, grouper.options[i].name);
    EXPECT_EQ(configured.options[i].value, grouper.options[i].value);
  }
  const CorrespondenceSet matches = synthetic(200, 0.2, 5).matches;
  EXPECT_EQ(configured.group(matches).selected, group(matches).selected);
}

}  // namespace
}  // namespace corral
