// SPDX-License-Identifier: MIT
#include "apps/claims/claims.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "apps/claims/claim_measure.h"
#include "apps/results/bootstrap.h"
#include "kernel/error.h"
#include "kernel/random.h"

namespace corral {
namespace {

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();
constexpr double kWeakShare = 0.2;
constexpr std::uint64_t kSeed = 1;

/// The experiments of all runs, and how to draw from their pairs.
struct Study {
  ClaimData data;
  std::vector<std::size_t> sizes;    // rows of each slot
  std::vector<std::uint64_t> seeds;  // of each slot: levels of the same pairs are drawn alike
  std::map<std::string, std::string> figures;
};

bool asks_for(const ClaimBook& book, const std::string& experiment, Quantity::Kind kind) {
  for (const Claim& claim : book.claims)
    for (const ClaimPart& part : claim.parts)
      if (part.of.kind == kind &&
          std::find(part.experiments.begin(), part.experiments.end(), experiment) != part.experiments.end())
        return true;
  return false;
}

/// Keypoints for 100,000 vertices of the source, at the first row of each source.
std::vector<RowNumbers> keypoint_densities(const StudyFolder& run, const ExperimentTable& table) {
  std::set<std::string> seen;
  std::vector<RowNumbers> columns;
  for (const LevelTable& level : table.levels) {
    RowNumbers& column = columns.emplace_back();
    for (const std::string& name : level.pairs) {
      const auto pair = run.pairs.find(table.info.dataset + "/" + name);
      const bool is_known = pair != run.pairs.end() && pair->second.source_points && pair->second.source_keypoints &&
                            *pair->second.source_points > 0 && seen.insert(pair->second.source).second;
      column.push_back(is_known ? 1e5 * *pair->second.source_keypoints / *pair->second.source_points : kAbsent);
    }
  }
  return columns;
}

void add_experiment(Study& study, const ClaimBook& book, const StudyFolder& run, const ExperimentTable& table) {
  const std::string& name = table.info.name;
  if (study.data.count(name)) throw IoError(run.folder, "", "the experiment " + name + " is in another study too");
  study.figures[name] = table.info.figure;
  std::vector<RowNumbers> agreement(table.levels.size()), keypoints(table.levels.size());
  if (asks_for(book, name, Quantity::Kind::Agreement)) agreement = selection_agreement(run, table, book.methods);
  if (asks_for(book, name, Quantity::Kind::KeypointDensity)) keypoints = keypoint_densities(run, table);
  std::vector<LevelSource>& sources = study.data[name];
  for (std::size_t i = 0; i < table.levels.size(); ++i) {
    const LevelTable& level = table.levels[i];
    sources.push_back({&level, study.sizes.size(), agreement[i], keypoints[i]});
    std::uint64_t seed = kSeed;
    for (const std::string& pair : level.pairs) seed = derive_seed(seed, pair);
    study.sizes.push_back(level.pairs.size());
    study.seeds.push_back(seed);
  }
}

Study study_of(const ClaimBook& book, const std::vector<StudyResults>& studies) {
  Study study;
  for (const StudyResults& results : studies)
    for (const ExperimentTable& table : results.tables) add_experiment(study, book, *results.run, table);
  return study;
}

Draws all_rows(const Study& study) {
  Draws draws;
  for (const std::size_t size : study.sizes) {
    draws.emplace_back(size);
    std::iota(draws.back().begin(), draws.back().end(), 0);
  }
  return draws;
}

Draws resampled(const Study& study, int repeat) {
  Draws draws;
  for (std::size_t slot = 0; slot < study.sizes.size(); ++slot) {
    RandomStream stream(derive_seed(study.seeds[slot] + static_cast<std::uint64_t>(repeat), "claims"));
    for (int& row : draws.emplace_back(study.sizes[slot])) row = static_cast<int>(stream.below(study.sizes[slot]));
  }
  return draws;
}

/// A rule and the numbers that it is about.
struct Rule {
  const ClaimPart* part;
  ClaimMeasure measure;

  std::vector<RuleOutcome> levels(const Draws& draws) const {
    std::vector<RuleOutcome> outcomes;
    for (const auto& numbers : measure.numbers(draws))
      outcomes.push_back(test_numbers(*part, numbers, measure.scale()));
    return outcomes;
  }
  RuleOutcome outcome(const Draws& draws) const {
    return test_levels(part->take == Take::EachLevel ? part->where : Quantifier::Every, levels(draws));
  }
  Verdict verdict(const Draws& draws) const {
    if (!measure.reason().empty()) return Verdict::Undecidable;
    const RuleOutcome result = outcome(draws);
    if (std::isnan(result.margin)) return Verdict::Undecidable;
    return result.holds ? Verdict::Holds : Verdict::Fails;
  }
};

std::vector<Rule> rules_of(const ClaimBook& book, const Claim& claim, const ClaimData& data, bool half_sum) {
  std::vector<Rule> rules;
  for (const ClaimPart& part : claim.parts) rules.push_back({&part, ClaimMeasure(book, part, data, half_sum)});
  return rules;
}

Verdict verdict_of(const std::vector<Rule>& rules, const Draws& draws) {
  Verdict all = Verdict::Holds;
  for (const Rule& rule : rules) {
    if (rule.part->is_note) continue;
    const Verdict verdict = rule.verdict(draws);
    if (verdict == Verdict::Fails) return verdict;
    if (verdict == Verdict::Undecidable) all = verdict;
  }
  return all;
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

std::string levels_text(const Rule& rule, const std::vector<RuleOutcome>& outcomes) {
  const std::vector<std::string> labels = rule.measure.labels();
  std::string holding;
  int count = 0;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    if (!outcomes[i].holds) continue;
    holding += (count++ == 0 ? ": " : " ") + labels[i];
  }
  return std::to_string(count) + " of " + std::to_string(outcomes.size()) + " levels" + holding;
}

PartVerdict judge_part(const Rule& rule, const Draws& draws) {
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

ClaimVerdict judge(const ClaimBook& book, const Claim& claim, const Study& study, const Draws& draws) {
  ClaimVerdict verdict;
  verdict.id = claim.id;
  verdict.text = claim.text;
  verdict.note = claim.note;
  const std::vector<Rule> rules = rules_of(book, claim, study.data, false);
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
  verdict.is_sensitive = verdict_of(rules_of(book, claim, study.data, true), draws) != verdict.verdict;
  return verdict;
}

void count_changes(const ClaimBook& book, const Study& study, const ParallelFor& parallel_for,
                   std::vector<ClaimVerdict>& verdicts) {
  std::vector<std::vector<Rule>> rules;
  for (const Claim& claim : book.claims) rules.push_back(rules_of(book, claim, study.data, false));
  std::vector<std::vector<char>> changed(kResamples, std::vector<char>(rules.size()));
  parallel_for(kResamples, [&](int repeat) {
    const Draws draws = resampled(study, repeat);
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
  const Study study = study_of(book, studies);
  const Draws draws = all_rows(study);
  std::vector<ClaimVerdict> verdicts;
  for (const Claim& claim : book.claims) verdicts.push_back(judge(book, claim, study, draws));
  count_changes(book, study, parallel_for, verdicts);
  return verdicts;
}

}  // namespace corral
