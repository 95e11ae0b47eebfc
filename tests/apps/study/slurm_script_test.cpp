// SPDX-License-Identifier: MIT
#include "apps/study/slurm_script.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/io/scratch.h"

namespace corral {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::put_text;
using testing::ScratchFolder;

/// Words that a shell would take apart, expand or drop.
const std::vector<std::string> kHardWords = {"a b", "it's", "\"", "$HOME",      "`ls`",    "\\", "",         "*",
                                             "~",   "-n",   "#x", "two\nlines", "a;b&c|d", "!1", "\xC3\xA4", "'"};

/// What a shell prints that runs a script.
std::string printed_by(const std::string& script, const std::string& variables = "") {
  const ScratchFolder folder;
  put_text(folder / "script", script);
  EXPECT_EQ(std::system((variables + " sh '" + folder / "script" + "' > '" + folder / "out" + "'").c_str()), 0);
  return testing::text_of(folder / "out");
}

/// A call that prints each of its words in brackets.
std::vector<std::string> printing(const std::vector<std::string>& words) {
  std::vector<std::string> call = {"printf", "[%s]"};
  call.insert(call.end(), words.begin(), words.end());
  return call;
}

std::string in_brackets(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += "[" + word + "]";
  return text;
}

TEST(SlurmScript, AShellGetsEveryWordAsItIs) {
  SlurmJobs jobs;
  jobs.evaluate = jobs.merge = printing(kHardWords);
  jobs.shards = 7;
  EXPECT_EQ(printed_by(shards_script(jobs), "SLURM_ARRAY_TASK_ID=3"), in_brackets(kHardWords) + "[--shard][3/7]");
  EXPECT_EQ(printed_by(merge_script(jobs)), in_brackets(kHardWords));
}

TEST(SlurmScript, AsksForWhatIsAskedFor) {
  SlurmJobs jobs;
  jobs.evaluate = {"/bin/corral", "evaluate", "noise"};
  jobs.merge = {"/bin/corral", "merge", "/s"};
  jobs.shards = 50;
  jobs.time = "90";
  jobs.memory = "2G";
  EXPECT_THAT(shards_script(jobs),
              ::testing::StartsWith("#!/bin/sh\n"
                                    "#SBATCH --job-name=corral\n"
                                    "#SBATCH --output=shard-%a.log\n"
                                    "#SBATCH --open-mode=append\n"
                                    "#SBATCH --requeue\n"
                                    "#SBATCH --ntasks=1\n"
                                    "#SBATCH --array=1-50\n"
                                    "#SBATCH --cpus-per-task=1\n"
                                    "#SBATCH --time=90\n"
                                    "#SBATCH --mem=2G\n"
                                    "#SBATCH --signal=B:TERM@60\n"
                                    "trap 'kill -TERM \"$!\" 2> /dev/null' TERM\n"
                                    "/bin/corral evaluate noise --shard \"$SLURM_ARRAY_TASK_ID/50\" &\n"
                                    "shard=$!\n"));
  jobs.at_once = 20;
  jobs.processors = 4;
  jobs.partition = "short";
  jobs.account = "physics";
  EXPECT_THAT(shards_script(jobs), AllOf(HasSubstr("--array=1-50%20\n"), HasSubstr("--cpus-per-task=4\n"),
                                         HasSubstr("--partition=short\n"), HasSubstr("--account=physics\n")));
  EXPECT_THAT(merge_script(jobs), AllOf(HasSubstr("--partition=short\n"), HasSubstr("--account=physics\n"),
                                        HasSubstr("exec /bin/corral merge /s\n"), Not(HasSubstr("array"))));
}

/// What a shard's script does whose program is a line of the shell, where Slurm's own programs say what they were asked.
struct ScriptRun {
  int status;
  std::string log;
};
ScriptRun run_shard(const std::string& program, const std::string& variables, const std::string& state = "RUNNING") {
  const ScratchFolder folder;
  for (const auto& [tool, prints] : {std::pair("squeue", state), std::pair("scontrol", std::string("$*"))}) {
    const std::string path = put_text(folder / tool, "#!/bin/sh\necho \"" + prints + "\"\n");
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  }
  SlurmJobs jobs;
  jobs.evaluate = {"sh", "-c", program};
  put_text(folder / "script", shards_script(jobs));
  const int ended =
      std::system(("cd '" + folder.path() + "' && PATH=\"$PWD:$PATH\" SLURM_ARRAY_JOB_ID=17 SLURM_ARRAY_TASK_ID=3 " +
                   variables + " sh script > log 2>&1")
                      .c_str());
  return {WEXITSTATUS(ended), testing::text_of(folder / "log")};
}

TEST(SlurmScript, AShardThatASignalEndedGoesBackIntoTheQueue) {
  const std::string back = "requeue 17_3\n";
  const ScriptRun killed = run_shard("kill -KILL $$", "");
  EXPECT_EQ(killed.status, 128 + 9);
  EXPECT_THAT(killed.log, HasSubstr("status 137: requeued\n" + back));
  EXPECT_THAT(run_shard("kill -KILL $$", "SLURM_RESTART_COUNT=4").log, HasSubstr(back));
  EXPECT_THAT(run_shard("kill -KILL $$", "SLURM_RESTART_COUNT=5").log, Not(HasSubstr(back))) << "not for ever";
  EXPECT_THAT(run_shard("kill -KILL $$", "", "COMPLETING").log, Not(HasSubstr(back))) << "a user has cancelled it";
  EXPECT_THAT(run_shard("exit 143", "SLURM_RESTART_COUNT=99").log, HasSubstr(back)) << "at its limit of time";
  EXPECT_THAT(run_shard("exit 143", "SLURM_RESTART_COUNT=100").log, Not(HasSubstr(back)));
  EXPECT_THAT(run_shard("exit 143", "", "$(cat asked 2> /dev/null; echo RUNNING > asked)").log, HasSubstr(back))
      << "a controller that did not answer at first";
  for (const int status : {0, 3, 4}) {
    const ScriptRun ended = run_shard("exit " + std::to_string(status), "");
    EXPECT_EQ(ended.status, status);
    EXPECT_EQ(ended.log, "");
  }
}

TEST(SlurmScript, ASignalOfSlurmReachesTheProgramWhichEndsInOrder) {
  // The program sends the signal to the script, as Slurm does, and takes its time to end.
  const ScriptRun ended =
      run_shard("trap 'sleep 0.3; echo in order; exit 143' TERM; kill -TERM $PPID; while :; do sleep 0.05; done", "");
  EXPECT_EQ(ended.status, 143);
  EXPECT_THAT(ended.log, HasSubstr("in order\nexited with status 143: requeued\nrequeue 17_3\n"));
}

TEST(SlurmScript, SubmitsFromTheFolderOfTheScriptsAndMergesBehindTheArray) {
  const ScratchFolder scratch;
  SlurmJobs jobs;
  jobs.folder = scratch / "it's a 100% folder";
  std::filesystem::create_directories(jobs.folder);
  const std::string sbatch =
      put_text(scratch / "sbatch", "#!/bin/sh\necho \"$PWD:$*\" >> ../calls\necho '17;cluster'\n");
  std::filesystem::permissions(sbatch, std::filesystem::perms::owner_all);
  EXPECT_EQ(printed_by(submission(jobs), "PATH='" + scratch.path() + "':\"$PATH\""), "17;cluster\n17;cluster\n");
  EXPECT_EQ(testing::text_of(scratch / "calls"), jobs.folder + ":--parsable shards.sbatch\n" + jobs.folder +
                                                     ":--parsable --dependency=afterany:17 merge.sbatch\n");
}

TEST(SlurmScript, LimitsFollowTheLargestShards) {
  const std::vector<ShardPlan> plan = {{3, 600, 50e6}, {1, 6000, 20e6}, {9, 60, 500e6}};
  EXPECT_EQ(time_limit(plan, 1), "5:10:00");
  EXPECT_EQ(time_limit(plan, 4), "1:25:00");
  EXPECT_EQ(memory_limit(plan, 1), "1256M");
  EXPECT_EQ(memory_limit(plan, 4), "4256M");
  EXPECT_EQ(time_limit({{0, 0, 0}}, 1), "0:10:00");
}

}  // namespace
}  // namespace corral
