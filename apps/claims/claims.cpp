// SPDX-License-Identifier: MIT
#include "apps/claims/claims.h"

#include <algorithm>
#include <cmath>

#include "apps/claims/claim_rule.h"
#include "apps/results/bootstrap.h"
#include "kernel/error.h"

namespace corral {
namespace {

constexpr double kWeakShare = 0.2;

ClaimStudy study_of(const ClaimBook& book, const std::vector<StudyResults>& studies) {
  ClaimStudy study;
  for (const StudyResults& results : studies)
    for (const ExperimentTable& table : results.tables) {
      if (study.has(table.info.name))
        throw IoError(results.run->folder, "", "the experiment " + table.info.name + " is in another study too");
      study.add(claim_table(book, *results.run, table));
    }
  return study;
}

MarginUnit unit_of(const ClaimPart& part) {
  switch (part.take) {
    case Take::Spearman:
    case Take::Correlation:
      return {"correlation"};
    case Take::Slope:
      return {"slope"};
    case Take::Wins:
      return {"cells", 0};
    case Take::MeanRank:
      return {"ranks"};
    case Take::Count:
      return {"pairs", 0};
    case Take::RelativeDrop:
      return {"share lost"};
    default:
      break;
  }
  if (part.of.kind == Quantity::Kind::Value) return {"of the axis"};
  if (part.of.kind == Quantity::Kind::Agreement) return {"Jaccard"};
  if (part.of.kind == Quantity::Kind::KeypointDensity) return {"keypoints", 0};
  return {(part.of.is_time() ? "ln " : "") + part.of.measure->title};
}

std::string levels_text(const ClaimRule& rule, const std::vector<RuleOutcome>& outcomes) {
  const std::vector<std::string> labels = rule.measure.labels();
  std::string holding;
  int count = 0;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    if (!outcomes[i].holds) continue;
    holding += (count++ == 0 ? ": " : " ") + labels[i];
  }
  return std::to_string(count) + " of " + std::to_string(outcomes.size()) + " levels" + holding;
}

PartVerdict judge_part(const ClaimRule& rule, const Draws& draws) {
  PartVerdict verdict;
  verdict.is_note = rule.part->is_note;
  verdict.reason = rule.measure.reason();
  if (!verdict.reason.empty()) return verdict;
  const RuleOutcome outcome = rule.outcome(draws);
  if (std::isnan(outcome.margin)) {
    verdict.reason = rule.part->over_pairs ? "too few pairs, or their numbers are not in the study"
                                           : "a number is missing: of a grouper, or at a level";
    return verdict;
  }
  verdict.verdict = outcome.holds ? Verdict::Holds : Verdict::Fails;
  verdict.margin = outcome.margin;
  verdict.unit = unit_of(*rule.part);
  if (rule.part->take == Take::EachLevel) verdict.levels = levels_text(rule, rule.levels(draws));
  return verdict;
}

ClaimVerdict judge(const ClaimBook& book, const Claim& claim, const ClaimStudy& study, const Draws& draws) {
  ClaimVerdict verdict;
  verdict.id = claim.id;
  verdict.text = claim.text;
  verdict.note = claim.note;
  const std::vector<ClaimRule> rules = rules_of(book, claim, study.data, {});
  for (std::size_t i = 0; i < rules.size(); ++i) {
    PartVerdict part = judge_part(rules[i], draws);
    part.id = claim.id + (rules.size() > 1 ? std::string(1, static_cast<char>('a' + i)) : std::string());
    if (!part.is_note && part.reason.empty() && (!verdict.margin || part.margin < *verdict.margin)) {
      verdict.margin = part.margin;
      verdict.unit = part.unit;
    }
    verdict.parts.push_back(part);
    std::vector<std::string> names = claim.parts[i].experiments;
    names.insert(names.end(), claim.parts[i].with.begin(), claim.parts[i].with.end());
    for (const std::string& name : names) {
      if (std::find(verdict.experiments.begin(), verdict.experiments.end(), name) != verdict.experiments.end())
        continue;
      verdict.experiments.push_back(name);
      const auto figure = study.figures.find(name);
      verdict.figures.push_back(figure == study.figures.end() ? "" : figure->second);
    }
  }
  verdict.verdict = verdict_of(rules, draws);
  if (verdict.verdict == Verdict::Undecidable) verdict.margin.reset();
  const Averaging half_sum{true, false, false};
  verdict.is_sensitive = verdict_of(rules_of(book, claim, study.data, half_sum), draws) != verdict.verdict;
  return verdict;
}

void count_changes(const ClaimBook& book, const ClaimStudy& study, const ParallelFor& parallel_for,
                   std::vector<ClaimVerdict>& verdicts) {
  std::vector<std::vector<ClaimRule>> rules;
  for (const Claim& claim : book.claims) rules.push_back(rules_of(book, claim, study.data, {}));
  std::vector<std::vector<char>> changed(kResamples, std::vector<char>(rules.size()));
  parallel_for(kResamples, [&](int repeat) {
    const Draws draws = study.resampled(repeat);
    for (std::size_t i = 0; i < rules.size(); ++i)
      if (verdicts[i].verdict != Verdict::Undecidable)
        changed[static_cast<std::size_t>(repeat)][i] = verdict_of(rules[i], draws) != verdicts[i].verdict;
  });
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    const auto count = std::count_if(changed.begin(), changed.end(), [&](const auto& of) { return of[i] != 0; });
    verdicts[i].changed = static_cast<double>(count) / kResamples;
    verdicts[i].is_weak = verdicts[i].changed > kWeakShare;
  }
}

}  // namespace

std::string verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::Holds:
      return "holds";
    case Verdict::Fails:
      return "fails";
    default:
      return "undecidable";
  }
}

std::vector<ClaimVerdict> judge_claims(const ClaimBook& book, const std::vector<StudyResults>& studies,
                                       const ParallelFor& parallel_for) {
  const ClaimStudy study = study_of(book, studies);
  const Draws draws = study.all_rows();
  std::vector<ClaimVerdict> verdicts;
  for (const Claim& claim : book.claims) verdicts.push_back(judge(book, claim, study, draws));
  count_changes(book, study, parallel_for, verdicts);
  return verdicts;
}

}  // namespace corral
