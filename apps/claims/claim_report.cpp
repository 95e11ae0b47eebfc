// SPDX-License-Identifier: MIT
#include "apps/claims/claim_report.h"
#include "apps/runtime/text_table.h"

#include <algorithm>
#include <cmath>

namespace corral {
namespace {

Json to_json(const PartVerdict& part) {
  const bool decided = part.verdict != Verdict::Undecidable;
  return {{"id", part.id},
          {"verdict", part.is_note ? Json("note") : Json(verdict_name(part.verdict))},
          {"margin", decided && std::isfinite(part.margin) ? Json(part.margin) : Json(nullptr)},
          {"unit", part.unit.name},
          {"levels", part.levels},
          {"reason", part.reason}};
}

Json to_json(const ClaimVerdict& verdict) {
  Json parts = Json::array();
  for (const PartVerdict& part : verdict.parts) parts.push_back(to_json(part));
  return {{"id", verdict.id},
          {"verdict", verdict_name(verdict.verdict)},
          {"weak", verdict.is_weak},
          {"sensitive", verdict.is_sensitive},
          {"changed_in_resamples", verdict.changed},
          {"margin", verdict.margin && std::isfinite(*verdict.margin) ? Json(*verdict.margin) : Json(nullptr)},
          {"unit", verdict.unit.name},
          {"statement", verdict.text},
          {"note", verdict.note},
          {"experiments", verdict.experiments},
          {"figures", verdict.figures},
          {"parts", parts}};
}

std::string words(const ClaimVerdict& verdict) {
  return verdict_name(verdict.verdict) + (verdict.is_weak ? ", weak" : "") +
         (verdict.is_sensitive ? ", sensitive" : "");
}

std::string margin_text(double margin, const MarginUnit& unit) {
  if (!std::isfinite(margin)) return "any";
  return (margin < 0 ? "" : "+") + fixed(margin, unit.decimals) + " " + unit.name;
}

/// References: the panel of each experiment, and why nothing or not everything could be decided.
std::string remarks(const ClaimVerdict& verdict) {
  std::string text;
  for (const PartVerdict& part : verdict.parts) {
    std::string remark = part.reason.empty() ? part.levels : part.reason;
    if (verdict.parts.size() > 1 && part.reason.empty())
      remark = (part.is_note ? "note" : verdict_name(part.verdict) + " by " + margin_text(part.margin, part.unit)) +
               (remark.empty() ? "" : ", " + remark);
    if (remark.empty()) continue;
    text += (text.empty() ? "" : "; ") + (verdict.parts.size() > 1 ? part.id + " " : std::string()) + remark;
  }
  return text + (verdict.note.empty() ? "" : (text.empty() ? "" : "; ") + verdict.note);
}

std::string tally(const std::vector<ClaimVerdict>& verdicts) {
  int counts[3] = {}, weak = 0, sensitive = 0;
  for (const ClaimVerdict& verdict : verdicts) {
    ++counts[static_cast<int>(verdict.verdict)];
    weak += verdict.is_weak;
    sensitive += verdict.is_sensitive;
  }
  return std::to_string(verdicts.size()) + " claims: " + std::to_string(counts[0]) + " hold, " +
         std::to_string(counts[1]) + " fail, " + std::to_string(counts[2]) + " undecidable; " + std::to_string(weak) +
         " weak, " + std::to_string(sensitive) + " sensitive\n";
}

/// Where to look: "noise (a) overlap (e)".
std::string places(const ClaimVerdict& verdict) {
  std::string text;
  for (std::size_t i = 0; i < verdict.experiments.size(); ++i)
    text += (text.empty() ? "" : " ") + verdict.experiments[i] +
            (verdict.figures[i].empty() ? "" : " (" + verdict.figures[i] + ")");
  return text;
}

/// The heading of a claim: its experiment, or several.
std::string group_of(const ClaimVerdict& verdict) {
  return verdict.experiments.size() == 1 ? places(verdict) : "several experiments";
}

std::string group_text(const std::string& group, const std::vector<ClaimVerdict>& verdicts) {
  TextTable table({"claim", "verdict", "margin", "statement"});
  std::string details;
  for (const ClaimVerdict& verdict : verdicts) {
    if (group_of(verdict) != group) continue;
    table.add(
        {verdict.id, words(verdict), verdict.margin ? margin_text(*verdict.margin, verdict.unit) : "", verdict.text});
    std::string detail = remarks(verdict);
    if (verdict.experiments.size() > 1) detail = places(verdict) + (detail.empty() ? "" : "; ") + detail;
    if (!detail.empty()) details += "  " + verdict.id + ": " + detail + "\n";
  }
  return group + "\n" + table.str() + details + "\n";
}

}  // namespace

std::string claims_text(const std::vector<ClaimVerdict>& verdicts, const std::vector<std::string>& slips) {
  std::vector<std::string> groups;
  for (const bool several : {false, true})
    for (const ClaimVerdict& verdict : verdicts)
      if ((verdict.experiments.size() > 1) == several &&
          std::find(groups.begin(), groups.end(), group_of(verdict)) == groups.end())
        groups.push_back(group_of(verdict));
  std::string text;
  for (const std::string& group : groups) text += group_text(group, verdicts);
  text += tally(verdicts);
  text += "weak: more than 20 % of 1000 resamples over pairs differ; sensitive: differs with (P + R) / 2 for F1\n";
  if (!slips.empty()) text += "\nContradictions and slips of the paper, reported but not corrected:\n";
  for (std::size_t i = 0; i < slips.size(); ++i) text += std::to_string(i + 1) + ". " + slips[i] + "\n";
  return text;
}

Json claims_json(const std::vector<ClaimVerdict>& verdicts) {
  Json claims = Json::array();
  for (const ClaimVerdict& verdict : verdicts) claims.push_back(to_json(verdict));
  return claims;
}

}  // namespace corral
