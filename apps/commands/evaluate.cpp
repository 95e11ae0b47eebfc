// SPDX-License-Identifier: MIT
// corral evaluate: experiments on data sets, into the folder of a study.
#include <algorithm>
#include <map>

#include "apps/commands/command_options.h"
#include "apps/runtime/output.h"
#include "apps/runtime/progress.h"
#include "apps/runtime/text_table.h"
#include "apps/study/experiment_options.h"
#include "apps/study/study.h"
#include "apps/study/time_study.h"
#include "kernel/error.h"

namespace corral {
namespace {

struct Settings {
  std::vector<std::string> experiments;
  std::string data;
  std::vector<std::string> set;
  StudySettings study;
  std::optional<int> jobs;
  bool dense = false, json = false;
};

constexpr std::size_t kMostWarnings = 5;

/// As warnings; the study has them all.
void say_some(const std::string& kind, const std::vector<std::string>& lines) {
  for (std::size_t i = 0; i < std::min(lines.size(), kMostWarnings); ++i) say("warning: " + kind + lines[i]);
  if (lines.size() > kMostWarnings)
    say("warning: " + std::to_string(lines.size() - kMostWarnings) + " more of this kind; --json lists all");
}

/// What is shown of a grouper in an experiment: the mean of its levels.
struct Overview {
  int levels = 0, pairs = 0, excluded = 0, misfit = 0, empty = 0, failed = 0;
  std::vector<double> sums;  ///< of the headline measures
};

std::string overview_text(const std::vector<SummaryRow>& rows) {
  const std::vector<const Measure*> headline = measures_with(kHeadline);
  std::vector<std::pair<std::string, std::string>> order;
  std::map<std::pair<std::string, std::string>, Overview> cells;
  for (const SummaryRow& row : rows) {
    const auto key = std::make_pair(row.experiment, row.method);
    if (!cells.count(key)) order.push_back(key);
    Overview& cell = cells[key];
    cell.pairs += row.pairs, cell.excluded += row.excluded, cell.misfit += row.misfit;
    cell.empty += row.empty, cell.failed += row.failed;
    cell.sums.resize(headline.size());
    if (row.pairs == 0) continue;
    ++cell.levels;
    for (std::size_t i = 0; i < headline.size(); ++i) cell.sums[i] += *row.of(headline[i]->name).value;
  }
  std::vector<std::string> header = {"experiment", "method", "pairs", "excluded", "misfit", "empty", "failed"};
  for (const Measure* measure : headline) header.push_back(measure->title);
  TextTable table(header);
  for (const auto& key : order) {
    const Overview& cell = cells.at(key);
    std::vector<std::string> line = {key.first,
                                     key.second,
                                     std::to_string(cell.pairs),
                                     std::to_string(cell.excluded),
                                     std::to_string(cell.misfit),
                                     std::to_string(cell.empty),
                                     std::to_string(cell.failed)};
    for (std::size_t i = 0; i < headline.size(); ++i)
      line.push_back(cell.levels > 0 ? fixed(cell.sums[i] / cell.levels, headline[i]->decimals) : "");
    table.add(line);
  }
  return table.str() +
         "Means over the levels of an experiment, at each level over its pairs; an empty selection has precision and\n"
         "recall 0, pairs without correct matches are excluded, and so are those whose truth\n"
         "does not fit the surfaces (misfit). success: share of pairs whose refined mean error is at\n"
         "most 5 pr. summary.csv has every level.\n";
}

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

int evaluate_pairs(const Settings& settings, const WorkList& list) {
  std::optional<Progress> progress;
  const StudyOutcome outcome = run_study(list, settings.study, [&](const StudyProgress& now) {
    if (!progress) progress.emplace(static_cast<double>(now.total - now.done));
    progress->begin(std::to_string(now.done) + " of " + std::to_string(now.total) + " pairs done, " +
                    std::to_string(now.failed) + " failed");
  });
  progress.reset();
  say_some("truth does not fit: ", outcome.misfits);
  say_some("", outcome.warnings);
  if (settings.json) {
    put("", Json{{"run", settings.study.run},
                 {"pairs", outcome.units},
                 {"failed", outcome.failed},
                 {"misfits", outcome.misfits},
                 {"warnings", outcome.warnings}});
  } else {
    put("", overview_text(outcome.summary));
    const std::string causes = outcome.failed > 0 ? " (records.csv says why)" : "";
    say(std::to_string(outcome.units) + " pairs, " + std::to_string(outcome.failed) + " failed" + causes +
        "; the study is in " + settings.study.run);
  }
  return outcome.failed > 0 ? kPartial : kOk;
}

/// The call as it would be typed again.
std::string command_line(const Settings& settings) {
  std::string line = "corral evaluate";
  for (const std::string& experiment : settings.experiments) line += " " + experiment;
  line += " --data " + settings.data + " -o " + settings.study.run;
  if (settings.jobs) line += " --jobs " + std::to_string(*settings.jobs);
  if (!settings.study.cache.empty()) line += " --cache " + settings.study.cache;
  for (const std::string& option : settings.set) line += " --set " + option;
  return line + (settings.dense ? " --dense" : "") + (settings.json ? " --json" : "");
}

int evaluate(Settings settings) {
  if (settings.jobs && (*settings.jobs < 1 || *settings.jobs > 256)) throw UsageError("--jobs: expected 1 .. 256");
  std::vector<Experiment> experiments;
  const OptionsByName options = parse_set(settings.set);
  bool has_times = false;
  for (const std::string& name : settings.experiments) {
    experiments.push_back(read_experiment(name));
    experiments.back().dense = experiments.back().dense || settings.dense;
    try {
      override_options(experiments.back(), options);
    } catch (const InvalidInput& error) {
      throw UsageError(error.what());
    }
    has_times = has_times || experiments.back().sweep == Sweep::TableSize;
  }
  if (has_times && experiments.size() > 1)
    throw UsageError("times are taken alone: evaluate the other experiments in another study");
  settings.study.jobs = settings.jobs.value_or(0);
  settings.study.command_line = command_line(settings);
  const WorkList list = make_work_list(std::move(experiments), settings.data);
  return has_times ? evaluate_time(settings, list) : evaluate_pairs(settings, list);
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
         "  corral evaluate time --data data -o runs/time";
}

}  // namespace

void add_evaluate(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("evaluate", "Experiments on data sets: every pair, grouper and level, into a study folder");
  auto settings = std::make_shared<Settings>();
  command->add_option("experiments", settings->experiments, "Names (below) or TOML files")
      ->type_name("EXPERIMENT")
      ->required();
  command->add_option("--data", settings->data, "A data set (a folder with dataset.toml), or a folder of data sets")
      ->type_name("FOLDER")
      ->required();
  command->add_option("-o,--output", settings->study.run, "Folder of the study")->type_name("FOLDER")->required();
  command->add_option("--jobs", settings->jobs,
                      "Pairs at a time (default: as many as there are processors); results do not depend on it");
  command
      ->add_option("--cache", settings->study.cache,
                   "Folder for features and matches, which studies may share (default: in the folder of the study)")
      ->type_name("FOLDER");
  add_set_option(*command, settings->set);
  command->add_flag("--dense", settings->dense, "Also refine on the whole surfaces, in columns of their own");
  command->add_flag("--json", settings->json, "A short summary as JSON instead of the table");
  command->footer(footer());
  command->callback([settings, &action] { action = [settings] { return evaluate(*settings); }; });
}

}  // namespace corral
