// SPDX-License-Identifier: MIT
// corral match: from two meshes to a table of matches.
#include "apps/commands/command_files.h"
#include "apps/commands/command_options.h"
#include "apps/pair/match_report.h"
#include "apps/runtime/output.h"
#include "apps/runtime/progress.h"
#include "io/file.h"
#include "io/matches_file.h"
#include "kernel/error.h"

namespace corral {
namespace {

struct Settings {
  std::string source, target, output;
  MatchSettings match;
  std::vector<std::string> set;
  bool drop_stray = false, json = false, verbose = false;
};

int match(Settings settings) {
  const OptionsByName options = parse_set(settings.set);
  require_in_use(options, settings.match.in_use());
  settings.match.options = options;
  check_usage(settings.match);
  settings.match.inspect = settings.verbose || settings.json;
  keep_inputs({settings.source, settings.target}, {settings.output});
  if (!settings.output.empty()) check_writable(settings.output);
  const Mesh source = read_input(settings.source, settings.drop_stray);
  const Mesh target = read_input(settings.target, settings.drop_stray);
  MatchedPair pair;
  {
    Progress progress(match_stages(settings.match));
    pair = match_pair(source, target, settings.match, {[&](const std::string& stage) { progress.begin(stage); }});
  }
  if (settings.verbose)
    say(stage_report(pair.report));
  else
    for (const std::string& line : advice(pair.report)) say(line);
  if (!settings.json || !settings.output.empty()) put(settings.output, matches_text(pair.matches));
  if (settings.json) put("", to_json(pair.report));
  return kOk;
}

}  // namespace

void add_match(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("match", "Keypoints, descriptors and their matches: two meshes in, one table out");
  auto settings = std::make_shared<Settings>();
  command->add_option("source", settings->source, "Source mesh (a model)")->type_name("FILE")->required();
  command->add_option("target", settings->target, "Target mesh (a scene)")->type_name("FILE")->required();
  command->add_option("-o,--output", settings->output, "Where the table goes (default: standard output)")
      ->type_name("FILE");
  command->add_flag("--json", settings->json, "The stage report as JSON on standard output (the table then needs -o)");
  command->add_flag("-v,--verbose", settings->verbose, "The stage report in words on standard error");
  add_match_options(*command, settings->match);
  add_drop_stray(*command, settings->drop_stray);
  add_set_option(*command, settings->set);
  command->footer(
      "Examples:\n  corral match model.ply scene.ply -o matches.csv\n"
      "  corral match model.ply scene.ply -v --json -o matches.csv\n"
      "  corral match model.ply scene.ply --detector harris-mesh --set harris-mesh.neighborhood=rings --mutual -o "
      "matches.csv");
  command->callback([settings, &action] { action = [settings] { return match(*settings); }; });
}

}  // namespace corral
