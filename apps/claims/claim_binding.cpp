// SPDX-License-Identifier: MIT
// The levels and columns that the numbers of a rule come from, or why there are none.
#include <algorithm>
#include <cmath>
#include <map>

#include "apps/claims/claim_measure.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

const RowNumbers* column_of_pairs(const LevelSource& source, const Quantity& quantity) {
  if (quantity.kind == Quantity::Kind::Value) return &source.table->value;
  if (quantity.kind == Quantity::Kind::Agreement) return &source.agreement;
  if (quantity.kind == Quantity::Kind::KeypointDensity) return &source.keypoints;
  return source.table->column(*quantity.measure, "");
}

}  // namespace

ClaimMeasure::ClaimMeasure(const ClaimBook& book, const ClaimPart& part, const ClaimData& data,
                           const Averaging& averaging)
    : book_(book), part_(part), averaging_(averaging) {
  for (const std::string& experiment : part.experiments) experiments_.push_back(bind(data, experiment));
  for (const std::string& experiment : part.with) with_.push_back(bind(data, experiment));
  if (reason_.empty()) require_levels();
  if (reason_.empty() && part.take == Take::LeastStep) bind_partners();
}

ClaimMeasure::Levels ClaimMeasure::bind(const ClaimData& data, const std::string& experiment) {
  const auto found = data.find(experiment);
  if (found == data.end()) {
    if (reason_.empty()) reason_ = "no experiment " + experiment + " in the study";
    return {};
  }
  Levels levels;
  for (const LevelSource& source : found->second) {
    const StudyLevel& level = source.table->level;
    if (!is_within(level, part_.from, part_.to)) continue;
    Level bound{&source, {}, {}, {}};
    bind_columns(bound);
    if (is_usable(bound)) levels.push_back(bound);
  }
  if (levels.empty() && reason_.empty()) {
    const bool is_limited = std::isfinite(part_.from) || std::isfinite(part_.to);
    reason_ = "no level of " + experiment +
              (is_limited ? " from " + to_text(part_.from) + " to " + to_text(part_.to) : std::string()) +
              (part_.of.is_time() || part_.over_pairs ? std::string(" was measured")
                                                      : " has " + std::to_string(book_.least_pairs) + " pairs");
  }
  return levels;
}

void ClaimMeasure::bind_columns(Level& level) const {
  const LevelTable& table = *level.source->table;
  if (part_.of.is_of_pairs()) {
    const RowNumbers* column = column_of_pairs(*level.source, part_.of);
    level.columns = {column->size() == table.pairs.size() ? column : nullptr};
    level.ratios = {{{level.columns, {}}}};
    return;
  }
  const bool halves = averaging_.half_sum && part_.of.is_measure("f1");
  for (const std::string& method : book_.methods) {
    level.columns.push_back(table.column(halves ? measure("precision") : *part_.of.measure, method));
    level.ratios.push_back(ratios_of(table, method));
  }
}

std::vector<ClaimMeasure::Ratio> ClaimMeasure::ratios_of(const LevelTable& table, const std::string& method) const {
  const auto column = [&](const char* name) { return table.column(measure(name), method); };
  const bool is_precision = part_.of.is_measure("precision"), is_recall = part_.of.is_measure("recall"),
             is_f1 = part_.of.is_measure("f1");
  if (averaging_.pooled && (is_precision || is_recall || is_f1)) {
    const RowNumbers *correct = column("correct"), *selected = column("selected"), *right = column("true_matches");
    const Ratio precision{{correct}, {selected}}, recall{{correct}, {right}};
    if (is_f1)
      return averaging_.half_sum ? std::vector{precision, recall}
                                 : std::vector{Ratio{{correct, correct}, {selected, right}}};
    return {is_precision ? precision : recall};
  }
  const char* const precision = averaging_.leave_out_empty ? "precision_nonempty" : "precision";
  if (is_f1 && averaging_.half_sum) return {{{column(precision)}, {}}, {{column("recall")}, {}}};
  return {{{is_precision ? column(precision) : table.column(*part_.of.measure, method)}, {}}};
}

bool ClaimMeasure::is_usable(const Level& level) const {
  const LevelTable& table = *level.source->table;
  if (part_.of.is_time())  // of a table of some size; how many pairs made it does not matter
    return std::any_of(level.columns.begin(), level.columns.end(),
                       [](const RowNumbers* column) { return column && present_in(*column) > 0; });
  if (part_.over_pairs) return !table.pairs.empty();  // they ask for enough pairs in all
  if (level.columns.size() == 1) return level.columns[0] && present_in(*level.columns[0]) >= book_.least_pairs;
  return table.count(PairRole::Judged) >= book_.least_pairs;
}

void ClaimMeasure::require_levels() {
  const Levels& levels = experiments_.front();
  const std::string& name = part_.experiments.front();
  if (part_.over_pairs) return;  // they ask for enough pairs in all
  const bool is_trend = part_.take == Take::Spearman || part_.take == Take::Slope;
  const bool is_series = is_trend || part_.take == Take::Range || part_.take == Take::LargestRise ||
                         part_.take == Take::LargestFall || part_.take == Take::LeastStep;
  const std::size_t needed = is_trend ? 3 : is_series ? 2 : 1;
  if (levels.size() < needed)
    reason_ = name + " has " + std::to_string(levels.size()) + " usable levels, " + std::to_string(needed) + " needed";
  if (!with_.empty() || (part_.take != Take::Rise && part_.take != Take::RelativeDrop)) return;
  for (const Range& range : {part_.first, part_.last})
    if (range && within(levels, range, false).empty())
      reason_ = "no level of " + name + " from " + to_text(range->first) + " to " + to_text(range->second) + " has " +
                std::to_string(book_.least_pairs) + " pairs";
  if ((!part_.first || !part_.last) && levels.size() < 2) reason_ = name + " has only one usable level";
}

void ClaimMeasure::bind_partners() {
  Levels& levels = experiments_.front();
  for (std::size_t i = 0; i + 1 < levels.size(); ++i) {
    std::map<std::string, int> rows;
    const std::vector<std::string>& next = levels[i + 1].source->table->pairs;
    for (std::size_t row = 0; row < next.size(); ++row) rows.emplace(next[row], static_cast<int>(row));
    for (const std::string& pair : levels[i].source->table->pairs) {
      const auto found = rows.find(pair);
      levels[i].partners.push_back(found == rows.end() ? -1 : found->second);
    }
  }
}

}  // namespace corral
