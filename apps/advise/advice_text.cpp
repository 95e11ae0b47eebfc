// SPDX-License-Identifier: MIT
#include <cmath>

#include "apps/advise/advise.h"
#include "apps/runtime/text_table.h"

namespace corral {
namespace {

std::string range_text(const std::optional<SampleRange>& spread, int decimals, const std::string& unit) {
  if (!spread) return "";
  const std::string middle = fixed(spread->median, decimals) + unit;
  if (spread->low == spread->high) return middle;
  return middle + " (" + fixed(spread->low, decimals) + " to " + fixed(spread->high, decimals) + ")";
}

std::string facts_text(const Advice& advice) {
  const DataFacts& facts = advice.facts;
  std::string text = std::to_string(facts.sampled) + " of " + std::to_string(facts.pairs) + " pairs tried, " +
                     std::to_string(facts.judged) + " judged " +
                     (advice.by_truth ? "by their truths" : "by poses of 'register' that are sure without a truth") +
                     "\n";
  const auto add = [&](const char* what, const std::string& value) {
    if (!value.empty()) text += "  " + std::string(what) + value + "\n";
  };
  add("points of the source  ", range_text(facts.points, 0, ""));
  add("pr, mesh units        ", range_text(facts.resolution, 4, ""));
  add("matches               ", range_text(facts.matches, 0, ""));
  add("of these correct      ", range_text(facts.correct_percent, 1, " %"));
  add("overlap of the source ", range_text(facts.overlap_percent, 0, " %"));
  add("frames that agree     ", range_text(facts.frames_percent, 0, " % of the correct matches"));
  return text;
}

std::string share_text(const MethodOutcome& method) {
  return std::to_string(method.registered) + " of " + std::to_string(method.pairs) +
         " pairs (95 %: " + fixed(method.low, 2) + " to " + fixed(method.high, 2) + ")";
}

std::string table_of(const Advice& advice) {
  TextTable table({"method", "registers", "low", "high", "precision", "recall", "time ms"});
  constexpr std::size_t kShown = 8;
  for (std::size_t i = 0; i < std::min(kShown, advice.methods.size()); ++i) {
    const MethodOutcome& method = advice.methods[i];
    if (!method.is_affordable) break;
    table.add({method.method, fixed(method.success, 2), fixed(method.low, 2), fixed(method.high, 2),
               fixed(method.precision, 2), fixed(method.recall, 2), fixed(method.median_ms, 1)});
  }
  return table.str();
}

/// What would help more than another grouper.
std::string help_text(const Advice& advice) {
  std::string text;
  if (advice.perfect.pairs > 0) {
    text = "All correct matches alone register " + share_text(advice.perfect);
    text += advice.perfect.registered <= advice.methods.front().registered
                ? ": no other selection of these matches registers more.\n"
                : ".\n";
  }
  for (const OtherMatching& other : advice.others) {
    if (other.registered < other.before || (other.registered == other.before && other.correct_ratio < 1.25)) continue;
    text += "Matched with " + other.name + ", " + std::to_string(other.pairs) + " of the pairs have " +
            fixed(other.correct_ratio, 1) + " times as many correct matches, and it registers " +
            std::to_string(other.registered) + " instead of " + std::to_string(other.before) + " of them.\n";
  }
  return text;
}

Json json_of(const std::optional<SampleRange>& spread) {
  if (!spread) return nullptr;
  return {{"median", spread->median}, {"low", spread->low}, {"high", spread->high}};
}

Json json_of(const MethodOutcome& method) {
  return {{"method", method.method},
          {"registered", method.registered},
          {"pairs", method.pairs},
          {"success", method.success},
          {"low", method.low},
          {"high", method.high},
          {"precision", json_or_null(method.precision)},
          {"recall", json_or_null(method.recall)},
          {"median_ms", json_or_null(method.median_ms)},
          {"affordable", method.is_affordable}};
}

}  // namespace

std::string advice_text(const Advice& advice, const AdviceOptions& options) {
  std::string text = facts_text(advice);
  if (advice.facts.judged == 0)
    return text + "No pair has a truth, or a pose that is sure without one: there is nothing to judge methods by.\n";
  const MethodOutcome& first = advice.methods.front();
  if (!first.is_affordable) return text + "No method stays within " + fixed(options.budget_ms, 1) + " ms.\n";
  text += "\nuse " + first.method + ": it registers " + share_text(first) + ", in " + fixed(first.median_ms, 1) +
          " ms on the median pair\n";
  constexpr int kFew = 5;
  if (first.pairs < kFew)
    text += "that is little to go by: " + std::to_string(first.pairs) + (first.pairs == 1 ? " pair" : " pairs") +
            " could be judged\n";
  const std::vector<std::string> ties = advice.ties();
  if (!ties.empty()) {
    text += "not distinguishable from it on these pairs:";
    for (std::size_t i = 0; i < ties.size(); ++i) text += (i == 0 ? " " : ", ") + ties[i];
    text += "\n";
  }
  return text + "\n" + table_of(advice) + "\n" + help_text(advice);
}

Json to_json(const Advice& advice) {
  const DataFacts& facts = advice.facts;
  Json methods = Json::array(), others = Json::array();
  for (const MethodOutcome& method : advice.methods) methods.push_back(json_of(method));
  for (const OtherMatching& other : advice.others)
    others.push_back({{"name", other.name},
                      {"pairs", other.pairs},
                      {"correct_ratio", other.correct_ratio},
                      {"registered", other.registered},
                      {"registered_before", other.before}});
  const bool has_choice = facts.judged > 0 && advice.methods.front().is_affordable;
  return {{"use", has_choice ? Json(advice.methods.front().method) : Json(nullptr)},
          {"ties", has_choice ? Json(advice.ties()) : Json::array()},
          {"evidence", advice.by_truth ? "truths" : "sure poses of register"},
          {"facts",
           {{"pairs", facts.pairs},
            {"sampled", facts.sampled},
            {"judged", facts.judged},
            {"failures", facts.failures},
            {"points", json_of(facts.points)},
            {"resolution", json_of(facts.resolution)},
            {"matches", json_of(facts.matches)},
            {"correct_percent", json_of(facts.correct_percent)},
            {"overlap_percent", json_of(facts.overlap_percent)},
            {"frames_percent", json_of(facts.frames_percent)}}},
          {"methods", methods},
          {"oracle", json_of(advice.perfect)},
          {"other_matchings", others}};
}

}  // namespace corral
