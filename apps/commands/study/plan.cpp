// SPDX-License-Identifier: MIT
// corral plan: what a study will take, before anything runs.
#include <algorithm>
#include <numeric>

#include "apps/commands/commands.h"
#include "apps/commands/study/study_options.h"
#include "apps/commands/study/study_text.h"
#include "apps/report/figure/folders.h"
#include "apps/report/figure/gnuplot.h"
#include "apps/report/figure/panel_figure.h"
#include "apps/runtime/output.h"
#include "apps/runtime/text_table.h"
#include "apps/study/plan.h"
#include "apps/study/shard.h"
#include "apps/study/study_journals.h"
#include "io/disk/file.h"

namespace corral {
namespace {

struct Settings {
  StudyOptions options;
  int shards = 1;
  std::string like, scaling;
  bool json = false;
};

/// Of every unit: its own time where that study recorded it, else its estimate, scaled to that study.
std::vector<double> unit_seconds(const WorkList& list, const std::vector<UnitEstimate>& estimates,
                                 const std::string& like) {
  const RecordedTimes times = like.empty() ? RecordedTimes() : recorded_times(like);
  std::vector<double> seconds;
  for (std::size_t unit = 0; unit < estimates.size(); ++unit) {
    const auto found = times.seconds.find(unit_key(list.units[unit]));
    seconds.push_back(found == times.seconds.end() ? times.factor * estimates[unit].seconds() : found->second);
  }
  return seconds;
}

double longest_of(const std::vector<ShardPlan>& plans) {
  return std::max_element(plans.begin(), plans.end(),
                          [](const ShardPlan& a, const ShardPlan& b) { return a.seconds < b.seconds; })
      ->seconds;
}

/// The time of the longest shard, by the number of shards, beside that of a split without any loss.
Panel scaling_panel(const std::vector<UnitEstimate>& estimates, const std::vector<double>& seconds) {
  Panel panel;
  panel.name = "plan-scaling";
  panel.x_axis = "shards, each on one processor";
  panel.y_axis = "time until all are done (s)";
  panel.axes = PanelAxes::Logarithmic;
  panel.smaller_is_better = true;
  panel.series = {{"split of the plan", {}}, {"sum / shards", {}}};
  const double sum = std::accumulate(seconds.begin(), seconds.end(), 0.0);
  for (const int shards : {1, 2, 5, 10, 20, 50, 100, 200, 500, 1000}) {
    panel.levels.push_back(std::to_string(shards));
    panel.series[0].values.push_back({longest_of(plan_shards(estimates, shards, seconds)), {}, {}});
    panel.series[1].values.push_back({sum / shards, {}, {}});
  }
  return panel;
}

void write_scaling(const Panel& panel, const std::string& folder) {
  const std::string place = folder + "/";
  for (const char* part : {kFigures, kScripts, kData}) make_folder(place + part);
  write_files(
      {{place + kData + panel.name + ".csv", panel_csv(panel)},
       {place + kScripts + panel.name + ".gp", panel_script({panel.name, "Time of a study in shards", {panel}})}});
  run_gnuplot(folder, panel.name);
  say("the figure is " + place + kFigures + panel.name + ".svg, and .pdf");
}

Json to_json(const ShardPlan& plan, const Shard& shard) {
  return {{"shard", to_text(shard)}, {"pairs", plan.pairs}, {"seconds", plan.seconds}, {"peak_bytes", plan.peak_bytes}};
}

void put_plan(const std::vector<ShardPlan>& plans, bool as_json) {
  ShardPlan whole;
  Json shards = Json::array();
  TextTable table({"shard", "pairs", "time", "memory (MB)"});
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const Shard shard{static_cast<int>(i) + 1, static_cast<int>(plans.size())};
    shards.push_back(to_json(plans[i], shard));
    table.add({to_text(shard), std::to_string(plans[i].pairs), duration(plans[i].seconds),
               fixed(plans[i].peak_bytes / 1e6, 0)});
    whole.pairs += plans[i].pairs, whole.seconds += plans[i].seconds;
    whole.peak_bytes = std::max(whole.peak_bytes, plans[i].peak_bytes);
  }
  const double longest = longest_of(plans);
  if (as_json) {
    put("", Json{{"pairs", whole.pairs},
                 {"seconds", whole.seconds},
                 {"longest_shard_seconds", longest},
                 {"peak_bytes", whole.peak_bytes},
                 {"shards", shards}});
    return;
  }
  put("", table.str());
  say(std::to_string(whole.pairs) + " pairs, about " + duration(whole.seconds) + " on one processor; " +
      (plans.size() > 1 ? "the longest shard takes " + duration(longest) + "; " : "") +
      "memory for each pair at a time (--jobs)");
}

int plan(const Settings& settings) {
  if (settings.shards < 1 || settings.shards > kMostShards)
    throw UsageError("--shards: expected 1 .. " + std::to_string(kMostShards));
  const WorkList list = work_list_of(settings.options);
  const std::vector<UnitEstimate> estimates = estimate_units(list);
  const std::vector<double> seconds = unit_seconds(list, estimates, settings.like);
  put_plan(plan_shards(estimates, settings.shards, seconds), settings.json);
  if (!settings.scaling.empty()) write_scaling(scaling_panel(estimates, seconds), settings.scaling);
  return kOk;
}

}  // namespace

void add_plan(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("plan", "What a study will take: pairs, time and memory of each shard");
  auto settings = std::make_shared<Settings>();
  add_study_options(*command, settings->options);
  command->add_option("--shards", settings->shards, "In how many parts")->capture_default_str();
  command
      ->add_option(
          "--like", settings->like,
          "Use the times recorded in this study: of the same pairs as they are, of others to scale the estimates")
      ->type_name("STUDY");
  command->add_option("--scaling", settings->scaling, "Also draw the time of 1 to 1000 shards, into this folder")
      ->type_name("FOLDER");
  command->add_flag("--json", settings->json, "As JSON");
  command->footer(
      "Nothing is evaluated: times and memory are estimated from the sizes of the files. The cost of a plug-in\n"
      "or another program is unknown: it counts as a fast grouper that needs no memory, unless --like has its times.\n"
      "Examples:\n  corral plan noise clutter --data data --shards 20\n"
      "  corral plan noise clutter --data data --shards 20 --like runs/clutter --scaling plan");
  command->callback([settings, &action] { action = [settings] { return plan(*settings); }; });
}

}  // namespace corral
