// SPDX-License-Identifier: MIT
// corral match: from two meshes to a table of matches.
#include "apps/commands/commands.h"
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
  bool json = false, verbose = false;
};

int match(Settings settings) {
  check_usage(settings.match);
  settings.match.inspect = settings.verbose || settings.json;
  if (!settings.output.empty()) check_writable(settings.output);
  const Mesh source = read_surface(settings.source), target = read_surface(settings.target);
  MatchedPair pair;
  {
    Progress progress(match_stages(settings.match));
    pair = match_pair(source, target, settings.match, [&](const std::string& stage) { progress.begin(stage); });
  }
  if (settings.verbose)
    say(stage_report(pair.report));
  else
    for (const std::string& hint : pair.report.hints) say("hint: " + hint);
  if (!settings.json || !settings.output.empty()) put(settings.output, matches_text(pair.matches));
  if (settings.json) put("", to_json(pair.report));
  return kOk;
}

}  // namespace

void add_match_options(CLI::App& command, MatchSettings& settings) {
  const auto option = [&](const std::string& name, auto& value, const std::string& text) {
    return command.add_option(name, value, text)->capture_default_str()->group("Matching");
  };
  option("--resolution", settings.resolution, "pr of the pair: mean, source, target, or a length in mesh units");
  option("--detector", settings.detector,
         "harris (on the points), harris-mesh (on the faces), or uniform (a control: one vertex per cube)");
  option("--keypoint-radius-pr", settings.keypoint_radius_pr,
         "Radius of harris and its suppression, of the ball of harris-mesh; spacing of uniform");
  option("--mesh-neighborhood", settings.harris_mesh.neighborhood, "harris-mesh: adaptive, rings or ball");
  option("--mesh-rings", settings.harris_mesh.rings, "harris-mesh: edges to the rim of its rings");
  option("--mesh-extent", settings.harris_mesh.extent, "harris-mesh: reach of adaptive, a share of the diagonal");
  option("--mesh-selection", settings.harris_mesh.selection, "harris-mesh: fraction or clustering");
  option("--mesh-fraction", settings.harris_mesh.fraction, "harris-mesh: share of the vertices that fraction keeps");
  option("--mesh-separation", settings.harris_mesh.separation,
         "harris-mesh: least distance in clustering, a share of the diagonal");
  option("--support-radius-pr", settings.support_radius_pr, "Radius of SHOT and its frame");
  option("--normals", settings.normals,
         "mesh: to the side of the faces, of a cloud towards the sensor; origin: all towards the sensor");
  option("--sensor", settings.sensor, "Where the sensor stood, in mesh units")
      ->delimiter(',')
      ->expected(3)
      ->default_str("0,0,0")
      ->type_name("X,Y,Z");
  option("--shot", settings.shot, "Shares between bins: additive, product, or pcl (additive with that library's slip)");
  option("--matcher", settings.matching.matcher,
         "exact, or flann (approximate, not reproducible, for very many features)");
  command.add_flag("--mutual", settings.matching.mutual, "Keep a match only if each side is the nearest of the other")
      ->group("Matching");
  option("--threads", settings.threads, "0: as many as there are; results do not depend on it");
}

void check_usage(const MatchSettings& settings) {
  try {
    settings.validate();
  } catch (const InvalidInput& error) {
    throw UsageError(error.what());
  }
}

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
  command->footer(
      "Examples:\n  corral match model.ply scene.ply -o matches.csv\n"
      "  corral match model.ply scene.ply -v --json -o matches.csv\n"
      "  corral match model.ply scene.ply --detector harris-mesh --mesh-neighborhood rings --mutual -o matches.csv");
  command->callback([settings, &action] { action = [settings] { return match(*settings); }; });
}

}  // namespace corral
