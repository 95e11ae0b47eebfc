// SPDX-License-Identifier: MIT
// corral reproduce: what the paper's findings depend on, among all readings of what it leaves open.
#include <filesystem>
#include <optional>

#include "apps/commands/command_options.h"
#include "apps/commands/study/study_text.h"
#include "apps/reproduce/reproduction_files.h"
#include "apps/reproduce/reproduction_page.h"
#include "apps/runtime/child_program.h"
#include "apps/runtime/output.h"
#include "apps/runtime/progress.h"
#include "apps/runtime/workers.h"
#include "apps/study/find_dataset.h"
#include "apps/study/specification.h"
#include "io/disk/file.h"

namespace corral {
namespace {

const std::vector<std::string> kExperiments = {"noise",   "density",   "clutter", "occlusion",
                                               "overlap", "threshold", "matches"};

struct Settings {
  ReproduceSettings reproduce;
  std::string readings, claims;
  std::optional<int> jobs;
  bool json = false;
};

std::string command_line(const Settings& settings) {
  std::string line = "corral reproduce";
  for (const std::string& name : settings.reproduce.experiments) line += " " + name;
  line += " --data " + shell_word(settings.reproduce.data) + " -o " + shell_word(settings.reproduce.folder);
  if (!settings.reproduce.cache.empty()) line += " --cache " + shell_word(settings.reproduce.cache);
  if (!settings.readings.empty()) line += " --readings " + shell_word(settings.readings);
  return line + (settings.claims.empty() ? "" : " --claims " + shell_word(settings.claims));
}

void check_experiments(std::vector<std::string>& names) {
  if (names.empty()) names = kExperiments;
  for (const std::string& name : names) {
    if (std::find(kExperiments.begin(), kExperiments.end(), name) == kExperiments.end())
      throw UsageError(name + ": expected some of noise, density, clutter, occlusion, overlap, threshold, matches");
    if (std::count(names.begin(), names.end(), name) > 1) throw UsageError(name + ": expected each experiment once");
  }
}

/// Throws IoError before the first study runs.
void check_datasets(const ReproduceSettings& settings) {
  for (const std::string& name : settings.experiments)
    find_dataset(settings.data, read_experiment(name).info.dataset, name);
}

int run(Settings settings) {
  if (settings.jobs && (*settings.jobs < 1 || *settings.jobs > 256)) throw UsageError("--jobs: expected 1 .. 256");
  settings.reproduce.jobs = settings.jobs.value_or(0);
  check_experiments(settings.reproduce.experiments);
  check_datasets(settings.reproduce);
  settings.reproduce.command_line = command_line(settings);
  const ClaimBook book = settings.claims.empty() ? built_in_claims() : read_claims(settings.claims);
  const std::vector<OpenPoint> points =
      settings.readings.empty() ? built_in_readings() : parse_readings(settings.readings, read_file(settings.readings));
  std::string current;
  const auto progress = [&](const std::string& study, const StudyProgress& now) {
    if (study != current && now.done < now.total) say(study + ": " + std::to_string(now.total - now.done) + " pairs");
    current = study;
  };
  ReadingTables tables(points, book, settings.reproduce, progress);
  const Reproduction made = reproduce(
      points, book, [&](const Combination& combination, Half half) { return tables.of(combination, half); },
      workers(settings.reproduce.jobs));
  const std::filesystem::path folder = settings.reproduce.folder;
  const Json json = reproduction_json(made);
  write_files({{(folder / "matrix.csv").string(), matrix_csv(made)},
               {(folder / "reproduction.json").string(), json.dump(2) + "\n"},
               {(folder / "reproduction.txt").string(), reproduction_text(made)},
               {(folder / "index.html").string(), reproduction_html(made)},
               {(folder / "as-run.toml").string(), preset_toml(made)}});
  if (settings.json)
    put("", json);
  else
    put("", reproduction_text(made));
  say("the matrix is in " + (folder / "index.html").string() + " and matrix.csv");
  return kOk;
}

}  // namespace

void add_reproduce(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "reproduce", "Which findings of the paper depend on its open points, and which point decides most");
  auto settings = std::make_shared<Settings>();
  command
      ->add_option("experiments", settings->reproduce.experiments,
                   "Built-in experiments (default: the seven of the paper that are not about time)")
      ->type_name("EXPERIMENT");
  command->add_option("--data", settings->reproduce.data, "A data set, or a folder of data sets")
      ->type_name("FOLDER")
      ->required();
  command->add_option("-o,--output", settings->reproduce.folder, "Folder of the studies and of the answer")
      ->type_name("FOLDER")
      ->required();
  command->add_option("--readings", settings->readings, "Open points of your own, as paper/readings.toml")
      ->type_name("FILE");
  command->add_option("--claims", settings->claims, "Claims of your own, as paper/claims.toml")->type_name("FILE");
  command->add_option("--jobs", settings->jobs,
                      "Pairs at a time (default: as many as there are processors); results do not depend on it");
  command
      ->add_option("--cache", settings->reproduce.cache,
                   "Folder for features and matches (default: in the folder of the studies)")
      ->type_name("FOLDER");
  add_size(*command, "--cache-limit", settings->reproduce.cache_limit,
           "Most bytes of that folder, such as 20GB: what was used longest ago is deleted (default: no limit)");
  command->add_flag("--json", settings->json, "The whole answer as JSON instead of the tables");
  command->footer(
      "Every reading is tried alone, then combinations: chosen on one half of the pairs by the number of statements "
      "that\n"
      "hold, reported on the other (paper/README.md). An interrupted call continues when it is repeated.\n"
      "Examples:\n  corral reproduce --data build/data/default -o runs/readings\n"
      "  corral reproduce noise density --data data -o runs/retrieval --jobs 2 --json");
  command->callback([settings, &action] { action = [settings] { return run(*settings); }; });
}

}  // namespace corral
