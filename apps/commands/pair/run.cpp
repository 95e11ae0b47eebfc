// SPDX-License-Identifier: MIT
// corral run: two meshes in, every grouper scored by its alignment.
#include <algorithm>

#include "apps/commands/pair/run_report.h"
#include "apps/pair/match_report.h"
#include "apps/pair/methods.h"
#include "apps/runtime/output.h"

namespace corral {
namespace {

/// Two meshes, a table of matches, or both.
void check_inputs(const RunSettings& settings) {
  if (settings.source.empty() != settings.target.empty()) throw UsageError("target: expected two meshes");
  if (settings.source.empty() && settings.matches.empty())
    throw UsageError("expected two meshes, or --matches with a table of matches");
  if (settings.source.empty() && settings.dense) throw UsageError("--dense: needs two meshes beside --matches");
  if (settings.source.empty() && settings.select == kSelect[1])
    throw UsageError("--select surface: needs two meshes beside --matches");
  if (!settings.matches.empty() && settings.explain)
    throw UsageError("--explain: not with --matches, as it explains what became of keypoints");
}

int run_pair(RunSettings settings) {
  load_plugins(settings.external.plugins);
  const OptionsByName options = parse_set(settings.set);
  std::vector<std::string> in_use = settings.match.in_use();
  for (const std::string& name : with_plugins(method_names(settings.methods))) in_use.push_back(name);
  require_in_use(options, in_use);
  settings.match.options = surface_part(options);
  check_usage(settings.match);
  settings.match.inspect = settings.verbose;
  check_threshold(settings.threshold_pr);
  if (settings.repeat < 1) throw UsageError("--repeat: expected at least 1");
  if (settings.explain && settings.truth.empty()) throw UsageError("--explain: needs --truth");
  check_inputs(settings);
  const PairRun run = evaluate(settings);
  if (settings.verbose && settings.matches.empty())
    say(stage_report(run.pair.report));
  else
    for (const std::string& line : advice(run.pair.report)) say(line);
  if (!settings.output.empty()) write_folder(run, settings);
  if (settings.json)
    put("", to_json(run, settings));
  else
    put("", in_words(run, settings));
  const bool failed = std::any_of(run.records.begin(), run.records.end(), [](const MethodRecord& record) {
    return !record.failure.empty() && record.failure_state != MethodState::NotApplicable;
  });
  return failed ? kPartial : kOk;
}

}  // namespace

void add_run(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("run", "Everything on one pair: match, group, score and refine with every grouper");
  auto settings = std::make_shared<RunSettings>();
  command->add_option("source", settings->source, "Source mesh (a model)")->type_name("FILE");
  command->add_option("target", settings->target, "Target mesh (a scene)")->type_name("FILE");
  command
      ->add_option("--matches", settings->matches,
                   "A table of matches to group, alone or beside the two meshes (which then only judge poses)")
      ->type_name("FILE");
  add_truth_options(*command, settings->truth, ": adds scores and errors");
  command
      ->add_option("--methods", settings->methods,
                   "all, paper (those of 2017), or names between commas: " + names_of(methods(), ","))
      ->capture_default_str();
  command->add_option("-o,--output", settings->output, "Folder for every intermediate file")->type_name("FOLDER");
  command->add_option("--threshold-pr", settings->threshold_pr, "Residual up to which a match is correct")
      ->capture_default_str();
  command->add_option("--repeat", settings->repeat, "Timed calls of each grouper; the median is reported")
      ->capture_default_str();
  command->add_flag("--dense", settings->dense,
                    "Also refine every pose on the whole surfaces, reported in a table of its own");
  add_pose_options(*command, settings->rows, settings->select);
  command->add_flag(
      "--explain", settings->explain,
      "Explain in words where the pair was registered or lost, before the grouping and by each grouper; needs --truth");
  add_external_options(*command, settings->external);
  add_memory_limit(*command, settings->memory_limit);
  command->add_flag("--json", settings->json, "As JSON; null where something is undefined");
  command->add_flag("-v,--verbose", settings->verbose, "The stage report on standard error");
  add_match_options(*command, settings->match);
  add_drop_stray(*command, settings->drop_stray);
  add_set_option(*command, settings->set);
  command->footer(
      "With a truth, the row 'oracle' (all correct matches) shows the result of a perfect grouper, and 'baseline' "
      "(all\n"
      "matches) that of no grouper. A pose registers the pair if its mean error over the overlap is at most 5 pr; the\n"
      "outcome is 'found' if both the fit to the selection and the refined pose do, 'saved' if only the refined pose\n"
      "does, 'spoiled' if only the fit does, else 'lost'. ADD is the mean error over the whole source, as a share of\n"
      "its diameter.\n"
      "Examples:\n  corral run model.ply scene.ply --truth truth.txt --explain\n"
      "  corral run --matches matches.csv --truth truth.txt\n"
      "  corral run model.ply scene.ply --methods ransac,gc --set ransac.iterations=50000 -o results --json");
  command->callback([settings, &action] { action = [settings] { return run_pair(*settings); }; });
}

}  // namespace corral
