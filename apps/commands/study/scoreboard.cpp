// SPDX-License-Identifier: MIT
// corral scoreboard: methods on the same tables, as a site; and the answers of other programs to them.
#include <algorithm>
#include <filesystem>

#include "apps/commands/command_options.h"
#include "apps/commands/study/study_text.h"
#include "apps/pair/conformance.h"
#include "apps/pair/methods.h"
#include "apps/runtime/output.h"
#include "apps/runtime/progress.h"
#include "apps/runtime/text_table.h"
#include "apps/scoreboard/board.h"
#include "apps/scoreboard/site.h"
#include "apps/scoreboard/submission.h"
#include "apps/study/study.h"
#include "kernel/missing_column.h"
#include "kernel/synthetic.h"

namespace corral {
namespace {

struct Settings {
  std::vector<std::string> folders, set;
  std::string data, output, method, url, licence, title;
  ExternalSettings external;
  bool is_deterministic = false, no_checks = false;
};

/// The columns that a grouper refuses to work without, in words.
std::string needs_of(const GroupFunction& group) {
  const SyntheticProblem problem = make_synthetic_problem({});
  std::string needs;
  const auto ask = [&](const char* what, CorrespondenceSet table) {
    try {
      group(table);
    } catch (const MissingColumn&) {
      needs += std::string(needs.empty() ? "" : ", ") + what;
    }
  };
  CorrespondenceSet table = problem.matches;
  table.source_frames.clear(), table.target_frames.clear();
  ask("local frames", table);
  table = problem.matches;
  table.feature_distance.resize(0), table.second_feature_distance.resize(0);
  ask("feature distances", table);
  return needs;
}

MethodFacts facts_of(const Grouper& method, bool with_checks) {
  const ConfiguredGrouper configured = method.configure({});
  MethodFacts facts{method.title, method.principle, "", "MIT", needs_of(configured.group), "", {}, {}, {}, false};
  facts.determinism = "the same rows for the same table; draws, if any, are seeded";
  if (configured.working_memory)
    facts.memory_1k_mb = configured.working_memory(1000) / 1e6,
    facts.memory_10k_mb = configured.working_memory(10000) / 1e6;
  if (!with_checks) return facts;
  facts.is_checked = true;
  for (const ConformanceCheck& check : check_conformance(configured.group))
    if (check.holds == false) facts.broken.push_back(check.name);
  return facts;
}

/// What submissions say of themselves, where their studies are among these.
void add_submitted(const std::vector<std::string>& studies, FactsByMethod& facts) {
  for (const std::string& study : studies) {
    std::error_code ignored;
    if (!std::filesystem::exists(study + "/method.toml", ignored)) continue;
    const Submission submission = read_submission(study);
    facts[submission.name] = {submission.title,
                              "",
                              submission.url,
                              submission.licence,
                              submission.needs,
                              submission.is_deterministic ? "deterministic, as its authors say" : "",
                              {},
                              {},
                              {},
                              false};
  }
}

int write_site(const Settings& settings) {
  const std::vector<StudyFolder> runs = read_runs(settings.folders);
  const std::vector<Board> boards = make_boards(tables_of(runs));
  FactsByMethod facts;
  {
    Progress progress(static_cast<double>(methods().size()));
    for (const Grouper& method : methods()) {
      progress.begin("contract of " + method.name);
      const auto has_it = [&](const Board& board) { return board.row_of(method.name) != nullptr; };
      if (std::any_of(boards.begin(), boards.end(), has_it)) facts[method.name] = facts_of(method, !settings.no_checks);
    }
  }
  add_submitted(settings.folders, facts);
  make_folder(settings.output);
  write_files(scoreboard_site(boards, facts, settings.output));
  say("the scoreboard is " + settings.output + "/index.html");
  return kOk;
}

/// The one method of --method, --external or --plugin.
SubmittedMethod method_of(const Settings& settings) {
  load_plugins(settings.external.plugins);
  const std::vector<ExternalMethod> externals = external_methods(settings.external);
  std::vector<std::string> names = with_plugins({});
  if (!settings.method.empty()) names = {settings.method};
  if (names.size() + externals.size() != 1) throw UsageError("expected one method: --method, --external or --plugin");
  SubmittedMethod method;
  if (externals.empty()) {
    const OptionsByName options = parse_set(settings.set);
    require_in_use(options, names);
    method.facts.name = names.front();
    method.group = configure_grouper(names.front(), options).group;
    if (plugin_file(method.facts.name).empty()) method.facts.name += "-packed";  // a name of Corral's own is taken
  } else {
    method.facts.name = externals.front().name;
    method.group = [external = externals.front()](const CorrespondenceSet& matches) {
      return call_external(external, matches).found;
    };
  }
  method.facts.title = settings.title.empty() ? method.facts.name : settings.title;
  method.facts.url = settings.url, method.facts.licence = settings.licence;
  method.facts.is_deterministic = settings.is_deterministic;
  return method;
}

int pack(const Settings& settings) {
  const Dataset dataset = read_dataset(settings.data);
  const SubmittedMethod method = method_of(settings);
  std::vector<FileContent> files;
  {
    Progress progress(static_cast<double>(dataset.pairs.size()));
    files = pack_submission(method, dataset, settings.output, [&](const std::string& pair) { progress.begin(pair); });
  }
  for (const char* part : {"/labels", "/poses"}) make_folder(settings.output + part);
  write_files(files);
  say(method.facts.name + ": " + std::to_string(dataset.pairs.size()) + " tables; the submission is in " +
      settings.output);
  return kOk;
}

/// Says what is wrong; true if nothing is.
bool is_right(const Submission& submission, const Dataset& dataset) {
  const std::vector<std::string> problems = check_submission(submission, dataset);
  for (const std::string& problem : problems) say(submission.folder + ": " + problem);
  return problems.empty();
}

int check(const Settings& settings) {
  const Submission submission = read_submission(settings.folders.front());
  if (!is_right(submission, read_dataset(settings.data))) return kBadInput;
  put("", submission.name + ": complete, and on the tables of " + submission.dataset + "\n");
  return kOk;
}

int add(const Settings& settings) {
  const Submission submission = read_submission(settings.folders.front());
  if (!is_right(submission, read_dataset(settings.data))) return kBadInput;
  StudyCall call = study_call({"scoreboard"}, settings.data);
  std::string& text = call.experiments.front().text;
  const std::size_t at = text.find("groupers = ");
  text = text.substr(0, at) + "groupers = []\n";
  call.methods = {submission.folder + "/methods.toml", submission.methods_text()};
  StudySettings study;
  study.run = settings.output;
  study.command_line = "corral scoreboard add " + submission.folder;
  const auto ignore = [](const StudyProgress&) {};
  const StudyOutcome outcome = run_study(work_list_of(call), call, study, {ignore, ignore});
  write_file(settings.output + "/method.toml", read_file(submission.folder + "/method.toml"));
  put("", overview_text(outcome.summary));
  say("its study is in " + settings.output + "; corral scoreboard write " + settings.output + " OTHER-STUDIES -o SITE");
  return kOk;
}

void add_data(CLI::App& command, Settings& settings) {
  command.add_option("--data", settings.data, "The data set of the tables")->type_name("FOLDER")->required();
}

void add_output(CLI::App& command, Settings& settings, const char* what) {
  command.add_option("-o,--output", settings.output, what)->type_name("FOLDER")->required();
}

}  // namespace

void add_scoreboard(CLI::App& app, Action& action) {
  auto* scoreboard = app.add_subcommand(
      "scoreboard", "Methods on the same tables, as a site; and the answers of other programs to them");
  scoreboard->require_subcommand(1);
  auto settings = std::make_shared<Settings>();
  const auto does = [&](CLI::App* command, int (*act)(const Settings&)) {
    command->callback([settings, act, &action] { action = [settings, act] { return act(*settings); }; });
  };
  auto* write = scoreboard->add_subcommand("write", "A static site from studies");
  write->add_option("studies", settings->folders, "Studies made by 'corral evaluate' or 'corral scoreboard add'")
      ->type_name("FOLDER")
      ->required();
  add_output(*write, *settings, "Folder of the site: open its index.html, or serve it");
  write->add_flag("--no-checks", settings->no_checks,
                  "Skip the conformance checks of the built-in groupers, which take a minute");
  write->footer(
      "Example:\n  corral evaluate scoreboard --data data/challenge -o runs/board\n  corral scoreboard write "
      "runs/board runs/theirs -o site");
  does(write, write_site);
  auto* packing = scoreboard->add_subcommand("pack", "A method's answers to the tables of a data set, to be sent in");
  add_data(*packing, *settings);
  add_output(*packing, *settings, "Folder of the submission");
  packing->add_option("-m,--method", settings->method, "One of ours, which is then named NAME-packed");
  add_external_options(*packing, settings->external);
  add_set_option(*packing, settings->set);
  packing->add_option("--title", settings->title, "Its name for people");
  packing->add_option("--url", settings->url, "Where it is described");
  packing->add_option("--licence", settings->licence, "Its licence");
  packing->add_flag("--deterministic", settings->is_deterministic, "It gives the same answer every time");
  packing->footer(
      "The truths of the data set are not read.\nExample:\n  corral scoreboard pack --data data/challenge --external "
      "\"mine=python3 mine.py {matches} {group}\" -o mine");
  does(packing, pack);
  auto* checking =
      scoreboard->add_subcommand("check", "Whether a submission is complete and of the tables of the data set");
  checking->add_option("submission", settings->folders, "Its folder")->type_name("FOLDER")->required()->expected(1);
  add_data(*checking, *settings);
  checking->footer("Example:\n  corral scoreboard check mine --data data/challenge");
  does(checking, check);
  auto* adding = scoreboard->add_subcommand("add", "Scores a submission, into a study for corral scoreboard write");
  adding->add_option("submission", settings->folders, "Its folder")->type_name("FOLDER")->required()->expected(1);
  add_data(*adding, *settings);
  add_output(*adding, *settings, "Folder of the study");
  adding->footer("Example:\n  corral scoreboard add mine --data data/challenge -o runs/mine");
  does(adding, add);
}

}  // namespace corral
