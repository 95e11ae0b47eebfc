// SPDX-License-Identifier: MIT
// corral score: precision and recall of a selection, and the error of the pose that follows from it or is stated with it.
#include <cmath>

#include "apps/commands/command_files.h"
#include "apps/commands/command_options.h"
#include "apps/pair/foreign_answer.h"
#include "apps/pair/report_pair.h"
#include "apps/pair/surface_warnings.h"
#include "apps/pair/truth_fit.h"
#include "apps/runtime/output.h"
#include "apps/runtime/text_table.h"
#include "io/matches/matches_file.h"

namespace corral {
namespace {

struct Settings {
  std::string matches, group, pose, source, target;
  TruthSettings truth;
  double threshold_pr = 4;
  bool json = false;
};

/// The stated pose, or else the least-squares fit to the selection, against the truth; without the meshes, over no points.
MethodRecord judge_start(const CorrespondenceSet& matches, const GroupingResult& found, const Settings& settings) {
  PairTruth truth{read_truth(settings.truth), {}, settings.threshold_pr};
  if (!settings.source.empty()) {
    const Mesh source = read_input(settings.source), target = read_input(settings.target);
    const PointSpacing from = point_spacing(source.vertices), to = point_spacing(target.vertices);
    for (const std::string& warning : surface_warnings(source, from)) say("warning: source: " + warning);
    for (const std::string& warning : surface_warnings(target, to)) say("warning: target: " + warning);
    const TruthFit fit = fit_truth(source, target, truth.target_from_source, from, to);
    if (!fit.belongs()) say("warning: truth does not fit: " + fit.text());
    truth = pair_truth(source, target, truth.target_from_source, matches.resolution, settings.threshold_pr);
  }
  MethodRecord record;
  record.score =
      score_grouping(label_correct(matches, truth.target_from_source, settings.threshold_pr), found.selected);
  record.pose.initial =
      found.target_from_source ? found.target_from_source : refine_rigid(matches, found.selected).initial;
  judge_pose(record, truth, matches.resolution);
  return record;
}

const std::vector<TableColumn> kScoreColumns = {
    {"matches", "matches"},        {"selected", "selected"}, {"correct", "correct"}, {"all correct", "true_matches"},
    {"precision", "precision", 4}, {"recall", "recall", 4},  {"F1", "f1", 4}};
/// Of what is judged: the fit, or a pose.
std::vector<TableColumn> error_columns(const std::string& judged) {
  return {{judged + ": rot err deg", "initial_rotation_error_deg", 4},
          {"transl err pr", "initial_translation_error_pr", 4},
          {"mean err pr", "initial_mean_error_pr", 4},
          {"RMSE pr", "initial_rmse_pr", 4},
          {"ADD", "initial_add_share", 4},
          {"ADD-S", "initial_add_s_share", 4}};
}

int score(const Settings& settings) {
  check_threshold(settings.threshold_pr);
  if (settings.source.empty() != settings.target.empty())
    throw UsageError("--source and --target: expected both meshes or none");
  if (settings.group.empty() && settings.pose.empty()) throw UsageError("expected a selection, --pose or both");
  const CorrespondenceSet matches = read_matches(settings.matches);
  const GroupingResult found = read_answer({settings.group, settings.pose, "", {}}, matches);
  if (settings.group.empty())
    say("note: without a selection, that of the pose is scored: the matches within " + fixed(kStatedPosePr, 0) + " pr");
  const MethodRecord record = judge_start(matches, found, settings);
  Json json = to_json(*record.score);
  json["threshold_pr"] = settings.threshold_pr;
  add_errors(json, "initial_", record.initial_errors, !settings.source.empty());
  if (settings.json)
    put("", json);
  else
    put("", table_text({json}, kScoreColumns) + "\n" +
                table_text({json}, error_columns(settings.pose.empty() ? "fit" : "pose")));
  return kOk;
}

}  // namespace

void add_score(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("score", "Precision, recall and pose error of a selection against a true pose");
  auto settings = std::make_shared<Settings>();
  command->add_option("matches", settings->matches, "Table of matches")->type_name("FILE")->required();
  command
      ->add_option("group", settings->group,
                   "Selection from it: of 'corral group', or of another program (0 or 1 for each match, or the numbers "
                   "of rows from 0; text or .npy)")
      ->type_name("FILE");
  command
      ->add_option(
          "--pose", settings->pose,
          "Pose of another program, judged in place of the fit: FILE or FILE:KEY, as 'corral transform' reads it")
      ->type_name("FILE");
  add_truth_options(*command, settings->truth)->required();
  command->add_option("--threshold-pr", settings->threshold_pr, "Residual up to which a match is correct")
      ->capture_default_str();
  command
      ->add_option("--source", settings->source, "Source mesh: with --target adds RMSE over the overlap, ADD and ADD-S")
      ->type_name("FILE");
  command->add_option("--target", settings->target, "Target mesh")->type_name("FILE");
  command->add_flag("--json", settings->json, "As JSON; null where a value is undefined");
  command->footer(
      "The pose is the least-squares fit to the selection; 'corral refine --truth' evaluates the refined one.\n"
      "Examples:\n  corral score matches.csv group.csv --truth truth.txt --threshold-pr 4\n"
      "  corral score matches.csv group.csv --truth truth.txt --source model.ply --target scene.ply --json\n"
      "  corral score matches.csv mac/labels.npy --pose mac/pose.txt --truth truth.txt");
  command->callback([settings, &action] { action = [settings] { return score(*settings); }; });
}

}  // namespace corral
