// SPDX-License-Identifier: MIT
// corral submit slurm, with an sbatch that runs what it is given. tests/slurm has a real Slurm.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/small_study.h"

namespace corral {
namespace {

using namespace testing;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::StartsWith;

/// Runs the elements of an array one after the other, and a merge behind them.
const char* const kSbatch = R"sh(#!/bin/sh
echo "$*" >> "$CALLS"
for script; do :; done
case $script in
  shards.sbatch) for i in 3 1 2; do SLURM_ARRAY_TASK_ID=$i sh $script >&2 || exit; done; echo '17;cluster' ;;
  merge.sbatch) sh $script >&2 && echo 18 ;;
esac
)sh";

class Submit : public ::testing::Test {
 protected:
  Submit() {
    put_small_dataset(place_);
    place_.put("small.toml", kSmallExperiment);
  }
  ~Submit() override { ::setenv("PATH", path_.c_str(), 1); }
  /// From now on `sbatch` is this.
  void install(const std::string& sbatch) const {
    std::filesystem::create_directory(place_ / "bin");
    place_.put("bin/sbatch", sbatch);
    std::filesystem::permissions(place_ / "bin/sbatch", std::filesystem::perms::owner_all);
    ::setenv("PATH", (place_ / "bin:" + path_).c_str(), 1);
    ::setenv("CALLS", (place_ / "calls").c_str(), 1);
  }
  Outcome submit(const std::string& rest) const { return place_.corral("submit slurm small.toml --data data " + rest); }
  const std::string path_ = ::getenv("PATH");
  const Workplace place_;
};

TEST_F(Submit, GoesFromTheCallToTheTablesOfOneRun) {
  install(kSbatch);
  ASSERT_EQ(place_.corral("evaluate small.toml --data data --set gc.tolerance_pr=2 -o whole").status, 0);
  const Outcome outcome =
      submit("-o \"it's here\" --set gc.tolerance_pr=2 --shards 3 --cache 'c d' --jobs 2 --go --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("they are job 17;cluster, and job 18 merges them"));
  const auto json = outcome.json();
  EXPECT_EQ(json["shards"], 3);
  EXPECT_EQ(json["jobs"]["shards"], "17;cluster");
  EXPECT_EQ(json["jobs"]["merge"], "18");
  EXPECT_EQ(place_.text("calls"), "--parsable shards.sbatch\n--parsable --dependency=afterany:17 merge.sbatch\n");
  EXPECT_EQ(lasting_files(place_, "it's here"), lasting_files(place_, "whole"));
  EXPECT_TRUE(std::filesystem::exists(place_ / "c d"));
}

TEST_F(Submit, WithoutGoPrintsWhatToType) {
  install("#!/bin/sh\necho called >> \"$CALLS\"\n");
  const Outcome outcome = submit("-o run --shards 3 --partition short --time 1-00:00:00 --memory 2G --at-once 2");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(place_ / "calls"));
  EXPECT_THAT(outcome.out,
              AllOf(StartsWith("cd " + place_ / "run/slurm &&"), HasSubstr("sbatch --parsable shards.sbatch")));
  EXPECT_THAT(outcome.err, HasSubstr("3 shards, each with at most 1-00:00:00 of time and 2G of memory"));
  EXPECT_THAT(place_.text("run/slurm/shards.sbatch"),
              AllOf(HasSubstr("--array=1-3%2\n"), HasSubstr("--partition=short\n"), HasSubstr("--time=1-00:00:00\n"),
                    HasSubstr("--mem=2G\n"), HasSubstr(place_ / "small.toml"), HasSubstr(place_ / "data")));
}

TEST_F(Submit, SaysWhatIsWrong) {
  const auto error = [&](const std::string& rest, int status) {
    const Outcome outcome = submit("-o run " + rest);
    EXPECT_EQ(outcome.status, status) << rest << ": " << outcome.err;
    return outcome.err;
  };
  EXPECT_THAT(error("--shards 0", 2), HasSubstr("--shards: expected 1 .. 100000"));
  EXPECT_THAT(error("--shards 1001", 2), HasSubstr("a job array of this cluster has at most 1000 elements"));
  EXPECT_EQ(error("--shards 1001 --max-array 4001", 0), submit("-o run --shards 1001 --max-array 4001").err);
  EXPECT_THAT(error("--shards 3 --partition 'a b'", 2), HasSubstr("--partition: found 'a b', expected letters"));
  EXPECT_THAT(error("--shards 3 --memory 2G#", 2), HasSubstr("--memory"));
  EXPECT_THAT(error("--shards 3 --jobs 0", 2), HasSubstr("--jobs: expected 1 .. 256"));
  EXPECT_THAT(error("--shards 3 --at-once -1", 2), HasSubstr("--at-once: expected at least 1"));
  EXPECT_THAT(place_.corral("submit slurm time --data data -o run --shards 3").err, HasSubstr("b3r"));
  EXPECT_THAT(submit("--shards 3 -o small.toml").err, HasSubstr("small.toml"));
  install("#!/bin/sh\necho 'sbatch: error: invalid partition' >&2\nexit 1\n");
  EXPECT_THAT(error("--shards 3 --go", 1),
              AllOf(HasSubstr("invalid partition"), HasSubstr("did not accept the job array")));
  install("#!/bin/sh\ncase $* in *merge*) exit 1;; esac\necho 5\n");
  EXPECT_THAT(error("--shards 3 --go", 1), HasSubstr("sbatch accepted the job array 5, but not the merge"));
  ::setenv("PATH", "/nowhere", 1);
  EXPECT_EQ(error("--shards 3 --go", 1),
            "corral: sbatch is not installed here: submit where the cluster's jobs are submitted\n");
}

}  // namespace
}  // namespace corral
