// SPDX-License-Identifier: MIT
// corral evaluate: experiments on data sets, into the folder of a study.
#include <algorithm>
#include <optional>

#include "apps/commands/command_options.h"
#include "apps/commands/study/study_options.h"
#include "apps/commands/study/study_text.h"
#include "apps/runtime/child_program.h"
#include "apps/runtime/output.h"
#include "apps/runtime/progress.h"
#include "apps/runtime/text_table.h"
#include "apps/study/study.h"
#include "apps/study/time_study.h"
#include "kernel/error.h"

namespace corral {
namespace {

struct Settings {
  StudyOptions options;
  StudySettings study;
  std::optional<int> jobs;
  std::optional<std::string> shard;
  bool explain = false, json = false;
};

std::string times_text(const std::vector<TimeRow>& rows) {
  TextTable table({"matches", "grouper", "calls", "median ms", "lower quartile", "upper quartile"});
  for (const TimeRow& row : rows)
    table.add({row.level, row.method, std::to_string(row.runs), fixed(row.median_ms, 4),
               fixed(row.lower_quartile_ms, 4), fixed(row.upper_quartile_ms, 4)});
  return table.str();
}

int evaluate_time(const Settings& settings, const WorkList& list) {
  if (settings.jobs) throw UsageError("--jobs: not for times, which are taken in one thread");
  std::vector<TimeRow> rows;
  {
    const Experiment& experiment = list.experiments.front();
    Progress progress(1 + experiment.tables * static_cast<double>(experiment.info.levels.size()));
    rows = run_time_study(list, settings.study, [&](const std::string& what) { progress.begin(what); });
  }
  Json json = Json::array();
  for (const TimeRow& row : rows)
    json.push_back({{"level", row.level}, {"method", row.method}, {"runs", row.runs}, {"median_ms", row.median_ms}});
  if (settings.json)
    put("", Json{{"run", settings.study.run}, {"times", json}});
  else
    put("", times_text(rows));
  say("the study is in " + settings.study.run);
  return kOk;
}

int evaluate_pairs(const Settings& settings, const StudyCall& call, const WorkList& list) {
  std::optional<Progress> progress;
  StudyObserver observer;
  observer.progress = [&](const StudyProgress& now) {
    const bool is_first = !progress;
    if (is_first) progress.emplace(static_cast<double>(now.total - now.done));
    progress->begin(progress_text(now, is_first));
  };
  observer.stopped = [&](const StudyProgress& now) {
    progress.reset();
    say("corral: stopped with " + std::to_string(now.done) + " of " + std::to_string(now.total) +
        " pairs done; the same command continues");
  };
  const StudyOutcome outcome = run_study(list, call, settings.study, observer);
  progress.reset();
  say_study(outcome);
  if (settings.json) {
    Json json = study_json(settings.study.run, outcome);
    if (settings.shard) json["shard"] = to_text(settings.study.shard);
    if (settings.explain) json["explanation"] = explanation_json(outcome.losses);
    put("", json);
  } else if (settings.shard) {
    say("shard " + to_text(settings.study.shard) + ": " + counts_text(outcome) +
        "; when all shards are done: corral merge " + settings.study.run);
  } else {
    put("", overview_text(outcome.summary));
    if (settings.explain) put("", "\n" + explanation_text(outcome.losses));
    say(counts_text(outcome) + "; the study is in " + settings.study.run);
  }
  return outcome.failed > 0 ? kPartial : kOk;
}

/// The call as it would be typed again.
std::string command_line(const Settings& settings) {
  std::string line = "corral evaluate";
  for (const std::string& word : words_of(settings.options)) line += " " + shell_word(word);
  line += " -o " + settings.study.run;
  if (settings.shard) line += " --shard " + *settings.shard;
  if (settings.jobs) line += " --jobs " + std::to_string(*settings.jobs);
  if (!settings.study.cache.empty()) line += " --cache " + settings.study.cache;
  if (settings.study.cache_limit > 0) line += " --cache-limit " + std::to_string(settings.study.cache_limit);
  return line + (settings.explain ? " --explain" : "") + (settings.json ? " --json" : "");
}

int evaluate(Settings settings) {
  if (settings.jobs && (*settings.jobs < 1 || *settings.jobs > 256)) throw UsageError("--jobs: expected 1 .. 256");
  if (settings.shard) try {
      settings.study.shard = parse_shard(*settings.shard);
    } catch (const InvalidInput& error) {
      throw UsageError(error.what());
    }
  if (settings.shard && settings.explain) throw UsageError("--explain: not with --shard, but 'corral merge' has it");
  settings.study.jobs = settings.jobs.value_or(0);
  settings.study.command_line = command_line(settings);
  const StudyCall call = study_call(settings.options);
  const WorkList list = work_list_of(settings.options);
  const bool has_times = std::any_of(list.experiments.begin(), list.experiments.end(),
                                     [](const Experiment& experiment) { return experiment.sweep == Sweep::TableSize; });
  if (!has_times) return evaluate_pairs(settings, call, list);
  if (list.experiments.size() > 1)
    throw UsageError("times are taken alone: evaluate the other experiments in another study");
  if (settings.shard) throw UsageError("--shard: not for times, which are compared on one machine");
  if (settings.explain) throw UsageError("--explain: not for times, as they judge no pose");
  return evaluate_time(settings, list);
}

std::string footer() {
  std::string names;
  for (const std::string& name : built_in_experiments()) names += (names.empty() ? "" : ", ") + name;
  return "Experiments of the paper: " + names +
         ".\nAn experiment of your own is such a file (paper/README.md explains the keys). An interrupted call "
         "continues\n"
         "when it is repeated; a pair that fails is recorded with its cause, and the exit status is 4.\n"
         "Examples:\n  corral evaluate noise density --data data -o runs/b3r --jobs 2\n"
         "  corral evaluate my-experiment.toml --data my-scans -o runs/mine --cache ~/.cache/corral\n"
         "  corral evaluate time --data data -o runs/time\n"
         "  corral evaluate tables.toml --data data --methods methods.toml -o runs/field\n"
         "  corral evaluate clutter --data data -o runs/big --shard 3/7  # then: corral merge runs/big";
}

}  // namespace

void add_evaluate(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("evaluate", "Experiments on data sets: every pair, grouper and level, into a study folder");
  auto settings = std::make_shared<Settings>();
  add_study_options(*command, settings->options);
  command->add_option("-o,--output", settings->study.run, "Folder of the study")->type_name("FOLDER")->required();
  command->add_option("--jobs", settings->jobs,
                      "Pairs at a time (default: as many as there are processors); results do not depend on it");
  command
      ->add_option("--shard", settings->shard,
                   "Part I of N of the pairs, for 'corral merge' ('corral plan' shows them)")
      ->type_name("I/N");
  command
      ->add_option("--cache", settings->study.cache,
                   "Folder for features and matches, which studies may share (default: in the folder of the study)")
      ->type_name("FOLDER");
  add_size(*command, "--cache-limit", settings->study.cache_limit,
           "Most bytes of that folder, such as 20GB: what was used longest ago is deleted (default: no limit)");
  command->add_flag("--explain", settings->explain,
                    "Also the share of pairs that each grouper registers or loses, by the stage where: keypoints, "
                    "matches, grouping, pose");
  command->add_flag("--json", settings->json, "A short summary as JSON instead of the table");
  command->footer(footer());
  command->callback([settings, &action] { action = [settings] { return evaluate(*settings); }; });
}

}  // namespace corral
