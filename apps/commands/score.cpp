// SPDX-License-Identifier: MIT
// corral score: precision and recall of a selection.
#include <cmath>

#include "apps/commands/commands.h"
#include "apps/report.h"
#include "io/group_file.h"
#include "io/matches_file.h"
#include "io/transform_file.h"

namespace corral {
namespace {

struct Settings {
  std::string matches, group, truth;
  double threshold_pr = 4;
  bool json = false;
};

int score(const Settings& settings) {
  check_threshold(settings.threshold_pr);
  const CorrespondenceSet matches = read_matches(settings.matches);
  const GroupTable group = read_group_of(settings.group, matches.size());
  const RigidTransform truth = read_transform(settings.truth);
  const GroupingScore scored = score_grouping(label_inliers(matches, truth, settings.threshold_pr), group.selected);
  if (settings.json) {
    Json json = to_json(scored);
    json["threshold_pr"] = settings.threshold_pr;
    put("", json);
  } else {
    TextTable table({"matches", "selected", "correct", "true matches", "precision", "recall", "F1"});
    table.add({std::to_string(scored.matches), std::to_string(scored.selected), std::to_string(scored.correct),
               std::to_string(scored.true_matches), fixed(scored.precision, 4), fixed(scored.recall, 4),
               fixed(scored.f1, 4)});
    put("", table.str());
  }
  return kOk;
}

}  // namespace

void check_threshold(double threshold_pr) {
  if (!(threshold_pr >= 0) || !std::isfinite(threshold_pr))
    throw UsageError("--threshold-pr: expected a finite length of at least 0");
}

void add_score(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("score", "Precision, recall and F1 of a selection against a true pose");
  auto settings = std::make_shared<Settings>();
  command->add_option("matches", settings->matches, "Table of matches")->type_name("FILE")->required();
  command->add_option("group", settings->group, "Selection made of it")->type_name("FILE")->required();
  command->add_option("--truth", settings->truth, "True target_from_source, a 4x4 matrix")
      ->type_name("FILE")
      ->required();
  command->add_option("--threshold-pr", settings->threshold_pr, "Residual up to which a match is right")
      ->capture_default_str();
  command->add_flag("--json", settings->json, "As JSON; null where a ratio is undefined");
  command->footer("Example:\n  corral score matches.csv group.csv --truth truth.txt --threshold-pr 4");
  command->callback([settings, &action] { action = [settings] { return score(*settings); }; });
}

}  // namespace corral
