// SPDX-License-Identifier: MIT
// corral compare: which differences between the groupers of a study are more than chance.
#include <algorithm>

#include "apps/commands/commands.h"
#include "apps/results/comparison.h"
#include "apps/runtime/output.h"
#include "apps/runtime/text_table.h"
#include "apps/runtime/workers.h"

namespace corral {
namespace {

struct Settings {
  std::string run, metric = "f1", experiment;
  bool json = false;
};

Json to_json(const MeanInterval& interval) {
  return {{"mean", interval.mean}, {"low", interval.low}, {"high", interval.high}};
}

Json to_json(const MethodComparison& comparison) {
  Json methods = Json::array(), tests = Json::array(), levels = Json::array(), cliques = Json::array();
  for (std::size_t i = 0; i < comparison.means.size(); ++i) {
    methods.push_back({{"method", comparison.methods[i]}, {"average_rank", comparison.ranks.average_ranks[i]}});
    methods.back().update(to_json(comparison.means[i]));
  }
  for (const MethodPair& pair : comparison.tests) {
    tests.push_back({{"first", pair.first}, {"second", pair.second}});
    tests.back().update(to_json(pair.difference));
    tests.back().update(Json{{"p", pair.p}, {"adjusted_p", pair.adjusted_p}, {"exact", pair.is_exact}});
  }
  for (const LevelMean& mean : comparison.levels) {
    levels.push_back({{"level", mean.level}, {"method", mean.method}, {"pairs", mean.pairs}});
    levels.back().update(to_json(mean.mean));
  }
  for (const std::vector<int>& clique : comparison.ranks.cliques) {
    Json& names = cliques.emplace_back(Json::array());
    for (const int method : clique) names.push_back(comparison.methods[static_cast<std::size_t>(method)]);
  }
  return {{"experiment", comparison.experiment},
          {"pairs", comparison.pairs},
          {"methods", methods},
          {"friedman", {{"chi_square", comparison.ranks.chi_square}, {"p", comparison.ranks.p}}},
          {"critical_difference", comparison.ranks.critical_difference},
          {"cliques", cliques},
          {"tests", tests},
          {"levels", levels}};
}

/// Four decimals, or a bound for smaller ones.
std::string p_text(double p) { return p < 0.0001 ? "<0.0001" : fixed(p, 4); }

std::string interval_text(const MeanInterval& interval, int decimals) {
  return fixed(interval.low, decimals) + " .. " + fixed(interval.high, decimals);
}

std::string means_text(const MethodComparison& comparison) {
  TextTable table({"grouper", "mean", "95 % interval", "average rank"});
  for (std::size_t i = 0; i < comparison.means.size(); ++i)
    table.add({comparison.methods[i], fixed(comparison.means[i].mean, 4), interval_text(comparison.means[i], 4),
               fixed(comparison.ranks.average_ranks[i], 2)});
  std::string text = table.str() + "Friedman: chi-square " + fixed(comparison.ranks.chi_square, 2) + ", p " +
                     p_text(comparison.ranks.p) + "; average ranks further apart than " +
                     fixed(comparison.ranks.critical_difference, 3) + " differ (Nemenyi, 5 %)\n";
  for (const std::vector<int>& clique : comparison.ranks.cliques) {
    text += "not significantly different:";
    for (const int method : clique) text += " " + comparison.methods[static_cast<std::size_t>(method)];
    text += "\n";
  }
  return text;
}

std::string tests_text(const MethodComparison& comparison, const Measure& measure) {
  TextTable table(
      {"groupers", "difference", "95 % interval", measure.has(kYesOrNo) ? "McNemar p" : "Wilcoxon p", "Holm's p"});
  for (const MethodPair& pair : comparison.tests)
    table.add({pair.first + " - " + pair.second, fixed(pair.difference.mean, 4), interval_text(pair.difference, 4),
               p_text(pair.p) + (pair.is_exact ? "" : "~"), p_text(pair.adjusted_p)});
  const auto is_near = [](const MethodPair& pair) { return !pair.is_exact; };
  const bool any_near = std::any_of(comparison.tests.begin(), comparison.tests.end(), is_near);
  return table.str() + (any_near ? "~ by the normal approximation: more than 50 pairs, or ties\n" : "");
}

std::string levels_text(const MethodComparison& comparison) {
  std::vector<std::string> header = {"level", "pairs"};
  header.insert(header.end(), comparison.methods.begin(), comparison.methods.end());
  TextTable table(header);
  std::vector<std::string> row;
  int pairs = 0;
  for (const LevelMean& mean : comparison.levels) {
    if (row.empty() || row.front() != mean.level) {
      if (!row.empty()) table.add(row);
      row.assign(header.size(), "");
      row[0] = mean.level;
      pairs = 0;
    }
    pairs = std::max(mean.pairs, pairs);
    row[1] = std::to_string(pairs);
    const auto column = std::find(header.begin() + 2, header.end(), mean.method) - header.begin();
    row[static_cast<std::size_t>(column)] =
        fixed(mean.mean.mean, 2) + " " + fixed(mean.mean.low, 2) + ".." + fixed(mean.mean.high, 2);
  }
  if (!row.empty()) table.add(row);
  return table.str();
}

std::string to_text(const MethodComparison& comparison, const Measure& measure) {
  std::string text = comparison.experiment + ": " + measure.word() + " on " + std::to_string(comparison.pairs) +
                     (comparison.pairs == 1 ? " pair" : " pairs") +
                     " (all levels; empty selections count as 0, pairs without correct matches are left out)\n";
  if (comparison.means.empty()) return text + "nothing to compare\n\n";
  return text + means_text(comparison) + "\n" + tests_text(comparison, measure) +
         "\nBy level, with the 95 % interval\n" + levels_text(comparison) + "\n";
}

int compare(const Settings& settings) {
  const Measure& measure = metric_of(settings.metric);
  std::vector<MethodComparison> comparisons;
  std::string names;
  for (const ExperimentTable& table : experiment_tables(read_study(settings.run))) {
    names += (names.empty() ? "" : ", ") + table.info.name;
    if (settings.experiment.empty() || settings.experiment == table.info.name)
      comparisons.push_back(compare_methods(table, measure, workers(0)));
  }
  if (comparisons.empty() && !settings.experiment.empty())
    throw UsageError("--experiment " + settings.experiment + ": the study has " + (names.empty() ? "none" : names));
  Json json = Json::array();
  std::string text;
  for (const MethodComparison& comparison : comparisons) {
    json.push_back(to_json(comparison));
    text += to_text(comparison, measure);
  }
  if (settings.json)
    put("", Json{{"metric", settings.metric}, {"experiments", json}});
  else
    put("", text);
  return kOk;
}

}  // namespace

void add_compare(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("compare", "Which differences between the groupers of a study are more than chance");
  auto settings = std::make_shared<Settings>();
  command->add_option("study", settings->run, "Folder of 'corral evaluate'")->type_name("STUDY")->required();
  command->add_option("--metric", settings->metric, "What to compare by (success: refined mean error of at most 5 pr)")
      ->check(CLI::IsMember(metric_names()))
      ->capture_default_str();
  command->add_option("--experiment", settings->experiment, "Only this one")->type_name("NAME");
  command->add_flag("--json", settings->json, "As JSON");
  command->footer(
      "Means with bootstrap intervals over pairs, Friedman's test and average ranks with Nemenyi's critical\n"
      "difference, and for every two groupers Wilcoxon's signed-rank test (McNemar's for success) with Holm's\n"
      "adjustment.\n"
      "Examples:\n  corral compare runs/all --metric precision\n"
      "  corral compare runs/all --metric success --experiment noise --json");
  command->callback([settings, &action] { action = [settings] { return compare(*settings); }; });
}

}  // namespace corral
