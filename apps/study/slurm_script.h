// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/study/plan.h"

namespace corral {

/// The shards of a study as a job array of Slurm, and the job that merges them. Limits and names are as sbatch accepts them.
struct SlurmJobs {
  std::vector<std::string> evaluate;  ///< the words of the call, without --shard; paths that every node understands
  std::vector<std::string> merge;     ///< the words of the call that follows
  std::string folder;                 ///< of the scripts and of what the jobs print; absolute
  int shards = 1;
  int at_once = 0;                 ///< shards; 0: as many as the cluster lets run
  int processors = 1;              ///< of a shard
  std::string time, memory;        ///< of a shard
  std::string partition, account;  ///< empty: the cluster's default
};

/// The limits of a shard: three times what the longest is expected to take and 10 minutes, twice what the largest is and 256 MB.
/// Estimates are those of another machine, and Slurm ends what exceeds a limit.
std::string time_limit(const std::vector<ShardPlan>& plan, int processors);
std::string memory_limit(const std::vector<ShardPlan>& plan, int processors);

/// The batch script of the array, whose element i is shard i: shards.sbatch. It passes the signal of Slurm on to the program,
/// and an element that a signal ended puts itself back into the queue: before its limit of time up to 100 times, else (lack of
/// memory) up to five; Slurm does that for one that is lost with its node. Each continues where it ended.
std::string shards_script(const SlurmJobs& jobs);

/// The batch script of the merge: merge.sbatch.
std::string merge_script(const SlurmJobs& jobs);

/// What a shell is told to submit both; it prints the number of the array, then that of the merge. The merge follows however
/// the shards end: it names those that are unfinished.
std::string submission(const SlurmJobs& jobs);

}  // namespace corral
