// SPDX-License-Identifier: MIT
// corral group: groupers on a table of matches.
#include "apps/commands/command_files.h"
#include "apps/commands/command_options.h"
#include "apps/commands/pair/pair_run.h"
#include "apps/pair/evaluate_pair.h"
#include "apps/pair/external_method.h"
#include "apps/pair/methods.h"
#include "apps/runtime/output.h"
#include "apps/runtime/progress.h"
#include "apps/runtime/text_table.h"
#include "io/disk/file.h"
#include "io/matches/group_file.h"
#include "io/matches/matches_file.h"
#include "kernel/missing_column.h"

namespace corral {
namespace {

struct Settings {
  std::string matches, method, output;
  ExternalSettings external;
  std::vector<std::string> set;
  int repeat = 1;
  std::uint64_t memory_limit = 0;
  bool json = false;
};

/// What a grouper did with the table, and what it selected if it did anything.
struct Grouped {
  std::string method;
  Json report;
  std::optional<GroupingResult> found;
  MethodState state = MethodState::Unknown;  ///< TooLarge, NotApplicable or Failed if it was not grouped

  void refuse(MethodState why, const std::string& cause) {
    state = why;
    report["status"] = to_text(MethodStatus{why, cause});
  }
};

/// A terminal says what is being done meanwhile.
TimedGrouping time_on_terminal(const std::string& method, const ConfiguredGrouper& grouper,
                               const CorrespondenceSet& matches, int repeat) {
  Progress progress(1);
  progress.begin(call_text(method, matches.size(), repeat));
  return time_grouping(grouper.group, matches, repeat);
}

Grouped group_by(const std::string& method, const ConfiguredGrouper& grouper, const CorrespondenceSet& matches,
                 const Settings& settings) {
  Grouped grouped{method,
                  {{"method", method},
                   {"options", to_json(grouper.options)},
                   {"matches", matches.size()},
                   {"working_memory_bytes", static_cast<std::uint64_t>(grouper.working_memory(matches.size()))},
                   {"selected", nullptr},
                   {"time_ms", nullptr},
                   {"repeat", settings.repeat},
                   {"status", "grouped"}},
                  {}};
  const std::string refusal = too_large(grouper, matches.size(), static_cast<double>(settings.memory_limit));
  if (!refusal.empty()) {
    grouped.refuse(MethodState::TooLarge, refusal);
    say("corral group: " + method + " would use too much memory for " + std::to_string(matches.size()) +
        " matches: " + refusal + " (--memory-limit)");
    return grouped;
  }
  try {
    TimedGrouping timed = time_on_terminal(method, grouper, matches, settings.repeat);
    grouped.report["selected"] = timed.found.selected.size();
    grouped.report["time_ms"] = timed.time_ms;
    grouped.found = std::move(timed.found);
  } catch (const MissingColumn& error) {
    grouped.refuse(MethodState::NotApplicable, error.what());
  }
  return grouped;
}

Grouped group_by(const ExternalMethod& method, const CorrespondenceSet& matches, const Settings& settings) {
  Progress progress(1);
  progress.begin(method.name + " on " + std::to_string(matches.size()) + " matches");
  MethodRecord record = evaluate_external(method, matches, std::nullopt, settings.repeat);
  Grouped grouped{method.name,
                  {{"method", method.name},
                   {"options", to_json(method.options())},
                   {"matches", matches.size()},
                   {"working_memory_bytes", nullptr},
                   {"selected", nullptr},
                   {"time_ms", json_or_null(record.time_ms)},
                   {"start_up_ms", nullptr},
                   {"repeat", settings.repeat},
                   {"status", "grouped"}},
                  {}};
  if (record.failure.empty()) {
    grouped.report["selected"] = record.found.selected.size();
    grouped.report["start_up_ms"] = start_up_ms(method);
    grouped.found = std::move(record.found);
  } else {
    grouped.refuse(MethodState::Failed, record.failure);
    say("corral group: " + record.failure);
  }
  return grouped;
}

std::string text_of(const Grouped& grouped, int matches) {
  return group_text({matches, grouped.found->selected, grouped.found->scores});
}

const std::vector<TableColumn> kColumns = {
    {"grouper", "method"}, {"selected", "selected"}, {"time ms", "time_ms", 2}, {"status", "status"}};

/// One grouper: the selection on standard output or in a file.
int put_one(const Grouped& grouped, int matches, const Settings& settings) {
  if (grouped.state == MethodState::NotApplicable)
    throw IoError(settings.matches, "", grouped.report["status"].get<std::string>());
  if (grouped.found && (!settings.json || !settings.output.empty())) put(settings.output, text_of(grouped, matches));
  if (settings.json) put("", grouped.report);
  return grouped.found ? kOk : kPartial;
}

/// Several: a table of them, and the selections in a folder.
int put_all(const std::vector<Grouped>& all, int matches, const Settings& settings) {
  Json reports = Json::array();
  std::vector<FileContent> files;
  bool is_partial = false;
  for (const Grouped& grouped : all) {
    reports.push_back(grouped.report);
    is_partial = is_partial || grouped.state == MethodState::TooLarge || grouped.state == MethodState::Failed;
    if (grouped.found && !settings.output.empty())
      files.push_back({settings.output + "/group_" + grouped.method + ".csv", text_of(grouped, matches)});
  }
  write_files(files);
  if (settings.json)
    put("", reports);
  else
    put("", table_text(reports, kColumns));
  return is_partial ? kPartial : kOk;
}

int group(const Settings& settings) {
  if (settings.method.empty() && settings.external.empty())
    throw UsageError("expected --method, --external or --plugin");
  load_plugins(settings.external.plugins);
  const std::vector<std::string> methods =
      with_plugins(settings.method.empty() ? std::vector<std::string>() : method_names(settings.method));
  const std::vector<ExternalMethod> externals = external_methods(settings.external);
  const OptionsByName options = parse_set(settings.set);
  require_in_use(options, methods);
  std::vector<ConfiguredGrouper> configured;
  for (const std::string& method : methods) configured.push_back(configure_grouper(method, options));
  if (settings.repeat < 1) throw UsageError("--repeat is " + std::to_string(settings.repeat) + ", expected at least 1");
  const bool is_one = methods.size() + externals.size() == 1;
  keep_inputs({settings.matches}, {settings.output});
  if (is_one && !settings.output.empty()) check_writable(settings.output);
  const CorrespondenceSet matches = read_matches(settings.matches);
  if (!is_one && !settings.output.empty()) make_folder(settings.output);
  std::vector<Grouped> all;
  for (std::size_t i = 0; i < methods.size(); ++i)
    all.push_back(group_by(methods[i], configured[i], matches, settings));
  for (const ExternalMethod& method : externals) all.push_back(group_by(method, matches, settings));
  return is_one ? put_one(all.front(), matches.size(), settings) : put_all(all, matches.size(), settings);
}

}  // namespace

void add_group(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("group", "One grouper, or all, on a table of matches");
  auto settings = std::make_shared<Settings>();
  command->add_option("matches", settings->matches, "Table of matches")->type_name("FILE")->required();
  command->add_option("-m,--method", settings->method,
                      "all, paper (those of 2017), or names between commas: " + names_of(methods(), ","));
  add_external_options(*command, settings->external);
  add_set_option(*command, settings->set);
  command
      ->add_option("-o,--output", settings->output,
                   "Where the selection goes (default: standard output); of several groupers, their folder")
      ->type_name("FILE");
  command->add_option("--repeat", settings->repeat, "Timed calls; the median is reported")->capture_default_str();
  add_memory_limit(*command, settings->memory_limit);
  command->add_flag("--json", settings->json,
                    "Counts and time as JSON on standard output (the selection then needs -o)");
  command->footer(
      "Examples:\n  corral group matches.csv --method gc -o group.csv\n"
      "  corral group matches.csv --method all -o groups\n"
      "  corral group matches.csv --external \"mine=python3 mine.py {matches} {group}\" -o group.csv\n"
      "  corral group matches.csv --method ransac --set ransac.seed=7 --set ransac.iterations=1000 --json --repeat 10");
  command->callback([settings, &action] { action = [settings] { return group(*settings); }; });
}

}  // namespace corral
