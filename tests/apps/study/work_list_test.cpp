// SPDX-License-Identifier: MIT
#include "apps/study/work_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "tests/io/scratch.h"

namespace corral {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::io_error_of;
using testing::put_text;
using testing::ScratchFolder;

/// Two data sets whose files nobody opens.
class WorkListTest : public ::testing::Test {
 protected:
  WorkListTest() {
    put_dataset("b3r", "source",
                "pair,source,target,truth,noise_pr,density\nb1,m.ply,b1.ply,t,0.1,\n"
                "a1,m.ply,a1.ply,t,0.1,1\na2,m.ply,a2.ply,t,0.3,1\na3,m.ply,a3.ply,,0.1,0.5\n");
    put_dataset("u3or", "mean",
                "pair,source,target,truth,clutter,occlusion\np,m.ply,s.ply,t,70,65\n"
                "q,m.ply,s.ply,t,95,69.9\nr,m.ply,s.ply,t,20,90\n");
  }
  void put_dataset(const std::string& name, const std::string& rule, const std::string& pairs) {
    std::filesystem::create_directories(folder_ / name);
    put_text(folder_ / name + "/dataset.toml", "name = \"" + name + "\"\nresolution = \"" + rule + "\"\n");
    put_text(folder_ / name + "/pairs.csv", pairs);
  }
  WorkList list(const std::vector<std::string>& names) const {
    std::vector<Experiment> experiments;
    for (const std::string& name : names) experiments.push_back(read_experiment(name));
    return make_work_list(std::move(experiments), folder_.path());
  }
  static std::string text_of(const WorkList& list) {
    std::string text;
    for (const WorkUnit& unit : list.units) text += unit_text(unit) + "\n";
    for (const StudySample& sample : list.samples) {
      text += std::to_string(sample.experiment) + " " + std::to_string(sample.unit) + " " +
              std::to_string(sample.level) + " " + sample.selection;
      for (const int task : sample.tasks) text += " " + std::to_string(task);
      text += "\n";
    }
    return text;
  }
  static std::vector<std::string> pairs_of(const WorkList& list) {
    std::vector<std::string> pairs;
    for (const WorkUnit& unit : list.units) pairs.push_back(unit.pair.name);
    return pairs;
  }
  ScratchFolder folder_;
};

TEST_F(WorkListTest, FiltersAndLevelsChooseThePairs) {
  put_text(folder_ / "mine.toml",
           "name = \"mine\"\ndataset = \"b3r\"\nattribute = \"noise_pr\"\nlevels = [0.1]\n"
           "[filter]\ndensity = [\"\", \"1.0\"]\n");
  const WorkList found = list({folder_ / "mine.toml"});
  EXPECT_THAT(pairs_of(found), ElementsAre("b1", "a1"));  // as they stand in the set
  EXPECT_EQ(found.units[0].matching.resolution, "source");
  EXPECT_EQ(found.units[0].pair.source,
            (std::filesystem::path(folder_.path()) / "b3r/m.ply").lexically_normal().string());
  EXPECT_TRUE(found.units[0].shares_source);
  EXPECT_FALSE(found.units[0].shares_target);
}

TEST_F(WorkListTest, ExceptionsLeavePairsOut) {
  const auto pairs_with = [&](const std::string& tables) {
    const std::string text =
        "name = \"mine\"\ndataset = \"b3r\"\nattribute = \"noise_pr\"\nlevels = [0.1, 0.3]\n" + tables;
    return pairs_of(make_work_list({parse_experiment("x.toml", text)}, folder_.path()));
  };
  EXPECT_THAT(pairs_with(""), ElementsAre("b1", "a1", "a2", "a3"));
  EXPECT_THAT(pairs_with("[except]\ndensity = [\"\", \"1.0\"]\n"), ElementsAre("a3"));
  EXPECT_THAT(pairs_with("[except]\npair = [\"a1\", \"a3\"]\n"), ElementsAre("b1", "a2"));
  EXPECT_THAT(pairs_with("[except]\npair = [\"a1\"]\nnoise_pr = [\"0.3\"]\n"), ElementsAre("b1", "a3"))
      << "one reason is enough";
  EXPECT_THAT(pairs_with("[filter]\npair = [\"a1\", \"b1\"]\n[except]\npair = [\"b1\"]\n"), ElementsAre("a1"));
  EXPECT_THAT(pairs_with("[except]\nno_such_column = [\"1\"]\n"), ElementsAre("b1", "a1", "a2", "a3"));
}

TEST_F(WorkListTest, BinsAreHalfOpenAndTheLastIsClosed) {
  const WorkList found = list({"clutter"});
  ASSERT_EQ(found.samples.size(), 2u);   // 20 is in none
  EXPECT_EQ(found.samples[0].level, 1);  // 70 is not in [65,70)
  EXPECT_EQ(found.samples[1].level, 5);  // 95 is in [90,95]
  EXPECT_EQ(found.samples[1].value, 95);
}

TEST_F(WorkListTest, ExperimentsShareTheirUnits) {
  const WorkList found = list({"clutter", "occlusion", "threshold"});
  EXPECT_EQ(found.units.size(), 3u);
  EXPECT_EQ(found.samples.size(), 2u + 3u + 30u);
  for (const WorkUnit& unit : found.units) {
    EXPECT_EQ(unit.tasks.size(), 7u);  // each method once, not once for each experiment or threshold
    EXPECT_EQ(unit.thresholds_pr.size(), 10u);
    EXPECT_EQ(unit.selections.size(), 1u);
    EXPECT_EQ(unit.selections.begin()->first, "selections/u3or/3pr/" + unit.pair.name + ".csv")
        << "the paper's setting";
    EXPECT_FALSE(unit.shares_source);  // pr is the mean of each pair's two
  }
}

TEST_F(WorkListTest, TheOrderOfTheCallDoesNotMatter) {
  EXPECT_EQ(text_of(list({"clutter", "noise", "matches"})), text_of(list({"matches", "clutter", "noise"})));
  EXPECT_THAT(io_error_of([&] { list({"noise", "noise"}); }), HasSubstr("two experiments"));
}

TEST_F(WorkListTest, RadiiMakeUnitsAndOptionsMakeTasks) {
  const WorkList matches = list({"matches"});
  EXPECT_EQ(matches.units.size(), 27u);
  std::set<std::string> files;
  for (const StudySample& sample : matches.samples) files.insert(sample.selection);
  EXPECT_EQ(files.size(), 27u);
  put_text(folder_ / "tuning.toml",
           "name = \"tuning\"\ndataset = \"b3r\"\nattribute = \"gc.tolerance_pr\"\n"
           "levels = [1, 2, 3]\ngroupers = [\"gc\"]\n");
  const WorkList tuning = list({folder_ / "tuning.toml"});
  EXPECT_EQ(tuning.units.size(), 4u);
  EXPECT_EQ(tuning.units[0].tasks.size(), 3u);
  EXPECT_EQ(tuning.units[0].tasks[2].options.at("tolerance_pr"), "3");
  EXPECT_EQ(tuning.units[0].selections.size(), 3u);
}

TEST_F(WorkListTest, SeedsDifferByPairAndRepeatAndByNothingElse) {
  put_text(folder_ / "mine.toml",
           "name = \"mine\"\ndataset = \"b3r\"\nattribute = \"noise_pr\"\nlevels = [0.1, 0.3]\n"
           "groupers = [\"ransac\", \"gc\"]\nrepeats = 3\n");
  const WorkList found = list({folder_ / "mine.toml"});
  std::set<std::string> seeds;
  for (const WorkUnit& unit : found.units) {
    EXPECT_EQ(unit.tasks.size(), 4u);  // gc draws nothing
    for (const GroupingTask& task : unit.tasks)
      if (task.method == "ransac") seeds.insert(task.options.at("seed"));
  }
  EXPECT_EQ(seeds.size(), 12u);
  const WorkList noise = list({folder_ / "mine.toml", "noise"});
  for (const WorkUnit& unit : noise.units)
    for (const GroupingTask& task : unit.tasks)
      if (task.method == "ransac") {
        EXPECT_EQ(seeds.count(task.options.at("seed")), 1u);
      }
}

TEST_F(WorkListTest, SaysWhatIsMissing) {
  EXPECT_THAT(io_error_of([&] { list({"overlap"}); }), AllOf(HasSubstr("'u3m'"), HasSubstr("it has b3r, u3or")));
  put_text(folder_ / "mine.toml", "name = \"mine\"\ndataset = \"u3or\"\nattribute = \"cluter\"\nlevels = [70]\n");
  EXPECT_THAT(io_error_of([&] { list({folder_ / "mine.toml"}); }), HasSubstr("did you mean 'clutter'?"));
  put_text(folder_ / "mine.toml", "name = \"mine\"\ndataset = \"u3or\"\nattribute = \"clutter\"\nlevels = [71]\n");
  EXPECT_THAT(io_error_of([&] { list({folder_ / "mine.toml"}); }), HasSubstr("no pair is at any level"));
  put_dataset("u3m", "mean", "pair,source,target,truth,overlap\np,a,b,t,many\n");
  EXPECT_THAT(io_error_of([&] { list({"overlap"}); }), HasSubstr("finite number"));
  put_text(folder_ / "u3m/dataset.toml", "name = \"other\"\n");
  EXPECT_THAT(io_error_of([&] { list({"overlap"}); }), HasSubstr("'other'"));
}

TEST_F(WorkListTest, AFolderThatIsADataSetServesEveryExperiment) {
  put_text(folder_ / "u3or/dataset.toml", "name = \"u3or-real\"\n");
  const WorkList found = make_work_list({read_experiment("clutter")}, folder_ / "u3or");
  EXPECT_EQ(found.experiments[0].info.dataset, "u3or-real");
  EXPECT_EQ(found.units[0].dataset, "u3or-real");
}

TEST(LevelOf, TellsValuesFromIntervals) {
  const std::vector<StudyLevel> values = {{"0.1", 0.1, 0.1}, {"0.3", 0.3, 0.3}};
  EXPECT_EQ(level_of(values, 0.1 + 0.2), 1);
  EXPECT_EQ(level_of(values, 0.2), -1);
  const std::vector<StudyLevel> bins = {{"a", 0, 1}, {"b", 1, 2}};
  EXPECT_EQ(level_of(bins, 1), 1);
  EXPECT_EQ(level_of(bins, 2), 1);
  EXPECT_EQ(level_of(bins, 2.1), -1);
  EXPECT_EQ(level_of(bins, std::nan("")), -1);
}

}  // namespace
}  // namespace corral
