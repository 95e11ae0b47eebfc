// SPDX-License-Identifier: MIT
// corral refine: from a selection to a pose.
#include "apps/commands/commands.h"
#include "apps/report.h"
#include "io/file.h"
#include "io/group_file.h"
#include "io/matches_file.h"
#include "io/transform_file.h"
#include "kernel/error.h"

namespace corral {
namespace {

struct Settings {
  std::string matches, group, truth, output;
  double threshold_pr = 4;
  bool json = false;
};

/// The source points of the right matches: where the two surfaces are known to overlap without seeing them.
PairTruth truth_of(const CorrespondenceSet& matches, const Settings& settings) {
  PairTruth truth{read_transform(settings.truth), {}, settings.threshold_pr};
  const std::vector<bool> labels = label_inliers(matches, truth.target_from_source, settings.threshold_pr);
  Indices right;
  for (int row = 0; row < matches.size(); ++row)
    if (labels[static_cast<std::size_t>(row)]) right.push_back(row);
  truth.overlap = matches.source_points(right, Eigen::all);
  return truth;
}

std::string in_words(const RefinedPose& pose, const std::optional<PoseErrors>& errors) {
  if (!pose.target_from_source) return std::string("no pose: ") + to_text(pose.status);
  std::string text = std::string(to_text(pose.status)) + (pose.converged ? ", converged after " : ", stopped after ") +
                     std::to_string(pose.iterations) + " iterations, RMS residual " + fixed(pose.initial_rms_pr, 3) +
                     " -> " + fixed(pose.final_rms_pr, 3) + " pr";
  if (errors) {
    text += "; rotation error " + fixed(errors->rotation_error_deg, 4) + " deg, translation error " +
            fixed(errors->translation_error_pr, 4) + " pr";
    if (errors->points) text += ", RMSE " + fixed(errors->points->rmse_pr, 4) + " pr";
  }
  return text;
}

int refine(const Settings& settings) {
  check_threshold(settings.threshold_pr);
  const CorrespondenceSet matches = read_matches(settings.matches);
  const GroupTable group = read_group_of(settings.group, matches.size());
  std::optional<PairTruth> truth;
  if (!settings.truth.empty()) truth = truth_of(matches, settings);
  const RefinedPose pose = refine_rigid(matches, group.selected);
  std::optional<PoseErrors> errors;
  if (truth && pose.target_from_source) errors = pose_errors(*pose.target_from_source, *truth, matches.resolution);

  if (pose.target_from_source && (!settings.json || !settings.output.empty()))
    put(settings.output, transform_text(*pose.target_from_source));
  if (settings.json)
    put("", to_json(pose, errors));
  else
    say(in_words(pose, errors));
  if (!pose.target_from_source && !settings.output.empty()) remove_file(settings.output);  // no pose, no file of one
  return kOk;
}

}  // namespace

void add_refine(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("refine", "The rigid pose behind a selection, refined");
  auto settings = std::make_shared<Settings>();
  command->add_option("matches", settings->matches, "Table of matches")->type_name("FILE")->required();
  command->add_option("group", settings->group, "Selection made of it")->type_name("FILE")->required();
  command->add_option("--truth", settings->truth, "True target_from_source, a 4x4 matrix: adds the errors of the pose")
      ->type_name("FILE");
  command
      ->add_option("--threshold-pr", settings->threshold_pr,
                   "Residual of a right match; RMSE is taken over the source points of the right matches")
      ->capture_default_str();
  command->add_option("-o,--output", settings->output, "Where the pose goes (default: standard output)")
      ->type_name("FILE");
  command->add_flag("--json", settings->json, "Pose, covariance, errors and status as JSON on standard output");
  command->footer(
      "Without a pose (fewer than 3 rows, or all on one line) there is no pose file and the status says why.\n"
      "Examples:\n  corral refine matches.csv group.csv -o pose.txt\n"
      "  corral refine matches.csv group.csv --truth truth.txt --json");
  command->callback([settings, &action] { action = [settings] { return refine(*settings); }; });
}

}  // namespace corral
