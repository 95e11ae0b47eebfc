// SPDX-License-Identifier: MIT
#include "apps/results/summary.h"

#include <cmath>
#include <limits>

#include "apps/results/comparison.h"
#include "io/text/csv_file.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

/// Over the rows that have both: all of one measure among all of another.
double pooled(const LevelTable& level, const std::string& method, const Measure& measure) {
  const RowNumbers& part = *level.column(corral::measure(measure.pooled_of.first), method);
  const RowNumbers& whole = *level.column(corral::measure(measure.pooled_of.second), method);
  double sum = 0, of = 0;
  for (std::size_t row = 0; row < part.size(); ++row) {
    if (std::isnan(part[row]) || std::isnan(whole[row])) continue;
    sum += part[row];
    of += whole[row];
  }
  return of > 0 ? sum / of : kAbsent;
}

/// Of the pairs themselves: over the rows that count.
double judged_mean(const LevelTable& level, RowNumbers column) {
  for (std::size_t row = 0; row < column.size(); ++row)
    if (level.roles[row] != PairRole::Judged) column[row] = kAbsent;
  return mean_of(column);
}

/// Over scenes, each with the mean over its rows.
double mean_over_scenes(const LevelTable& level, const RowNumbers& column) {
  std::map<std::string, RowNumbers> scenes;
  for (std::size_t row = 0; row < column.size(); ++row)
    if (!level.scenes[row].empty()) scenes[level.scenes[row]].push_back(column[row]);
  RowNumbers means;
  for (const auto& [scene, numbers] : scenes) means.push_back(mean_of(numbers));
  return mean_of(means);
}

double average(const LevelTable& level, const std::string& method, const Measure& measure) {
  if (measure.average == Average::Pooled) return pooled(level, method, measure);
  const RowNumbers& column = *level.column(measure, method);
  if (measure.average == Average::Scenes) return mean_over_scenes(level, column);
  if (measure.average == Average::Median) return median_of(column);
  if (measure.average == Average::Quantile75) return quantile_of_present(column, 0.75);
  if (measure.average == Average::Quantile95) return quantile_of_present(column, 0.95);
  return measure.has(kOfPair) ? judged_mean(level, column) : mean_of(column);
}

/// The mean over rows, or what else stands for a level.
void add_values(const std::string& experiment, const LevelTable& level, SummaryRow& row) {
  const std::vector<const Measure*> headline = measures_with(kHeadline);
  const auto means = level_means(experiment, level, row.method, headline);
  for (std::size_t i = 0; i < headline.size(); ++i)
    row.values[headline[i]->name] =
        means[i] ? SummaryValue{means[i]->mean, means[i]->low, means[i]->high} : SummaryValue();
  for (const Measure& measure : measures()) {
    if (measure.average == Average::None || measure.has(kHeadline)) continue;
    const double number = average(level, row.method, measure);
    row.values[measure.name].value = std::isfinite(number) ? std::optional<double>(number) : std::nullopt;  // no pose
  }
}

SummaryRow row_of(const ExperimentInfo& info, const LevelTable& level, const std::string& method) {
  SummaryRow row;
  row.experiment = info.name, row.dataset = info.dataset, row.level = level.level.label, row.method = method;
  row.excluded = level.count(PairRole::Excluded) + level.count(PairRole::Unjudged);
  row.misfit = level.count(PairRole::Misfit);
  row.failed = level.count(PairRole::Failed);
  const auto found = level.methods.find(method);
  if (found == level.methods.end()) return row;
  row.pairs = present_in(found->second.numbers.at("precision"));
  row.empty = found->second.empty;
  row.failed += found->second.failed;
  add_values(info.name, level, row);
  return row;
}

}  // namespace

SummaryValue SummaryRow::of(const std::string& measure) const {
  const auto found = values.find(measure);
  return found == values.end() ? SummaryValue() : found->second;
}

std::vector<SummaryCell> summary_cells(const SummaryRow& row) {
  std::vector<SummaryCell> cells = {
      {"pairs", row.pairs, {}}, {"excluded", row.excluded, {}}, {"misfit", row.misfit, {}}, {"empty", row.empty, {}}};
  const std::vector<const Measure*> headline = measures_with(kHeadline);
  for (const Measure* measure : headline) cells.push_back({measure->name, {}, row.of(measure->name).value});
  cells.push_back({"failed", row.failed, {}});
  for (const Measure& measure : measures())
    if (measure.average != Average::None && !measure.has(kHeadline))
      cells.push_back({measure.name, {}, row.of(measure.name).value});
  for (const Measure* measure : headline) {
    cells.push_back({measure->name + "_low", {}, row.of(measure->name).low});
    cells.push_back({measure->name + "_high", {}, row.of(measure->name).high});
  }
  return cells;
}

std::vector<SummaryRow> summarize(const std::vector<ExperimentTable>& tables, const ParallelFor& parallel_for) {
  struct Place {
    const ExperimentTable* table;
    const LevelTable* level;
    std::string method;
  };
  std::vector<Place> places;
  for (const ExperimentTable& table : tables) {
    std::vector<std::string> methods = table.info.methods;
    methods.insert(methods.end(), {"oracle", "baseline"});
    for (const LevelTable& level : table.levels)
      for (const std::string& method : methods) places.push_back({&table, &level, method});
  }
  std::vector<SummaryRow> rows(places.size());
  parallel_for(static_cast<int>(places.size()), [&](int number) {
    const Place& place = places[static_cast<std::size_t>(number)];
    rows[static_cast<std::size_t>(number)] = row_of(place.table->info, *place.level, place.method);
  });
  return rows;
}

std::string summary_text(const std::vector<SummaryRow>& rows) {
  std::vector<std::string> header = {"experiment", "dataset", "level", "method"};
  for (const SummaryCell& cell : summary_cells({})) header.push_back(cell.name);
  std::string text = csv_line(header);
  for (const SummaryRow& row : rows) {
    std::vector<std::string> cells = {row.experiment, row.dataset, row.level, row.method};
    for (const SummaryCell& cell : summary_cells(row))
      cells.push_back(cell.count ? std::to_string(*cell.count) : cell.value ? to_text(*cell.value) : "");
    text += csv_line(cells);
  }
  return text;
}

}  // namespace corral
