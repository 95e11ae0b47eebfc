// SPDX-License-Identifier: MIT
#include "apps/study/experiment_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kernel/error.h"
#include "tests/support/experiment_text.h"

namespace corral {
namespace {

using testing::error_of;
using ::testing::HasSubstr;
using testing::kGood;

TEST(ExperimentOptions, AnOptionIsSweptLevelByLevel) {
  const Experiment experiment = parse_experiment("x.toml", testing::replaced(kGood, "noise_pr", "st.similarity"));
  EXPECT_EQ(experiment.sweep, Sweep::Option);
  const OptionOverrides expected = {{"similarity", "0.05"}};
  EXPECT_EQ(options_at(experiment, "st", experiment.info.levels[0]), expected);
  EXPECT_EQ(options_at(experiment, "gc", experiment.info.levels[0]).count("similarity"), 0u);
}

TEST(ExperimentOptions, AnOptionOfADetectorIsSweptToo) {
  const std::string text = testing::replaced(testing::replaced(kGood, "noise_pr", "shot.radius_pr"), "0.05", "10");
  const Experiment experiment = parse_experiment("x.toml", text);
  const MatchSettings matching = matching_at(experiment, experiment.info.levels[0]);
  EXPECT_EQ(matching.options, (OptionsByName{{"harris", {{"radius_pr", "2"}}}, {"shot", {{"radius_pr", "10"}}}}));
  EXPECT_THAT(error_of(testing::replaced(text, "shot.radius_pr", "harris-mesh.radius_pr")), HasSubstr("not in use"));
}

TEST(ExperimentOptions, AChoiceIsSweptByItsWords) {
  const std::string text =
      testing::replaced(testing::replaced(kGood, "noise_pr", "detector"), "[0.05, 1]", "[\"harris\", \"uniform\"]");
  const Experiment experiment = parse_experiment("x.toml", text);
  EXPECT_EQ(experiment.sweep, Sweep::Choice);
  ASSERT_EQ(experiment.info.levels.size(), 2u);
  EXPECT_EQ(experiment.info.levels[1].label, "uniform");
  const MatchSettings matching = matching_at(experiment, experiment.info.levels[1]);
  EXPECT_EQ(matching.detector, "uniform");
  EXPECT_TRUE(matching.options.empty()) << "harris is not in use at this level";
  EXPECT_THAT(error_of(testing::replaced(text, "\"uniform\"", "\"sift\"")), HasSubstr("expected harris|"));
  const std::string forms =
      testing::replaced(testing::replaced(kGood, "noise_pr", "gc.cluster"), "[0.05, 1]", "[\"star\", \"clique\"]");
  const Experiment words = parse_experiment("x.toml", forms);
  EXPECT_EQ(options_at(words, "gc", words.info.levels[0]).at("cluster"), "star");
}

TEST(ExperimentOptions, OptionsOfTheCommandLineComeLast) {
  Experiment experiment = parse_experiment("x.toml", kGood);
  override_options(experiment, {{"gc", {{"tolerance_pr", "7"}}}, {"shot", {{"radius_pr", "9"}}}});
  EXPECT_EQ(options_at(experiment, "gc", experiment.info.levels[0]).at("tolerance_pr"), "7");
  EXPECT_EQ(matching_at(experiment, experiment.info.levels[0]).options.at("shot").at("radius_pr"), "9");
  for (const OptionsByName& bad :
       {OptionsByName{{"ransac", {{"iterations", "5"}}}}, {{"gc", {{"tolerance_pr", "-1"}}}}})
    EXPECT_THROW(override_options(experiment, bad), InvalidInput);
  Experiment swept = parse_experiment("x.toml", testing::replaced(kGood, "noise_pr", "st.similarity"));
  EXPECT_THROW(override_options(swept, {{"st", {{"similarity", "0.5"}}}}), InvalidInput);
}

}  // namespace
}  // namespace corral
