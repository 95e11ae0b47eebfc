// SPDX-License-Identifier: MIT
// corral verify: whether the inputs of a study still give its records.
#include "apps/study/verify.h"
#include "apps/commands/command_options.h"
#include "apps/commands/study/study_text.h"
#include "apps/runtime/output.h"
#include "apps/runtime/progress.h"

namespace corral {
namespace {

struct Settings {
  VerifySettings verify;
  std::vector<std::string> plugins;
  bool all = false, json = false;
};

int verify(Settings settings) {
  if (settings.all) settings.verify.sample.reset();
  load_plugins(settings.plugins);
  std::optional<Progress> progress;
  const VerifyOutcome outcome = verify_study(settings.verify, [&](const StudyProgress& now) {
    const bool is_first = !progress;
    if (is_first) progress.emplace(static_cast<double>(now.total));
    progress->begin(progress_text(now, is_first));
  });
  progress.reset();
  if (settings.json)
    put("", Json{{"study", settings.verify.folder},
                 {"pairs", outcome.of},
                 {"computed_again", outcome.pairs},
                 {"records", outcome.records},
                 {"files", outcome.files},
                 {"differences", outcome.differences}});
  else
    for (const std::string& difference : outcome.differences) put("", difference + "\n");
  say(std::to_string(outcome.pairs) + " of " + std::to_string(outcome.of) + " pairs computed again, " +
      std::to_string(outcome.records) + " records and " + std::to_string(outcome.files) +
      " files of selections and poses compared; differences: " + std::to_string(outcome.differences.size()));
  return outcome.differences.empty() ? kOk : kPartial;
}

}  // namespace

void add_verify(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("verify", "Whether the inputs of a study still give its records");
  auto settings = std::make_shared<Settings>();
  command->add_option("study", settings->verify.folder, "Folder that 'corral evaluate' made")
      ->type_name("STUDY")
      ->required();
  command->add_option("--data", settings->verify.data, "Where the data sets are now (default: where they were)")
      ->type_name("FOLDER");
  auto* sample =
      command->add_option("--sample", settings->verify.sample, "Pairs to compute again, drawn at random (default: 10)")
          ->check(CLI::Range(1, 1'000'000'000))
          ->type_name("N");
  command->add_option("--seed", settings->verify.seed, "Of the draw (default: 1)");
  command->add_flag("--all", settings->all, "All pairs")->excludes(sample);
  command->add_option("--jobs", settings->verify.jobs, "Pairs at a time (default: as many as there are processors)")
      ->check(CLI::Range(1, 256))
      ->type_name("N");
  command->add_flag("--programs", settings->verify.programs,
                    "Call the programs that the study was made with (--external of 'corral evaluate')");
  add_plugin_option(*command, settings->plugins);
  command->add_flag("--json", settings->json, "As JSON");
  command->footer(
      "Pairs are read, matched, grouped and scored again, with nothing from the cache of the study. Every cell of "
      "their\n"
      "records but the times, and every byte of their selections and poses, must be as it was; so must the hashes of "
      "their\n"
      "files. The other lines of records.csv are compared with the journals in units/. Each difference is a line, and "
      "the\n"
      "exit status is then 4. It needs the program that made the study: another version is named, with status 3.\n"
      "Examples:\n  corral verify runs/b3r --sample 50\n  corral verify runs/b3r --all --data data --json");
  command->callback([settings, &action] { action = [settings] { return verify(*settings); }; });
}

}  // namespace corral
