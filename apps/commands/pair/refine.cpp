// SPDX-License-Identifier: MIT
// corral refine: from a selection to a pose.
#include <algorithm>
#include <cmath>

#include "apps/commands/command_files.h"
#include "apps/commands/command_options.h"
#include "apps/pair/report_pair.h"
#include "apps/runtime/output.h"
#include "apps/runtime/text_table.h"
#include "io/disk/file.h"
#include "io/matches/group_file.h"
#include "io/matches/matches_file.h"
#include "io/pose/transform_file.h"
#include "kernel/error.h"

namespace corral {
namespace {

struct Settings {
  std::string matches, group, start, loss = choice_names(RobustLoss())[int(RefineOptions().loss)], output;
  TruthSettings truth;
  double threshold_pr = 4;
  RefineOptions options;
  bool json = false;
};

/// The names of all losses, separated.
std::string loss_names(const std::string& separator) {
  std::string text;
  for (const char* name : choice_names(RobustLoss())) text += (text.empty() ? "" : separator) + name;
  return text;
}

RobustLoss loss_of(const std::string& text) {
  const auto names = choice_names(RobustLoss());
  const auto found = std::find(names.begin(), names.end(), text);
  if (found == names.end()) throw UsageError("--loss: found '" + text + "', expected " + loss_names(", "));
  return static_cast<RobustLoss>(found - names.begin());
}

/// Scores the selection and judges its pose over the source points of the correct matches, a part of the overlap that is
/// known without the meshes.
void judge(MethodRecord& record, const CorrespondenceSet& matches, const Settings& settings) {
  PairTruth truth{read_truth(settings.truth), {}, settings.threshold_pr};
  const std::vector<bool> labels = label_correct(matches, truth.target_from_source, settings.threshold_pr);
  record.score = score_grouping(labels, record.found.selected);
  Indices correct;
  for (int row = 0; row < matches.size(); ++row)
    if (labels[static_cast<std::size_t>(row)]) correct.push_back(row);
  truth.overlap = matches.source_points(correct, Eigen::all);
  judge_pose(record, truth, matches.resolution);
}

std::string in_words(const MethodRecord& record) {
  const RefinedPose& pose = record.pose;
  if (!pose.target_from_source) return std::string("no pose: ") + to_text(pose.status);
  std::string text = std::string(to_text(pose.status)) + (pose.converged ? ", converged after " : ", stopped after ") +
                     std::to_string(pose.iterations) + " iterations, RMS residual " + fixed(pose.initial_rms_pr, 3) +
                     " -> " + fixed(pose.final_rms_pr, 3) + " pr, cost " + fixed(pose.initial_cost, 3) + " -> " +
                     fixed(pose.final_cost, 3) + " pr^2";
  if (record.errors) {
    text += "; rotation error " + fixed(record.errors->rotation_error_deg, 4) + " deg, translation error " +
            fixed(record.errors->translation_error_pr, 4) + " pr";
    if (record.errors->points) text += ", RMSE " + fixed(record.errors->points->rmse_pr, 4) + " pr";
  }
  return text;
}

int refine(Settings settings) {
  check_threshold(settings.threshold_pr);
  settings.options.loss = loss_of(settings.loss);
  if (!(settings.options.loss_scale_pr > 0) || !std::isfinite(settings.options.loss_scale_pr))
    throw UsageError("--loss-scale-pr: expected a finite length above 0");
  keep_inputs({settings.matches, settings.group, settings.truth.file, settings.start}, {settings.output});
  const CorrespondenceSet matches = read_matches(settings.matches);
  const GroupTable group = read_group_of(settings.group, matches.size());
  std::optional<RigidTransform> start;
  if (!settings.start.empty()) start = read_pose(settings.start);
  MethodRecord record;
  record.found.selected = group.selected;
  record.pose = refine_rigid(matches, group.selected, settings.options, start);
  if (!settings.truth.empty()) judge(record, matches, settings);

  const RefinedPose& pose = record.pose;
  if (pose.target_from_source && (!settings.json || !settings.output.empty()))
    put(settings.output, transform_text(*pose.target_from_source));
  if (settings.json)
    put("", pose_json(record));
  else
    say(in_words(record));
  if (!pose.target_from_source && !settings.output.empty()) remove_file(settings.output);  // no pose, no file of one
  return kOk;
}

}  // namespace

void add_refine(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("refine", "The refined rigid pose of a selection");
  auto settings = std::make_shared<Settings>();
  command->add_option("matches", settings->matches, "Table of matches")->type_name("FILE")->required();
  command->add_option("group", settings->group, "Selection from it")->type_name("FILE")->required();
  add_truth_options(*command, settings->truth, ": adds the errors of the pose and of its start");
  command->add_option("--loss", settings->loss, "Robust loss: " + loss_names(", "))->capture_default_str();
  command
      ->add_option("--loss-scale-pr", settings->options.loss_scale_pr,
                   "Residual at which a match begins to lose its influence (tukey: has none left; none: not used)")
      ->capture_default_str();
  command
      ->add_option("--start", settings->start,
                   "Where to start, a pose in any layout (default: the least-squares fit to the selection)")
      ->type_name("FILE[:KEY]");
  command
      ->add_option("--threshold-pr", settings->threshold_pr,
                   "Largest residual of a correct match; RMSE is over the source points of the correct matches")
      ->capture_default_str();
  command->add_option("-o,--output", settings->output, "Where the pose goes (default: standard output)")
      ->type_name("FILE");
  command->add_flag("--json", settings->json,
                    "Pose, covariance, condition, costs, errors and status as JSON on standard output");
  command->footer(
      "If there is no pose (fewer than 3 rows, or all on one line), no file is written and the status says why.\n"
      "Examples:\n  corral refine matches.csv group.csv -o pose.txt\n"
      "  corral refine matches.csv group.csv --truth truth.txt --json\n"
      "  corral refine matches.csv group.csv --loss geman-mcclure --loss-scale-pr 3 --start method_pose.txt");
  command->callback([settings, &action] { action = [settings] { return refine(*settings); }; });
}

}  // namespace corral
