// SPDX-License-Identifier: MIT
// corral merge: the tables of a study from its shards.
#include "apps/commands/command_options.h"
#include "apps/commands/study/study_text.h"
#include "apps/runtime/output.h"

namespace corral {
namespace {

struct Settings {
  std::string study, data;
  std::vector<std::string> parts, plugins;
  bool explain = false, json = false;
};

int merge(const Settings& settings) {
  load_plugins(settings.plugins);
  const auto [outcome, notes] = merge_study(settings.study, settings.parts, settings.data);
  for (const std::string& note : notes) say("note: " + note);
  say_study(outcome);
  if (settings.json) {
    Json json = study_json(settings.study, outcome);
    json["notes"] = notes;
    if (settings.explain) json["explanation"] = explanation_json(outcome.losses);
    put("", json);
  } else {
    put("", overview_text(outcome.summary));
    if (settings.explain) put("", "\n" + explanation_text(outcome.losses));
  }
  say(counts_text(outcome) + "; the study is in " + settings.study);
  return outcome.failed > 0 ? kPartial : kOk;
}

}  // namespace

void add_merge(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("merge", "The tables of a study that was evaluated in shards");
  auto settings = std::make_shared<Settings>();
  command->add_option("study", settings->study, "Folder of the study, with the journals of its shards in units/")
      ->type_name("STUDY")
      ->required();
  command->add_option("parts", settings->parts, "Folders of shards that are elsewhere: their files are copied first")
      ->type_name("PART");
  command->add_option("--data", settings->data, "Where the data sets are now (default: where the shards found them)")
      ->type_name("FOLDER");
  add_plugin_option(*command, settings->plugins);
  command->add_flag("--explain", settings->explain, "Also where pairs were lost, as of 'corral evaluate'");
  command->add_flag("--json", settings->json, "A short summary as JSON instead of the table");
  command->footer(
      "The tables are those of one call of 'corral evaluate' without --shard, byte for byte but for the times.\n"
      "A merge may be repeated. Shards that are missing, unfinished, damaged, of another study or of another\n"
      "version of the program are named, and the exit status is 3.\n"
      "Examples:\n  corral merge runs/big\n"
      "  corral merge runs/big from-node1/big from-node2/big --data data");
  command->callback([settings, &action] { action = [settings] { return merge(*settings); }; });
}

}  // namespace corral
