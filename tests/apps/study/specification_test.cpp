// SPDX-License-Identifier: MIT
#include "apps/study/specification.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "apps/study/experiment_options.h"
#include "grouping/registry.h"
#include "tests/support/experiment_text.h"

namespace corral {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using testing::error_of;
using ::testing::HasSubstr;
using testing::io_error_of;
using testing::kGood;

std::string with(const std::string& from, const std::string& to) {
  return error_of(testing::replaced(kGood, from, to));
}

TEST(Specification, ReadsWhatStandsInIt) {
  const Experiment experiment = parse_experiment("x.toml", kGood);
  EXPECT_EQ(experiment.info.title, "mine");
  EXPECT_EQ(experiment.info.levels.at(0).label, "0.05");
  EXPECT_EQ(experiment.info.levels.at(1).label, "1");
  EXPECT_THAT(experiment.info.methods, ElementsAre("st", "gc"));
  const MatchSettings matching = matching_at(experiment, experiment.info.levels[0]);
  EXPECT_EQ(matching.options, (OptionsByName{{"harris", {{"radius_pr", "2"}}}}));
  EXPECT_EQ(matching.normals, NormalSide::Origin);
  EXPECT_EQ(experiment.filters.at(0).attribute, "density");
  EXPECT_EQ(experiment.info.threshold_pr, 4);
  EXPECT_EQ(experiment.info.least_true_matches, 1);
  const OptionOverrides expected = {{"cluster", "clique"}, {"tolerance_pr", "2"}};
  EXPECT_EQ(options_at(experiment, "gc", experiment.info.levels[0]), expected);
  EXPECT_TRUE(options_at(experiment, "st", experiment.info.levels[0]).empty());
}

TEST(Specification, NamesWhatIsWrongAndWhatWasMeant) {
  ASSERT_EQ(error_of(kGood), "");
  EXPECT_THAT(with("groupers", "grupers"), AllOf(HasSubstr("line 5"), HasSubstr("did you mean 'groupers'?")));
  EXPECT_THAT(with("\"st\"", "\"sst\""), HasSubstr("did you mean 'ss'?"));
  EXPECT_THAT(with("\"st\"", "\"gc\""), HasSubstr("gc occurs twice"));
  EXPECT_THAT(with("normals =", "normal ="), HasSubstr("did you mean 'normals'?"));
  EXPECT_THAT(with("\"origin\"", "\"sensor\""), HasSubstr("expected auto|mesh|file|origin"));
  EXPECT_THAT(with("radius_pr = 2", "radius = 2"), HasSubstr("expected radius_pr"));
  EXPECT_THAT(with("radius_pr = 2", "radius_pr = 0"), HasSubstr("radius_pr is 0"));
  EXPECT_THAT(with("options.harris", "options.harris-mesh"), HasSubstr("'harris-mesh', which is not in use"));
  EXPECT_THAT(with("tolerance_pr", "tolerance"), HasSubstr("tolerance"));
  EXPECT_THAT(with("tolerance_pr = 2", "tolerance_pr = -2"), HasSubstr("tolerance_pr"));
  EXPECT_THAT(with("cluster = \"clique\"", "seed = 3"), HasSubstr("seed of the experiment"));
  EXPECT_THAT(with("options.gc", "options.gcc"), HasSubstr("did you mean 'gc'?"));
  EXPECT_THAT(with("[0.05, 1]", "[1, 1]"), HasSubstr("occurs twice"));
  EXPECT_THAT(with("levels = [0.05, 1]", ""), HasSubstr("either levels"));
  EXPECT_THAT(with("levels = [0.05, 1]", "bins = [[2, 1]]"), HasSubstr("low < high"));
  EXPECT_THAT(with("levels = [0.05, 1]", "bins = [[0, 2], [1, 3]]"), HasSubstr("do not overlap"));
  EXPECT_THAT(with("levels = [0.05, 1]", "bins = [[0, 2]]\nlabels = [\"a\", \"b\"]"), HasSubstr("labels"));
  EXPECT_THAT(with("name = \"mine\"", "name = \"My own\""), HasSubstr("lower-case letters"));
  EXPECT_THAT(with("dataset = \"b3r\"", ""), HasSubstr("dataset"));
  EXPECT_THAT(with("noise_pr", "threshold_pr") + with("levels = [0.05, 1]", "levels = [0.05, 1]\npreset = \"mine\""),
              HasSubstr("preset"));
  EXPECT_THAT(error_of(testing::replaced(testing::replaced(kGood, "noise_pr", "threshold_pr"), "0.05", "-1")),
              HasSubstr("above zero"));
  for (const char* rows : {"0.5", "1e300"})
    EXPECT_THAT(error_of(testing::replaced(testing::replaced(kGood, "noise_pr", "table_size"), "0.05", rows)),
                HasSubstr("whole numbers of rows"));
  EXPECT_THAT(with("noise_pr", "si.similarity"), HasSubstr("an option of si, which is not in use"));
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

TEST(Specification, TheProgramCarriesThePapersExperiments) {
  EXPECT_THAT(
      built_in_experiments(),
      ElementsAre("clutter", "cranfield-fpfh", "cranfield-shot", "cranfield", "density", "detectors-fpfh", "detectors",
                  "extended-clutter", "extended-inlier-ratio", "extended-noise", "extended-overlap", "extended-size",
                  "extended-time", "inlier-ratio", "matches", "noise", "occlusion", "overlap", "peers-heaps",
                  "peers-views", "scoreboard", "size", "threshold", "time", "tuned-clutter", "tuned-inlier-ratio",
                  "tuned-noise", "tuned-overlap", "tuning-consistency", "tuning-spectral"));
  std::string figures;
  for (const std::string& name : built_in_experiments()) {
    const Experiment experiment = read_experiment(name);
    EXPECT_EQ(experiment.info.name, name);
    figures += experiment.info.figure;
    if (!experiment.info.figure.empty()) {
      EXPECT_EQ(experiment.info.methods, expand_groupers({"paper"})) << name;
    }
  }
  std::sort(figures.begin(), figures.end());
  EXPECT_EQ(figures, "abcdefgh");
  EXPECT_EQ(read_experiment("noise").info.levels.size(), 9u);
  EXPECT_EQ(read_experiment("threshold").info.levels.size(), 10u);
  EXPECT_EQ(read_experiment("matches").info.levels.front().label, "<500");
  EXPECT_EQ(read_experiment("matches").varied, "harris.radius_pr");
  EXPECT_EQ(read_experiment("matches").varied_values.size(), 9u);
  EXPECT_THAT(io_error_of([] { read_experiment("nose"); }), HasSubstr("did you mean 'noise'?"));
}

TEST(Specification, APresetGivesTheOptionsOfWhatIsInUse) {
  const auto options_of = [](const Experiment& experiment, const std::string& name) {
    return options_at(experiment, name, experiment.info.levels[0]);
  };
  const std::string tuned = testing::replaced(kGood, "levels", "preset = \"tuned\"\nlevels");
  const Experiment experiment = parse_experiment("x.toml", tuned);
  EXPECT_EQ(options_of(experiment, "st"), (OptionOverrides{{"similarity", "0.9"}}));
  EXPECT_EQ(options_of(experiment, "gc").at("tolerance_pr"), "2");
  EXPECT_EQ(experiment.options.count("mac"), 0u) << "takes no part";
  const Experiment own = parse_experiment("x.toml", testing::replaced(tuned, "tolerance_pr = 2", "tolerance_pr = 7"));
  EXPECT_EQ(options_of(own, "gc").at("tolerance_pr"), "7") << "what the experiment says comes last";
  const Experiment as_run =
      parse_experiment("x.toml", testing::replaced(experiment_text("noise"), "\"paper\"", "\"as-run\""));
  EXPECT_EQ(options_of(as_run, "si"), (OptionOverrides{{"form", "rotation"}, {"otsu", "covis"}}));
  EXPECT_TRUE(options_of(as_run, "gc").empty());
  EXPECT_THAT(error_of(testing::replaced(tuned, "\"tuned\"", "\"tund\"")), HasSubstr("did you mean 'tuned'?"));
  EXPECT_THAT(error_of(testing::replaced(tuned, "\"tuned\"", "\"mine\"")),
              HasSubstr("expected one of as-run, tuned, paper"));
}

// The files of paper/tuning are experiments, on the pairs that the experiments with tuned options leave out.
TEST(Specification, NoPairServesForTuningAndForResults) {
  const std::vector<std::string> models = {"armadillo", "bear"};
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(CORRAL_SOURCE_DIR "/paper/tuning")) {
    if (entry.path().extension() != ".toml") continue;
    const Experiment experiment = read_experiment(entry.path().string());
    ASSERT_EQ(experiment.filters.size(), 1u) << entry.path();
    EXPECT_EQ(experiment.filters[0].attribute, "model");
    EXPECT_EQ(experiment.filters[0].values, models);
    ++files;
  }
  EXPECT_EQ(files, 18);
  for (const char* kind : {"extended", "tuned"})
    for (const char* subject : {"overlap", "clutter", "noise"}) {
      const Experiment experiment = read_experiment(std::string(kind) + "-" + subject);
      EXPECT_EQ(experiment.info.methods, expand_groupers({"all"}));
      ASSERT_EQ(experiment.exceptions.size(), 1u) << experiment.info.name;
      EXPECT_EQ(experiment.exceptions[0].attribute, "model");
      EXPECT_EQ(experiment.exceptions[0].values, models);
    }
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
