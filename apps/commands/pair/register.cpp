// SPDX-License-Identifier: MIT
// corral register: two scans without a truth, one pose.
#include <algorithm>

#include "apps/commands/command_files.h"
#include "apps/commands/command_options.h"
#include "apps/pair/confidence_file.h"
#include "apps/pair/confidence_words.h"
#include "apps/pair/evaluate_pair.h"
#include "apps/pair/match_pair.h"
#include "apps/pair/match_report.h"
#include "apps/pair/register_pair.h"
#include "apps/picture/pair_picture.h"
#include "apps/runtime/output.h"
#include "apps/runtime/progress.h"
#include "apps/runtime/text_table.h"
#include "apps/runtime/workers.h"
#include "io/disk/file.h"
#include "io/matches/matches_file.h"
#include "io/mesh/mesh_file.h"
#include "io/pose/transform_file.h"
#include "kernel/surface/mesh/perturbation.h"

namespace corral {
namespace {

struct Settings {
  std::string source, target, matches, output, apply, picture, confidence;
  TruthSettings truth;
  MatchSettings match;
  std::vector<std::string> set;
  double least_confidence = 0;
  bool drop_stray = false, json = false;
};

struct Surfaces {
  Mesh source, target;
};

std::vector<std::string> outputs_of(const Settings& settings) {
  return {settings.output, settings.apply, settings.picture};
}

void check(const Settings& settings) {
  if (settings.source.empty() != settings.target.empty()) throw UsageError("target: expected two meshes");
  if (settings.source.empty() && settings.matches.empty())
    throw UsageError("expected two meshes, or --matches with a table of matches");
  if (settings.source.empty() && !(settings.apply.empty() && settings.picture.empty()))
    throw UsageError("--apply and --picture: need the two meshes");
  if (!settings.apply.empty()) check_ply_name(settings.apply);
  if (!settings.picture.empty() &&
      settings.picture.substr(std::max<std::size_t>(settings.picture.size(), 4) - 4) != ".png")
    throw UsageError("--picture " + settings.picture + ": expected a name that ends in .png");
  check_usage(settings.match);
  keep_inputs({settings.source, settings.target, settings.matches, settings.truth.file}, outputs_of(settings));
  for (const std::string& output : outputs_of(settings))
    if (!output.empty()) check_writable(output);
}

Json to_json(const ProposedPose& pose) {
  return {{"method", pose.method},
          {"target_from_source", corral::to_json(pose.target_from_source)},
          {"support", pose.support},
          {"score", pose.score},
          {"overlap", pose.surfaces.overlap},
          {"rms_pr", pose.surfaces.rms_pr},
          {"moved_pr", pose.surfaces.moved_pr},
          {"in_front", pose.surfaces.in_front}};
}

Json confidence_json(const Registration& found, const ConfidenceModel& model) {
  if (!found.signals) return nullptr;
  const double probability = model.probability(*found.signals);
  const std::size_t beyond = model.outside(*found.signals);
  return {{"probability", probability},
          {"verdict", verdict(probability)},
          {"for", kSignalNames[model.strongest(*found.signals)]},
          {"against", kSignalNames[model.weakest(*found.signals)]},
          {"outside", beyond < kSignals ? Json(kSignalNames[beyond]) : Json(nullptr)}};
}

Json to_json(const Registration& found, int matches, const std::optional<PoseErrors>& errors,
             const ConfidenceModel& model) {
  Json poses = Json::array(), signals = nullptr, error = nullptr;
  for (const ProposedPose& pose : found.poses) poses.push_back(to_json(pose));
  if (found.signals) {
    signals = Json::object();
    for (std::size_t i = 0; i < kSignals; ++i) signals[kSignalNames[i]] = (*found.signals)[i];
  }
  if (errors)
    error = {{"rotation_error_deg", errors->rotation_error_deg},
             {"translation_error_pr", errors->translation_error_pr},
             {"mean_error_pr", errors->points ? Json(errors->points->mean_pr) : Json(nullptr)},
             {"registers", is_registered(errors)}};
  return {{"matches", matches},
          {"methods", found.methods},
          {"poses", poses},
          {"signals", signals},
          {"confidence", confidence_json(found, model)},
          {"errors", error}};
}

std::string in_words(const Registration& found, bool has_surfaces) {
  if (found.poses.empty()) return "no pose: no grouper found one\n";
  TextTable table(
      has_surfaces ? std::vector<std::string>{"pose", "grouper", "matches", "coverage", "overlap", "RMS pr", "in front"}
                   : std::vector<std::string>{"pose", "grouper", "matches", "score"});
  constexpr std::size_t kShown = 3;
  for (std::size_t i = 0; i < std::min(kShown, found.poses.size()); ++i) {
    const ProposedPose& pose = found.poses[i];
    std::vector<std::string> row = {i == 0 ? "best" : std::to_string(i + 1), pose.method, std::to_string(pose.support),
                                    fixed(pose.score, 3)};
    if (has_surfaces)
      row.insert(row.end(),
                 {fixed(pose.surfaces.overlap, 3), fixed(pose.surfaces.rms_pr, 3), fixed(pose.surfaces.in_front, 3)});
    table.add(row);
  }
  return table.str();
}

void draw(const Settings& settings, const Surfaces& surfaces, const RigidTransform& pose, double probability) {
  PairScene scene;
  scene.truth = pose;
  scene.source = painted_surface(surfaces.source);
  scene.target = painted_surface(surfaces.target);
  write_file(
      settings.picture,
      png_bytes(alignment_pictures(
                    scene, {{std::string(verdict(probability)) + ": probability " + fixed(probability, 2), pose}}, 1200)
                    .front()));
}

/// The files that were asked for, unless the pose is less probable than it has to be; what is distrusted is said.
void write_outputs(const Settings& settings, const std::optional<Surfaces>& surfaces, const RigidTransform& pose,
                   double probability) {
  const std::vector<std::string> outputs = outputs_of(settings);
  const bool is_asked =
      std::any_of(outputs.begin(), outputs.end(), [](const std::string& output) { return !output.empty(); });
  if (probability < settings.least_confidence)
    return say("note: the probability is below --least-confidence: no file was written");
  if (!is_asked) return;
  if (!settings.output.empty()) write_file(settings.output, transform_text(pose));
  if (!settings.apply.empty()) write_mesh(settings.apply, move_mesh(surfaces->source, pose));
  if (!settings.picture.empty()) draw(settings, *surfaces, pose, probability);
  if (probability < kDoubted) say("note: the files were written, but the pose is not to be used");
}

int register_two(Settings settings) {
  const OptionsByName options = parse_set(settings.set);
  require_in_use(options, settings.match.in_use());
  settings.match.options = surface_part(options);
  check(settings);
  const ConfidenceModels models = settings.confidence.empty()
                                      ? built_in_confidence()
                                      : parse_confidence(settings.confidence, read_file(settings.confidence));
  std::optional<RigidTransform> truth;
  if (!settings.truth.empty()) truth = read_truth(settings.truth);
  std::optional<Surfaces> surfaces;
  if (!settings.source.empty())
    surfaces = {read_input(settings.source, settings.drop_stray), read_input(settings.target, settings.drop_stray)};
  MatchedPair pair;
  Registration found;
  {
    Progress progress(match_stages(settings.match) + registration_steps());
    const auto begin = [&](const std::string& stage) { progress.begin(stage); };
    if (settings.matches.empty())
      pair = match_pair(surfaces->source, surfaces->target, settings.match, {begin});
    else
      pair.matches = read_matches(settings.matches);
    std::optional<RegisteredSurfaces> given;
    if (surfaces) {
      std::optional<ViewOptions> sensor;
      if (settings.match.sensor.size() == 3)
        sensor = ViewOptions{{settings.match.sensor[0], settings.match.sensor[1], settings.match.sensor[2]}, {}};
      given.emplace(RegisteredSurfaces{surfaces->source, surfaces->target, sensor, sensor});
    }
    found = register_pair(pair.matches, given, workers(settings.match.threads), begin);
  }
  for (const std::string& line : advice(pair.report)) say(line);
  std::optional<PoseErrors> errors;
  if (truth && !found.poses.empty()) {
    const PairTruth right = surfaces
                                ? pair_truth(surfaces->source, surfaces->target, *truth, pair.matches.resolution, 4)
                                : table_truth(pair.matches, *truth, 4);
    errors = pose_errors(found.poses.front().target_from_source, right, pair.matches.resolution);
  }
  const ConfidenceModel& model = surfaces ? models.surfaces : models.table;
  const double probability = found.signals ? model.probability(*found.signals) : 0;
  if (!found.poses.empty()) write_outputs(settings, surfaces, found.poses.front().target_from_source, probability);
  if (settings.json)
    put("", to_json(found, pair.matches.size(), errors, model));
  else
    put("",
        in_words(found, surfaces.has_value()) + (found.signals ? confidence_words(model, *found.signals) + "\n" : ""));
  return found.poses.empty() || probability < settings.least_confidence ? kPartial : kOk;
}

}  // namespace

void add_register(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("register", "Two scans without a truth: the pose that lays one on the other");
  auto settings = std::make_shared<Settings>();
  command->add_option("source", settings->source, "The surface that is moved")->type_name("FILE");
  command->add_option("target", settings->target, "The surface that stays")->type_name("FILE");
  command
      ->add_option("--matches", settings->matches,
                   "A table of matches instead of the descriptors' own, alone or beside the two meshes")
      ->type_name("FILE");
  command->add_option("-o,--output", settings->output, "The pose, 4x4, target from source")->type_name("FILE");
  command->add_option("--apply", settings->apply, "The source, moved onto the target: a PLY file")->type_name("FILE");
  command->add_option("--picture", settings->picture, "A picture of both under the pose")->type_name("FILE.png");
  command
      ->add_option("--confidence", settings->confidence,
                   "The model of 'corral calibrate' (default: of made scans, paper/README.md)")
      ->type_name("FILE");
  command
      ->add_option("--least-confidence", settings->least_confidence,
                   "Write nothing, and end with status 4, if the pose registers the pair with a smaller probability")
      ->type_name("0..1")
      ->check(CLI::Range(0.0, 1.0));
  add_truth_options(*command, settings->truth, ": adds the errors of the pose to --json");
  command->add_flag("--json", settings->json, "Poses with what speaks for each, as JSON");
  add_match_options(*command, settings->match);
  add_drop_stray(*command, settings->drop_stray);
  add_set_option(*command, settings->set);
  command->footer(
      "Several groupers propose poses, with their runners-up. Each is refined over the matches, the best on the whole surfaces;\n"
      "the pose under which the surfaces cover each other best is returned. With --sensor, both are views from there, and poses\n"
      "that put points in front of what the other view saw are dropped.\n"
      "One pr is the mean distance from a vertex to its nearest neighbour. matches: those with a residual of at most 5 pr; a few are\n"
      "enough where the surfaces agree. coverage: how well the surfaces lie on each other, 0 to 1. overlap: share of the source that finds the\n"
      "target within 4 pr. RMS pr: what is left between them. in front: share of points in front of what the other sensor saw.\n"
      "A pose is right if its mean error is at most 5 pr. Trust it: a probability of 0.9 and more. Do not use it: below 0.5.\n"
      "Examples:\n"
      "  corral register scan1.ply scan2.ply -o pose.txt --apply moved.ply --picture both.png\n"
      "  corral register --matches matches.csv -o pose.txt");
  command->callback([settings, &action] { action = [settings] { return register_two(*settings); }; });
}

}  // namespace corral
