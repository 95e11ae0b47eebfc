// SPDX-License-Identifier: MIT
// corral match: from two meshes, or from features of another program, to a table of matches.
#include "apps/commands/command_files.h"
#include "apps/commands/command_options.h"
#include "apps/pair/match_features.h"
#include "apps/pair/match_report.h"
#include "apps/runtime/output.h"
#include "apps/runtime/progress.h"
#include "apps/runtime/workers.h"
#include "io/array/number_table.h"
#include "io/disk/file.h"
#include "io/matches/matches_file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

struct Settings {
  std::string source, target, output;
  FeatureFiles source_features, target_features;
  MatchSettings match;
  std::vector<std::string> set;
  bool drop_stray = false, json = false, verbose = false;
};

/// pr, where features are given: of the two surfaces, or a length.
double resolution_of(const Settings& settings, const Mesh& source, const Mesh& target) {
  if (const auto length = parse_double(settings.match.resolution)) return *length;
  if (settings.source.empty())
    throw UsageError("--resolution: expected the length of pr in mesh units, or the two surfaces to measure it on");
  const ParallelFor parallel = workers(settings.match.threads);
  return pair_resolution(settings.match.resolution, point_resolution(source.vertices, parallel),
                         point_resolution(target.vertices, parallel));
}

FeaturePoints read_side(FeatureFiles files, const Mesh& surface) {
  if (surface.vertices.rows() > 0) files.vertices = &surface.vertices;
  FeaturePoints found = read_features(files);
  for (const std::string& note : found.notes) say("note: " + files.features + ": " + note);
  return found;
}

/// Keypoints and features that another program has made.
int match_given(const Settings& settings) {
  const FeatureFiles &first = settings.source_features, &second = settings.target_features;
  if (first.features.empty() || second.features.empty())
    throw UsageError("--source-features and --target-features: expected both");
  if (first.keypoints.empty() != second.keypoints.empty())
    throw UsageError("--source-keypoints and --target-keypoints: expected both or none");
  if (settings.source.empty() != settings.target.empty()) throw UsageError("expected both surfaces or none");
  if (settings.json || settings.verbose) throw UsageError("--json and -v report on meshes, not on given features");
  std::vector<std::string> inputs = {settings.source, settings.target};
  for (const std::string& name : {first.features, first.keypoints, second.features, second.keypoints})
    inputs.push_back(split_array_name(name).file);
  keep_inputs(inputs, {settings.output});
  if (!settings.output.empty()) check_writable(settings.output);
  const Mesh source = settings.source.empty() ? Mesh() : read_input(settings.source, settings.drop_stray);
  const Mesh target = settings.target.empty() ? Mesh() : read_input(settings.target, settings.drop_stray);
  const double resolution = resolution_of(settings, source, target);
  CorrespondenceSet matches = match_feature_points(read_side(first, source), read_side(second, target),
                                                   settings.match.matching, workers(settings.match.threads));
  matches.resolution = resolution;
  if (!settings.source.empty()) matches.source_centroid = source.vertices.colwise().mean().transpose();
  put(settings.output, matches_text(matches));
  return kOk;
}

int match(Settings settings) {
  const OptionsByName options = parse_set(settings.set);
  require_in_use(options, settings.match.in_use());
  settings.match.options = options;
  check_usage(settings.match);
  if (!settings.source_features.features.empty() || !settings.target_features.features.empty())
    return match_given(settings);
  if (settings.source.empty() || settings.target.empty())
    throw UsageError("expected two surfaces, or --source-features and --target-features");
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
  command->add_option("source", settings->source, "Source mesh (a model)")->type_name("FILE");
  command->add_option("target", settings->target, "Target mesh (a scene)")->type_name("FILE");
  command->add_option("-o,--output", settings->output, "Where the table goes (default: standard output)")
      ->type_name("FILE");
  command->add_flag("--json", settings->json, "The stage report as JSON on standard output (the table then needs -o)");
  command->add_flag("-v,--verbose", settings->verbose, "The stage report in words on standard error");
  const auto option = [&](const std::string& name, std::string& value, const std::string& text) {
    command->add_option(name, value, text)->type_name("FILE")->group("Features of another program");
  };
  option("--source-features", settings->source_features.features,
         "Instead of detecting and describing: rows x y z f1 .. fn, of any length, as text, .npy or .npz");
  option("--target-features", settings->target_features.features, "The same of the target");
  option("--source-keypoints", settings->source_features.keypoints,
         "Keypoints, if the features have no coordinates: rows x y z, or vertex indices of the source mesh");
  option("--target-keypoints", settings->target_features.keypoints, "The same of the target");
  add_match_options(*command, settings->match);
  add_drop_stray(*command, settings->drop_stray);
  add_set_option(*command, settings->set);
  command->footer(
      "Examples:\n  corral match model.ply scene.ply -o matches.csv\n"
      "  corral match model.ply scene.ply -v --json -o matches.csv\n"
      "  corral match model.ply scene.ply --detector harris-mesh --set harris-mesh.neighborhood=rings --mutual -o "
      "matches.csv\n"
      "  corral match --source-features fcgf0.npz --target-features fcgf1.npz --resolution 0.025 --mutual -o "
      "matches.csv");
  command->callback([settings, &action] { action = [settings] { return match(*settings); }; });
}

}  // namespace corral
