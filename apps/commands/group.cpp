// SPDX-License-Identifier: MIT
// corral group: one grouper on a table of matches.
#include "apps/commands/commands.h"
#include "apps/pair/evaluate_pair.h"
#include "apps/runtime/memory.h"
#include "apps/runtime/report.h"
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

int group(const Settings& settings) {
  const ConfiguredGrouper grouper = configure_grouper(settings.method, settings.set);
  if (settings.repeat < 1) throw UsageError("--repeat is " + std::to_string(settings.repeat) + ", expected at least 1");
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
    const TimedGrouping timed = time_grouping(grouper.group, matches, settings.repeat);
    report["selected"] = timed.found.selected.size();
    report["time_ms"] = timed.time_ms;
    if (!settings.json || !settings.output.empty())
      put(settings.output, group_text({matches.size(), timed.found.selected, timed.found.scores}));
  } else {
    say("corral group: " + settings.method + " is too large for " + std::to_string(matches.size()) +
        " matches: " + refusal + " (--memory-limit)");
  }
  if (settings.json) put("", report);
  return refusal.empty() ? kOk : kPartial;
}

}  // namespace

std::string method_list(const std::string& separator) {
  std::string names;
  for (const Grouper& grouper : groupers()) names += (names.empty() ? "" : separator) + grouper.name;
  return names;
}

ConfiguredGrouper configure_grouper(const std::string& method, const std::vector<std::string>& settings) {
  OptionOverrides overrides;
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos || equals == 0) throw UsageError("--set " + setting + ": expected key=value");
    if (!overrides.emplace(setting.substr(0, equals), setting.substr(equals + 1)).second)
      throw UsageError("--set " + setting + ": this key is set twice");
  }
  try {
    return find_grouper(method).configure(overrides);
  } catch (const InvalidInput& error) {
    throw UsageError(error.what());
  }
}

void add_memory_limit(CLI::App& command, std::uint64_t& bytes) {
  bytes = static_cast<std::uint64_t>(half_of_memory());
  command
      .add_option("--memory-limit", bytes,
                  "Most memory that a method may hold, such as 500MB or 2GB; one that would need more is not asked "
                  "(default: half of the machine)")
      ->transform(CLI::AsSizeValue(true));
}

void add_group(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("group", "One grouper on a table of matches");
  auto settings = std::make_shared<Settings>();
  command->add_option("matches", settings->matches, "Table of matches")->type_name("FILE")->required();
  command->add_option("-m,--method", settings->method, method_list("|"))->required();
  command->add_option("--set", settings->set, "An option of the method as key=value; 'corral groupers' lists them")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all();
  command->add_option("-o,--output", settings->output, "Where the selection goes (default: standard output)")
      ->type_name("FILE");
  command->add_option("--repeat", settings->repeat, "Timed calls; the median is reported")->capture_default_str();
  add_memory_limit(*command, settings->memory_limit);
  command->add_flag("--json", settings->json,
                    "Counts and time as JSON on standard output (the selection then needs -o)");
  command->footer(
      "Examples:\n  corral group matches.csv --method gc -o group.csv\n"
      "  corral group matches.csv --method ransac --set seed=7 --set iterations=1000 --json --repeat 10");
  command->callback([settings, &action] { action = [settings] { return group(*settings); }; });
}

}  // namespace corral
