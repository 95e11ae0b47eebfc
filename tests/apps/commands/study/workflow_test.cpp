// SPDX-License-Identifier: MIT
// apps/workflow, tests/slurm and tests/ssh, each where its engine is installed: the study is that of one run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/small_study.h"

namespace corral {
namespace {

using namespace testing;

const std::string kSource = CORRAL_SOURCE_DIR;

class Workflow : public ::testing::Test {
 protected:
  Workflow() {
    put_small_dataset(place_);
    place_.put("a test.toml", kSmallExperiment);
    ::setenv("CORRAL", CORRAL_PROGRAM, 1);
  }
  ~Workflow() override { ::unsetenv("CORRAL"); }
  static bool has(const std::string& tool) { return std::system(("command -v " + tool + " > /dev/null").c_str()) == 0; }
  /// The status of a line, typed in the folder.
  int run(const std::string& line) const {
    const int ended = std::system(("cd '" + place_ / "." + "' && ( " + line + " ) > log 2>&1").c_str());
    return WIFEXITED(ended) ? WEXITSTATUS(ended) : -1;
  }
  void expect_as_one_run(const std::string& study) const {
    ASSERT_EQ(place_.corral("evaluate 'a test.toml' --data data -o whole").status, 0);
    EXPECT_EQ(lasting_files(place_, study), lasting_files(place_, "whole"));
  }
  /// Runs a script of tests/ that kills shards of a study while they work, so of one that takes longer.
  int disturb(const std::string& script) const {
    std::string longer = kSmallExperiment;
    longer.replace(longer.find("repeats = 2"), 11, "repeats = 999");
    place_.put("long.toml", longer);
    return run(script + " " CORRAL_PROGRAM " data long.toml");
  }
  const Workplace place_;
};

TEST_F(Workflow, Parallel) {
  if (!has("parallel")) GTEST_SKIP() << "GNU parallel is not installed";
  const std::string call = kSource + "/apps/workflow/parallel 4 'a study' 'a test.toml' --data data";
  EXPECT_EQ(run(call), 0) << place_.text("log");
  EXPECT_EQ(lines_in(place_.text("a study/parallel.log")), 1u + 4u);
  expect_as_one_run("a study");
  EXPECT_EQ(run(call), 0) << "again: " << place_.text("log");
  expect_as_one_run("a study");
}

TEST_F(Workflow, Snakemake) {
  if (!has("snakemake")) GTEST_SKIP() << "Snakemake is not installed";
  const std::string call = "snakemake -s " + kSource + "/apps/workflow/Snakefile --configfile " + kSource +
                           "/apps/workflow/study.yaml --cores 2 --config program=" CORRAL_PROGRAM
                           " 'experiments=[\"a test.toml\"]' data=data 'study=a study' shards=4";
  EXPECT_EQ(run(call), 0) << place_.text("log");
  expect_as_one_run("a study");
  EXPECT_EQ(run(call), 0);
  EXPECT_THAT(place_.text("log"), ::testing::HasSubstr("Nothing to be done"));
}

TEST_F(Workflow, EveryEngineGivesThePlugInsOfAStudyToItsMerge) {
  const std::string plugin = "--plugin " CORRAL_LENGTHS_PLUGIN;
  ASSERT_EQ(place_.corral("evaluate 'a test.toml' --data data -o whole " + plugin).status, 0);
  const std::map<std::string, std::string> expected = lasting_files(place_, "whole");
  EXPECT_THAT(expected.at("records.csv"), ::testing::HasSubstr(",lengths,"));
  if (has("parallel")) {
    EXPECT_EQ(run(kSource + "/apps/workflow/parallel 2 'of parallel' 'a test.toml' --data data " + plugin), 0)
        << place_.text("log");
    EXPECT_EQ(lasting_files(place_, "of parallel"), expected);
  }
  if (has("snakemake")) {
    EXPECT_EQ(run("snakemake -s " + kSource +
                  "/apps/workflow/Snakefile --cores 2 --config program=" CORRAL_PROGRAM
                  " 'experiments=[\"a test.toml\"]' data=data 'study=of snakemake' shards=2 'options=[\"--plugin\", "
                  "\"" CORRAL_LENGTHS_PLUGIN "\"]'"),
              0)
        << place_.text("log");
    EXPECT_EQ(lasting_files(place_, "of snakemake"), expected);
  }
}

TEST_F(Workflow, Ssh) {
  const int status = disturb(kSource + "/tests/ssh");
  if (status == 77) GTEST_SKIP() << place_.text("log");
  EXPECT_EQ(status, 0) << place_.text("log");
}

TEST_F(Workflow, Slurm) {
  const int status = disturb("SHARDS=3 " + kSource + "/tests/slurm");
  if (status == 77) GTEST_SKIP() << place_.text("log");
  EXPECT_EQ(status, 0) << place_.text("log");
}

}  // namespace
}  // namespace corral
