// SPDX-License-Identifier: MIT
// corral group: one grouper on a table of matches.
#include "apps/commands/command_files.h"
#include "apps/commands/command_options.h"
#include "apps/pair/evaluate_pair.h"
#include "apps/runtime/output.h"
#include "apps/runtime/progress.h"
#include "io/file.h"
#include "io/group_file.h"
#include "io/matches_file.h"
#include "kernel/error.h"

namespace corral {
namespace {

struct Settings {
  std::string matches, method, output;
  std::vector<std::string> set;
  int repeat = 1;
  std::uint64_t memory_limit = 0;
  bool json = false;
};

/// A terminal says what is being done meanwhile.
TimedGrouping time_on_terminal(const ConfiguredGrouper& grouper, const CorrespondenceSet& matches,
                               const Settings& settings) {
  Progress progress(1);
  progress.begin(settings.method + " on " + std::to_string(matches.size()) + " matches");
  return time_grouping(grouper.group, matches, settings.repeat);
}

int group(const Settings& settings) {
  const OptionsByName options = parse_set(settings.set);
  require_in_use(options, {settings.method});
  const ConfiguredGrouper grouper = configure_grouper(settings.method, options);
  if (settings.repeat < 1) throw UsageError("--repeat is " + std::to_string(settings.repeat) + ", expected at least 1");
  keep_inputs({settings.matches}, {settings.output});
  if (!settings.output.empty()) check_writable(settings.output);
  const CorrespondenceSet matches = read_matches(settings.matches);
  const std::string refusal = too_large(grouper, matches.size(), static_cast<double>(settings.memory_limit));
  Json report = {{"method", settings.method},
                 {"options", to_json(grouper.options)},
                 {"matches", matches.size()},
                 {"working_memory_bytes", static_cast<std::uint64_t>(grouper.working_memory(matches.size()))},
                 {"selected", nullptr},
                 {"time_ms", nullptr},
                 {"repeat", settings.repeat},
                 {"status", refusal.empty() ? "grouped" : to_text(MethodStatus{MethodState::TooLarge, refusal})}};
  if (refusal.empty()) {
    const TimedGrouping timed = time_on_terminal(grouper, matches, settings);
    report["selected"] = timed.found.selected.size();
    report["time_ms"] = timed.time_ms;
    if (!settings.json || !settings.output.empty())
      put(settings.output, group_text({matches.size(), timed.found.selected, timed.found.scores}));
  } else {
    say("corral group: " + settings.method + " would use too much memory for " + std::to_string(matches.size()) +
        " matches: " + refusal + " (--memory-limit)");
  }
  if (settings.json) put("", report);
  return refusal.empty() ? kOk : kPartial;
}

}  // namespace

void add_group(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("group", "One grouper on a table of matches");
  auto settings = std::make_shared<Settings>();
  command->add_option("matches", settings->matches, "Table of matches")->type_name("FILE")->required();
  command->add_option("-m,--method", settings->method, names_of(groupers()))->required();
  add_set_option(*command, settings->set);
  command->add_option("-o,--output", settings->output, "Where the selection goes (default: standard output)")
      ->type_name("FILE");
  command->add_option("--repeat", settings->repeat, "Timed calls; the median is reported")->capture_default_str();
  add_memory_limit(*command, settings->memory_limit);
  command->add_flag("--json", settings->json,
                    "Counts and time as JSON on standard output (the selection then needs -o)");
  command->footer(
      "Examples:\n  corral group matches.csv --method gc -o group.csv\n"
      "  corral group matches.csv --method ransac --set ransac.seed=7 --set ransac.iterations=1000 --json --repeat 10");
  command->callback([settings, &action] { action = [settings] { return group(*settings); }; });
}

}  // namespace corral
