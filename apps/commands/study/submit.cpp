// SPDX-License-Identifier: MIT
// corral submit: the shards of a study as jobs of a cluster.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "apps/commands/command_options.h"
#include "apps/commands/study/study_options.h"
#include "apps/runtime/child_program.h"
#include "apps/runtime/output.h"
#include "apps/study/shard.h"
#include "apps/study/slurm_script.h"
#include "io/disk/file.h"
#include "kernel/error.h"

namespace corral {
namespace {

namespace fs = std::filesystem;

struct Settings {
  StudyOptions options;
  std::string study, cache;
  std::uint64_t cache_limit = 0;
  SlurmJobs jobs;
  int max_array = 1001;
  bool go = false, json = false;
};

std::string absolute(const std::string& path) { return fs::absolute(path).lexically_normal().string(); }

/// sbatch reads these from lines with rules of their own, which no accepted value needs.
void check_plain(const std::string& option, const std::string& value) {
  if (shell_word(value) != value && !value.empty())
    throw UsageError(option + ": found '" + value + "', expected letters, digits and _-./=,:+");
}

void check(const Settings& settings) {
  const SlurmJobs& jobs = settings.jobs;
  if (jobs.shards < 1 || jobs.shards > kMostShards)
    throw UsageError("--shards: expected 1 .. " + std::to_string(kMostShards));
  if (jobs.shards >= settings.max_array)
    throw UsageError("--shards: a job array of this cluster has at most " + std::to_string(settings.max_array - 1) +
                     " elements (MaxArraySize in 'scontrol show config', here --max-array, is " +
                     std::to_string(settings.max_array) + "): ask for fewer shards, which are longer");
  if (jobs.at_once < 0) throw UsageError("--at-once: expected at least 1");
  if (jobs.processors < 1 || jobs.processors > 256) throw UsageError("--jobs: expected 1 .. 256");
  check_plain("--partition", jobs.partition), check_plain("--account", jobs.account);
  check_plain("--time", jobs.time), check_plain("--memory", jobs.memory);
}

/// The words of both calls, with paths that do not depend on the folder a job starts in.
void put_calls(const Settings& settings, SlurmJobs& jobs) {
  const std::string program = fs::read_symlink("/proc/self/exe").string(), study = absolute(settings.study);
  StudyOptions options = settings.options;
  for (std::string& experiment : options.experiments)
    if (fs::exists(experiment)) experiment = absolute(experiment);
  options.data = absolute(options.data);
  if (!options.methods.empty()) options.methods = absolute(options.methods);
  for (std::string& file : options.external.plugins) file = absolute(file);
  jobs.evaluate = {program, "evaluate"};
  const auto add = [&](const std::vector<std::string>& words) {
    jobs.evaluate.insert(jobs.evaluate.end(), words.begin(), words.end());
  };
  add(words_of(options));
  add({"-o", study, "--jobs", std::to_string(jobs.processors)});
  if (!settings.cache.empty()) add({"--cache", absolute(settings.cache)});
  if (settings.cache_limit > 0) add({"--cache-limit", std::to_string(settings.cache_limit)});
  jobs.merge = {program, "merge", study};
  for (const std::string& file : options.external.plugins) jobs.merge.insert(jobs.merge.end(), {"--plugin", file});
  jobs.folder = study + "/slurm";
}

/// Submits both jobs and returns their numbers.
std::vector<std::string> submit(const std::string& submission) {
  if (std::system("command -v sbatch > /dev/null 2>&1") != 0)
    throw std::runtime_error("sbatch is not installed here: submit where the cluster's jobs are submitted");
  std::FILE* shell = ::popen(submission.c_str(), "r");
  if (!shell) throw std::runtime_error("a shell could not be started");
  std::string printed;
  for (int letter; (letter = std::fgetc(shell)) != EOF;) printed += static_cast<char>(letter);
  const bool is_submitted = ::pclose(shell) == 0;
  std::vector<std::string> numbers;
  for (std::size_t begin = 0, end; (end = printed.find('\n', begin)) != std::string::npos; begin = end + 1)
    numbers.push_back(printed.substr(begin, end - begin));
  if (!is_submitted || numbers.size() != 2)
    throw std::runtime_error(numbers.empty() ? "sbatch did not accept the job array; its message is above"
                                             : "sbatch accepted the job array " + numbers[0] +
                                                   ", but not the merge; its message is above");
  return numbers;
}

int submit_slurm(Settings settings) {
  check(settings);
  SlurmJobs& jobs = settings.jobs;
  const WorkList list = work_list_of(settings.options);
  for (const Experiment& experiment : list.experiments)
    if (experiment.sweep == Sweep::TableSize)
      throw UsageError(experiment.info.name + ": times are taken on one machine, by 'corral evaluate'");
  const std::vector<ShardPlan> plan = plan_shards(estimate_units(list), jobs.shards);
  if (jobs.time.empty()) jobs.time = time_limit(plan, jobs.processors);
  if (jobs.memory.empty()) jobs.memory = memory_limit(plan, jobs.processors);
  put_calls(settings, jobs);
  fs::create_directories(jobs.folder);
  write_file(jobs.folder + "/shards.sbatch", shards_script(jobs));
  write_file(jobs.folder + "/merge.sbatch", merge_script(jobs));
  const std::string text = submission(jobs);
  const std::vector<std::string> numbers = settings.go ? submit(text) : std::vector<std::string>();
  if (settings.json)
    put("", Json{{"folder", jobs.folder},
                 {"shards", jobs.shards},
                 {"time", jobs.time},
                 {"memory", jobs.memory},
                 {"submission", text},
                 {"jobs", numbers.empty() ? Json(nullptr) : Json{{"shards", numbers[0]}, {"merge", numbers[1]}}}});
  else if (numbers.empty())
    put("", text);
  say(std::to_string(jobs.shards) + " shards, each with at most " + jobs.time + " of time and " + jobs.memory +
      " of memory; " +
      (numbers.empty() ? "the scripts are in " + jobs.folder
                       : "they are job " + numbers[0] + ", and job " + numbers[1] +
                             " merges them; what both print is in " + jobs.folder));
  return kOk;
}

}  // namespace

void add_submit(CLI::App& app, Action& action) {
  auto* submit = app.add_subcommand("submit", "The shards of a study as jobs of a cluster: slurm");
  submit->require_subcommand(1);
  auto* command = submit->add_subcommand("slurm", "As a job array of Slurm, and a job that merges them");
  auto settings = std::make_shared<Settings>();
  SlurmJobs& jobs = settings->jobs;
  add_study_options(*command, settings->options);
  command->add_option("-o,--output", settings->study, "Folder of the study, which every node can write")
      ->type_name("FOLDER")
      ->required();
  command->add_option("--shards", jobs.shards, "Elements of the array; results do not depend on it")->required();
  command->add_option("--at-once", jobs.at_once,
                      "Shards that run at a time, at most (default: what the cluster allows)");
  command->add_option("--jobs", jobs.processors, "Pairs at a time in a shard: the processors that it asks for")
      ->capture_default_str();
  command->add_option("--partition", jobs.partition, "As for sbatch (default: the cluster's)");
  command->add_option("--account", jobs.account, "As for sbatch (default: the cluster's)");
  command->add_option("--time", jobs.time,
                      "Limit of a shard, as for sbatch (default: three times the plan's longest, and 10 minutes)");
  command->add_option("--memory", jobs.memory,
                      "Memory of a shard, as for sbatch --mem (default: twice the plan's largest, and 256 MB)");
  command->add_option("--max-array", settings->max_array, "MaxArraySize of the cluster")->capture_default_str();
  command->add_option("--cache", settings->cache, "As for 'corral evaluate'")->type_name("FOLDER");
  add_size(*command, "--cache-limit", settings->cache_limit, "As for 'corral evaluate'");
  command->add_flag("--go", settings->go, "Submit; without it, the scripts are written and what to type is printed");
  command->add_flag("--json", settings->json, "Limits, commands and numbers of the jobs as JSON");
  command->footer(
      "Writes shards.sbatch and merge.sbatch to the folder slurm of the study; what the jobs print goes there too. A\n"
      "shard that is killed, preempted, lost with its node or at its limit of time goes back into the queue,\n"
      "and continues where it ended. The merge names what is unfinished: then the same call is submitted again.\n"
      "Other options of sbatch: its variables "
      "(SBATCH_QOS).\n"
      "Examples:\n  corral submit slurm noise density --data data -o runs/b3r --shards 50 --at-once 20\n"
      "  corral submit slurm noise --data data -o runs/b3r --shards 8 --jobs 4 --partition short --go");
  command->callback([settings, &action] { action = [settings] { return submit_slurm(*settings); }; });
}

}  // namespace corral
