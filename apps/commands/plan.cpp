// SPDX-License-Identifier: MIT
// corral plan: what a study will take, before anything runs.
#include <algorithm>

#include "apps/commands/commands.h"
#include "apps/commands/study_options.h"
#include "apps/runtime/output.h"
#include "apps/runtime/text_table.h"
#include "apps/study/plan.h"
#include "apps/study/shard.h"
#include "apps/study/study_journals.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

struct Settings {
  StudyOptions options;
  int shards = 1;
  std::string like;
  bool json = false;
};

std::string duration(double seconds) {
  if (seconds < 120) return fixed(seconds, 0) + " s";
  return seconds < 7200 ? fixed(seconds / 60, 0) + " min" : fixed(seconds / 3600, 1) + " h";
}

int plan(const Settings& settings) {
  if (settings.shards < 1 || settings.shards > kMostShards)
    throw UsageError("--shards: expected 1 .. " + std::to_string(kMostShards));
  const WorkList list = work_list_of(settings.options);
  const double factor = settings.like.empty() ? 1 : recorded_over_estimated(settings.like);
  std::vector<ShardPlan> plans = plan_shards(estimate_units(list), settings.shards);
  ShardPlan whole, largest;
  for (ShardPlan& plan : plans) {
    plan.seconds *= factor;
    whole.pairs += plan.pairs, whole.seconds += plan.seconds;
    whole.peak_bytes = std::max(whole.peak_bytes, plan.peak_bytes);
    largest.seconds = std::max(largest.seconds, plan.seconds);
  }
  if (settings.json) {
    Json shards = Json::array();
    for (std::size_t i = 0; i < plans.size(); ++i)
      shards.push_back({{"shard", to_text(Shard{static_cast<int>(i) + 1, settings.shards})},
                        {"pairs", plans[i].pairs},
                        {"seconds", plans[i].seconds},
                        {"peak_bytes", plans[i].peak_bytes}});
    put("", Json{{"pairs", whole.pairs},
                 {"seconds", whole.seconds},
                 {"longest_shard_seconds", largest.seconds},
                 {"peak_bytes", whole.peak_bytes},
                 {"shards", shards}});
    return kOk;
  }
  TextTable table({"shard", "pairs", "time", "memory (MB)"});
  for (std::size_t i = 0; i < plans.size(); ++i)
    table.add({to_text(Shard{static_cast<int>(i) + 1, settings.shards}), std::to_string(plans[i].pairs),
               duration(plans[i].seconds), fixed(plans[i].peak_bytes / 1e6, 0)});
  put("", table.str());
  say(std::to_string(whole.pairs) + " pairs, about " + duration(whole.seconds) + " on one processor; " +
      (settings.shards > 1 ? "the longest shard takes " + duration(largest.seconds) + "; " : "") +
      "memory for each pair at a time (--jobs)");
  return kOk;
}

}  // namespace

void add_plan(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("plan", "What a study will take: pairs, time and memory of each shard");
  auto settings = std::make_shared<Settings>();
  add_study_options(*command, settings->options);
  command->add_option("--shards", settings->shards, "In how many parts")->capture_default_str();
  command
      ->add_option("--like", settings->like,
                   "A study that was made on such a machine: its recorded times scale the estimate")
      ->type_name("STUDY");
  command->add_flag("--json", settings->json, "As JSON");
  command->footer(
      "Nothing is evaluated: times and memory are estimated from the sizes of the files.\n"
      "Examples:\n  corral plan noise clutter --data data --shards 20\n"
      "  corral plan noise clutter --data data --shards 20 --like runs/clutter");
  command->callback([settings, &action] { action = [settings] { return plan(*settings); }; });
}

}  // namespace corral
