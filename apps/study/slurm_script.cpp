// SPDX-License-Identifier: MIT
#include "apps/study/slurm_script.h"

#include <algorithm>
#include <cmath>

#include "apps/runtime/child_program.h"

namespace corral {
namespace {

std::string shell_words(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + shell_word(word);
  return line;
}

std::string option(const std::string& name, const std::string& value) {
  return value.empty() ? "" : "#SBATCH --" + name + "=" + value + "\n";
}

/// What both jobs have. sbatch has rules of its own for paths in such lines: the one here is a bare name, in the folder that
/// sbatch is called in. What a job prints is appended, as one that is requeued prints twice.
std::string head(const SlurmJobs& jobs, const std::string& name, const std::string& output) {
  return "#!/bin/sh\n" + option("job-name", name) + option("partition", jobs.partition) +
         option("account", jobs.account) + option("output", output) + option("open-mode", "append") +
         "#SBATCH --requeue\n#SBATCH --ntasks=1\n";
}

/// In front of the start of a shard, so that no signal comes before it.
constexpr char kPassOn[] = "trap 'kill -TERM \"$!\" 2> /dev/null' TERM\n";

/// What follows the start of a shard. Slurm itself requeues what is lost with a node, but not what a signal ended. A wait that
/// a signal interrupts returns before the shard has ended. The state is no longer RUNNING where a user cancels the job. The
/// task goes by its array, as the last one of an array has the number of the whole for its job. 143 is an end in order, as before
/// the limit of time, with more pairs done each time; other signals may come every time. A busy controller may not answer at once.
constexpr char kWatch[] =
    "shard=$!\n"
    "task=${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID\n"
    "while wait \"$shard\"; status=$?; kill -0 \"$shard\" 2> /dev/null; do :; done\n"
    "most=5\n"
    "if [ \"$status\" = 143 ]; then most=100; fi\n"
    "if [ \"$status\" -gt 128 ] && [ \"${SLURM_RESTART_COUNT:-0}\" -lt \"$most\" ]; then\n"
    "  for try in 1 2 3 4 5; do\n"
    "    state=$(squeue -h -j \"$task\" -o %T)\n"
    "    if [ -n \"$state\" ] && [ \"$state\" != RUNNING ]; then break; fi\n"
    "    if [ -n \"$state\" ]; then\n"
    "      echo \"exited with status $status: requeued\"\n"
    "      if scontrol requeue \"$task\"; then break; fi\n"
    "    fi\n"
    "    sleep 2\n"
    "  done\n"
    "fi\n"
    "exit \"$status\"\n";

}  // namespace

std::string time_limit(const std::vector<ShardPlan>& plan, int processors) {
  double longest = 0;
  for (const ShardPlan& shard : plan) longest = std::max(longest, shard.seconds);
  const long minutes = static_cast<long>(std::ceil(10 + 3 * longest / processors / 60));
  return std::to_string(minutes / 60) + (minutes % 60 < 10 ? ":0" : ":") + std::to_string(minutes % 60) + ":00";
}

std::string memory_limit(const std::vector<ShardPlan>& plan, int processors) {
  double largest = 0;
  for (const ShardPlan& shard : plan) largest = std::max(largest, shard.peak_bytes);
  return std::to_string(static_cast<long>(std::ceil(256 + 2 * largest * processors / 1e6))) + "M";
}

std::string shards_script(const SlurmJobs& jobs) {
  const std::string count = std::to_string(jobs.shards);
  // B: the signal goes to the process of the script, which passes it on.
  return head(jobs, "corral", "shard-%a.log") +
         option("array", "1-" + count + (jobs.at_once > 0 ? "%" + std::to_string(jobs.at_once) : "")) +
         option("cpus-per-task", std::to_string(jobs.processors)) + option("time", jobs.time) +
         option("mem", jobs.memory) + option("signal", "B:TERM@60") + kPassOn + shell_words(jobs.evaluate) +
         " --shard \"$SLURM_ARRAY_TASK_ID/" + count + "\" &\n" + kWatch;
}

std::string merge_script(const SlurmJobs& jobs) {
  // Twice what the merge of 100,000 pairs may take.
  return head(jobs, "corral-merge", "merge.log") + option("time", "10") + option("mem", "4G") + "exec " +
         shell_words(jobs.merge) + "\n";
}

std::string submission(const SlurmJobs& jobs) {
  // The number of a job may be followed by ";" and the name of its cluster.
  return "cd " + shell_word(jobs.folder) +
         " &&\n"
         "  shards=$(sbatch --parsable shards.sbatch) && echo \"$shards\" &&\n"
         "  sbatch --parsable --dependency=\"afterany:${shards%%;*}\" merge.sbatch\n";
}

}  // namespace corral
