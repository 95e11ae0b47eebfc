// SPDX-License-Identifier: MIT
#include "apps/study/specification.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "grouping/registry.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::io_error_of;

constexpr char kGood[] = R"toml(name = "mine"
dataset = "b3r"
attribute = "noise_pr"
levels = [0.05, 1]
groupers = ["st", "gc"]
[filter]
density = ["", "1"]
[options.gc]
tolerance_pr = 2
cluster = "clique"
[matching]
keypoint_radius_pr = 2
)toml";

std::string error_of(const std::string& text) {
  return io_error_of([&] { parse_experiment("x.toml", text); });
}

std::string with(const std::string& from, const std::string& to) {
  return error_of(testing::replaced(kGood, from, to));
}

TEST(Specification, ReadsWhatStandsInIt) {
  const Experiment experiment = parse_experiment("x.toml", kGood);
  EXPECT_EQ(experiment.info.title, "mine");
  EXPECT_EQ(experiment.info.levels.at(0).label, "0.05");
  EXPECT_EQ(experiment.info.levels.at(1).label, "1");
  EXPECT_THAT(experiment.info.methods, ElementsAre("st", "gc"));
  EXPECT_EQ(experiment.matching.keypoint_radius_pr, 2);
  EXPECT_EQ(experiment.filters.at(0).attribute, "density");
  EXPECT_EQ(experiment.info.threshold_pr, 4);
  EXPECT_EQ(experiment.info.least_true_matches, 1);
  const OptionOverrides expected = {{"cluster", "clique"}, {"tolerance_pr", "2"}};
  EXPECT_EQ(method_options(experiment, "gc", experiment.info.levels[0]), expected);
  EXPECT_TRUE(method_options(experiment, "st", experiment.info.levels[0]).empty());
}

TEST(Specification, NamesWhatIsWrongAndWhatWasMeant) {
  ASSERT_EQ(error_of(kGood), "");
  EXPECT_THAT(with("groupers", "grupers"), AllOf(HasSubstr("line 5"), HasSubstr("did you mean 'groupers'?")));
  EXPECT_THAT(with("\"st\"", "\"sst\""), HasSubstr("did you mean 'ss'?"));
  EXPECT_THAT(with("\"st\"", "\"gc\""), HasSubstr("gc stands twice"));
  EXPECT_THAT(with("keypoint_radius_pr = 2", "keypoint_radus_pr = 2"), HasSubstr("did you mean 'keypoint_radius_pr'?"));
  EXPECT_THAT(with("keypoint_radius_pr = 2", "keypoint_radius_pr = 0"), HasSubstr("matching"));
  EXPECT_THAT(with("tolerance_pr", "tolerance"), HasSubstr("tolerance"));
  EXPECT_THAT(with("tolerance_pr = 2", "tolerance_pr = -2"), HasSubstr("tolerance_pr"));
  EXPECT_THAT(with("cluster = \"clique\"", "seed = 3"), HasSubstr("seed of the experiment"));
  EXPECT_THAT(with("options.gc", "options.gcc"), HasSubstr("did you mean 'gc'?"));
  EXPECT_THAT(with("[0.05, 1]", "[1, 1]"), HasSubstr("stands twice"));
  EXPECT_THAT(with("levels = [0.05, 1]", ""), HasSubstr("either levels"));
  EXPECT_THAT(with("levels = [0.05, 1]", "bins = [[2, 1]]"), HasSubstr("low < high"));
  EXPECT_THAT(with("levels = [0.05, 1]", "bins = [[0, 2], [1, 3]]"), HasSubstr("in order"));
  EXPECT_THAT(with("levels = [0.05, 1]", "bins = [[0, 2]]\nlabels = [\"a\", \"b\"]"), HasSubstr("labels"));
  EXPECT_THAT(with("name = \"mine\"", "name = \"My own\""), HasSubstr("small letters"));
  EXPECT_THAT(with("dataset = \"b3r\"", ""), HasSubstr("dataset"));
  EXPECT_THAT(with("noise_pr", "threshold_pr") + with("levels = [0.05, 1]", "levels = [0.05, 1]\npreset = \"mine\""),
              HasSubstr("preset"));
  EXPECT_THAT(error_of(testing::replaced(testing::replaced(kGood, "noise_pr", "threshold_pr"), "0.05", "-1")),
              HasSubstr("above zero"));
  for (const char* rows : {"0.5", "1e300"})
    EXPECT_THAT(error_of(testing::replaced(testing::replaced(kGood, "noise_pr", "table_size"), "0.05", rows)),
                HasSubstr("whole numbers of rows"));
  EXPECT_THAT(with("noise_pr", "si.similarity"), HasSubstr("not among the groupers"));
  EXPECT_THAT(with("noise_pr", "st.similarty"), HasSubstr("similarity"));
  EXPECT_THAT(with("repeats", "x") + with("levels = [0.05, 1]", "levels = [0.05, 1]\nrepeats = 0"),
              HasSubstr("repeats"));
}

TEST(Specification, LabelsBinsAsIntervals) {
  const Experiment experiment = parse_experiment(
      "x.toml", testing::replaced(kGood, "levels = [0.05, 1]", "bins = [[65, 70], [70, 72.5], [90, 95]]"));
  std::vector<std::string> labels;
  for (const StudyLevel& level : experiment.info.levels) labels.push_back(level.label);
  EXPECT_THAT(labels, ElementsAre("[65,70)", "[70,72.5)", "[90,95]"));
}

TEST(Specification, AnOptionIsSweptLevelByLevel) {
  const Experiment experiment = parse_experiment("x.toml", testing::replaced(kGood, "noise_pr", "st.similarity"));
  EXPECT_EQ(experiment.sweep, Sweep::Option);
  const OptionOverrides expected = {{"similarity", "0.05"}};
  EXPECT_EQ(method_options(experiment, "st", experiment.info.levels[0]), expected);
  EXPECT_EQ(method_options(experiment, "gc", experiment.info.levels[0]).count("similarity"), 0u);
}

TEST(Specification, TheProgramCarriesThePapersExperiments) {
  EXPECT_THAT(built_in_experiments(), ElementsAre("clutter", "density", "matches", "noise", "occlusion", "overlap",
                                                  "threshold", "time", "tuning-consistency", "tuning-spectral"));
  std::string figures;
  for (const std::string& name : built_in_experiments()) {
    const Experiment experiment = read_experiment(name);
    EXPECT_EQ(experiment.info.name, name);
    figures += experiment.info.figure;
    if (!experiment.info.figure.empty()) {
      EXPECT_EQ(experiment.info.methods.size(), groupers().size()) << name;
    }
  }
  std::sort(figures.begin(), figures.end());
  EXPECT_EQ(figures, "abcdefgh");
  EXPECT_EQ(read_experiment("noise").info.levels.size(), 9u);
  EXPECT_EQ(read_experiment("threshold").info.levels.size(), 10u);
  EXPECT_EQ(read_experiment("matches").info.levels.front().label, "<500");
  EXPECT_EQ(read_experiment("matches").keypoint_radii_pr.size(), 9u);
  EXPECT_THAT(io_error_of([] { read_experiment("nose"); }), HasSubstr("did you mean 'noise'?"));
}

// preset = "paper" promises the values of Table 1: a default that drifts from them would make it a lie.
TEST(Specification, TheDefaultsAreThePapersTable) {
  int compared = 0;
  for (const Grouper& grouper : groupers())
    for (const OptionValue& option : grouper.options) {
      const std::string name = grouper.name + "." + option.name;
      // The two forms that cannot be meant as they are printed (paper/README.md).
      if (option.paper.empty() || name == "nnsr.ratio" || name == "si.form") continue;
      ++compared;
      EXPECT_EQ(option.value, option.paper) << name;
    }
  EXPECT_GE(compared, 10);
}

}  // namespace
}  // namespace corral
