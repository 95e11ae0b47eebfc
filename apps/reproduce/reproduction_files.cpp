// SPDX-License-Identifier: MIT
#include "apps/reproduce/reproduction_files.h"

#include <algorithm>
#include <cmath>

#include "apps/runtime/text_table.h"
#include "io/text/csv_file.h"
#include "io/text/toml_file.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

std::string verdict_of(const CombinationScore& score, std::size_t claim) {
  return verdict_name(score.outcomes[claim].verdict);
}

Json outcome_json(const ClaimOutcome& outcome) {
  const bool is_known = outcome.verdict != Verdict::Undecidable && std::isfinite(outcome.margin);
  return {{"verdict", verdict_name(outcome.verdict)}, {"margin", is_known ? Json(outcome.margin) : Json(nullptr)}};
}

Json counts_json(const JudgedCombination& of) {
  return {{"chosen", of.chosen.holds}, {"held_out", of.held_out.holds}, {"all", of.all.holds}};
}

Json ids_json(const Reproduction& of, const std::vector<int>& claims) {
  Json ids = Json::array();
  for (const int claim : claims) ids.push_back(of.claims[static_cast<std::size_t>(claim)].id);
  return ids;
}

std::vector<int> bound_claims(const Reproduction& of) {
  std::vector<int> claims;
  for (std::size_t claim = 0; claim < of.claims.size(); ++claim)
    if (of.is_bound[claim]) claims.push_back(static_cast<int>(claim));
  return claims;
}

Json points_json(const Reproduction& of) {
  Json points = Json::array();
  for (std::size_t i = 0; i < of.points.size(); ++i) {
    Json readings = Json::array();
    for (const Reading& reading : of.points[i].readings)
      readings.push_back(
          {{"name", reading.name}, {"text", reading.text}, {"from", reading.from}, {"evidence", reading.evidence}});
    points.push_back({{"name", of.points[i].name},
                      {"question", of.points[i].question},
                      {"readings", readings},
                      {"turns", ids_json(of, of.decides[i])}});
  }
  return points;
}

std::string ids_text(const Reproduction& of, const std::vector<int>& claims) {
  std::string text;
  for (const int claim : claims) text += (text.empty() ? "" : " ") + of.claims[static_cast<std::size_t>(claim)].id;
  return text.empty() ? "-" : text;
}

std::string readings_table(const Reproduction& of) {
  TextTable table({"reading", "hold", "turned to hold", "turned to fail"});
  for (const CombinationScore& score : of.alone) {
    std::vector<int> gained, lost;
    for (std::size_t claim = 0; claim < of.claims.size(); ++claim) {
      const bool before = of.alone.front().outcomes[claim].verdict == Verdict::Holds,
                 after = score.outcomes[claim].verdict == Verdict::Holds;
      if (before != after) (after ? gained : lost).push_back(static_cast<int>(claim));
    }
    table.add(
        {to_text(of.points, score.combination), std::to_string(score.holds), ids_text(of, gained), ids_text(of, lost)});
  }
  return table.str();
}

std::string classes_text(const Reproduction& of) {
  std::string text;
  for (const auto kind :
       {StatementClass::Robust, StatementClass::Depends, StatementClass::Never, StatementClass::Undecided}) {
    std::vector<int> claims;
    for (std::size_t claim = 0; claim < of.claims.size(); ++claim)
      if (of.classes[claim] == kind) claims.push_back(static_cast<int>(claim));
    text += class_name(kind) + " (" + std::to_string(claims.size()) + "): " + ids_text(of, claims) + "\n";
  }
  return text;
}

std::size_t most_deciding(const Reproduction& of) {
  const auto fewer = [](const auto& a, const auto& b) { return a.size() < b.size(); };
  return static_cast<std::size_t>(std::max_element(of.decides.begin(), of.decides.end(), fewer) - of.decides.begin());
}

}  // namespace

std::string matrix_csv(const Reproduction& of) {
  std::vector<std::string> cells = {"statement", "class"};
  for (const CombinationScore& score : of.alone) cells.push_back(to_text(of.points, score.combination));
  for (const char* column : {"found", "text, held out", "found, held out", "in words"}) cells.emplace_back(column);
  std::string text = csv_line(cells);
  for (std::size_t claim = 0; claim < of.claims.size(); ++claim) {
    cells = {of.claims[claim].id, class_name(of.classes[claim])};
    for (const CombinationScore& score : of.alone) cells.push_back(verdict_of(score, claim));
    for (const CombinationScore* score : {&of.found.all, &of.text.held_out, &of.found.held_out})
      cells.push_back(verdict_of(*score, claim));
    cells.push_back(of.claims[claim].text);
    text += csv_line(cells);
  }
  return text;
}

Json reproduction_json(const Reproduction& of) {
  Json statements = Json::array(), steps = Json::array(), excluded = Json::array();
  for (std::size_t claim = 0; claim < of.claims.size(); ++claim) {
    Json readings = Json::object();
    for (const CombinationScore& score : of.alone)
      readings[to_text(of.points, score.combination)] = outcome_json(score.outcomes[claim]);
    statements.push_back({{"id", of.claims[claim].id},
                          {"statement", of.claims[claim].text},
                          {"class", class_name(of.classes[claim])},
                          {"holds_in_some_combination", static_cast<bool>(of.is_bound[claim])},
                          {"readings", readings},
                          {"found", outcome_json(of.found.all.outcomes[claim])},
                          {"text_held_out", outcome_json(of.text.held_out.outcomes[claim])},
                          {"found_held_out", outcome_json(of.found.held_out.outcomes[claim])}});
  }
  for (const SearchStep& step : of.steps)
    steps.push_back({{"combination", to_text(of.points, step.score.combination)},
                     {"hold", step.score.holds},
                     {"margin", step.score.margin},
                     {"share_worse", step.share_worse}});
  for (const auto& [a, b] : of.never_together) excluded.push_back(ids_json(of, {a, b}));
  return {{"points", points_json(of)},
          {"statements", statements},
          {"steps", steps},
          {"combination", to_text(of.points, of.found.all.combination)},
          {"text", counts_json(of.text)},
          {"found", counts_json(of.found)},
          {"most_of_any", {{"chosen", of.most_chosen}, {"held_out", of.most_held_out}, {"all", of.most}}},
          {"combinations", of.combinations},
          {"hold_in_some_combination", ids_json(of, bound_claims(of))},
          {"never_together", excluded},
          {"turns_most", of.points[most_deciding(of)].name}};
}

std::string reproduction_text(const Reproduction& of) {
  std::string text = "Each reading alone, on all pairs\n" + readings_table(of) + "\n" + classes_text(of) + "\n";
  TextTable points({"open point", "statements turned", "which"});
  for (std::size_t i = 0; i < of.points.size(); ++i)
    points.add({of.points[i].name, std::to_string(of.decides[i].size()), ids_text(of, of.decides[i])});
  text += points.str() + "\nThe search, on the half of the pairs on which it chooses\n";
  TextTable steps({"combination", "hold", "margins", "fewer in resamples"});
  for (const SearchStep& step : of.steps)
    steps.add({to_text(of.points, step.score.combination), std::to_string(step.score.holds),
               fixed(step.score.margin, 3), fixed(step.share_worse, 2)});
  text += steps.str() + "\n";
  TextTable counts({"statements that hold", "chosen half", "held-out half", "all pairs"});
  for (const auto& [name, judged] :
       {std::pair<const char*, const JudgedCombination*>("text", &of.text), {"found", &of.found}})
    counts.add({name, std::to_string(judged->chosen.holds), std::to_string(judged->held_out.holds),
                std::to_string(judged->all.holds)});
  counts.add(
      {"most of any", std::to_string(of.most_chosen), std::to_string(of.most_held_out), std::to_string(of.most)});
  text += counts.str() + "\n";
  text += std::to_string(bound_claims(of).size()) + " statements hold in at least one of " +
          std::to_string(of.combinations) + " combinations, " + std::to_string(of.never_together.size()) +
          " pairs of these in none together\n";
  return text + "The open point that turns most statements: " + of.points[most_deciding(of)].name + "\n";
}

std::string preset_toml(const Reproduction& of) {
  const ReadingSettings settings = settings_of(of.points, of.found.all.combination);
  std::string text = "# " + to_text(of.points, of.found.all.combination) + "\n";
  if (!settings.options.empty()) text += "[options]\n";
  const auto value_text = [](const std::string& value) {
    return parse_double(value) || value == "true" || value == "false" ? value : toml_text(value);
  };
  for (const auto& [name, options] : settings.options)
    for (const auto& [option, value] : options) text += name + "." + option + " = " + value_text(value) + "\n";
  if (!settings.matching.empty()) text += "\n[matching]\n";
  for (const auto& [key, value] : settings.matching) text += key + " = " + toml_text(value) + "\n";
  return text;
}

}  // namespace corral
