// SPDX-License-Identifier: MIT
#include "apps/results/level_table.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <tuple>

#include "apps/results/statistics.h"
#include "io/line_reader.h"
#include "kernel/error.h"

namespace corral {
namespace {

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

/// A record and where it belongs.
struct Place {
  const StudyRecord* record;
  std::size_t experiment, level, row;
};

/// The experiments with their levels, and a place for each record.
struct Layout {
  std::vector<ExperimentTable> tables;
  std::vector<Place> places;
};

/// Tells the tables of a pair apart: by the value of the swept attribute and, where that is the same, by their order, as
/// each begins with repeat 0 of a method.
class RowKeys {
 public:
  using Key = std::tuple<std::string, std::string, std::string, double, int>;

  Key of(const StudyRecord& record) {
    const double value = record.value.value_or(0);
    int& tables = tables_[{record.experiment, record.level, record.method, record.pair, value}];
    if (record.repeat == 0 || tables == 0) ++tables;
    return {record.experiment, record.level, record.pair, value, tables};
  }

 private:
  std::map<std::tuple<std::string, std::string, std::string, std::string, double>, int> tables_;
};

Layout lay_out(const StudyFolder& run) {
  Layout layout;
  std::map<std::pair<std::string, std::string>, std::pair<std::size_t, std::size_t>> levels;
  for (const ExperimentInfo& info : run.experiments) {
    ExperimentTable& table = layout.tables.emplace_back();
    table.info = info;
    for (const StudyLevel& level : info.levels) {
      levels[{info.name, level.label}] = {layout.tables.size() - 1, table.levels.size()};
      table.levels.emplace_back().level = level;
      for (const Measure* measure : measures_with(kOfPair)) table.levels.back().of_pairs[measure->name];
    }
  }
  RowKeys keys;
  std::map<RowKeys::Key, std::size_t> rows;
  for (const StudyRecord& record : run.records) {
    if (record.level.empty()) continue;
    const auto found = levels.find({record.experiment, record.level});
    if (found == levels.end())
      throw IoError((std::filesystem::path(run.folder) / "records.csv").string(), "",
                    "experiment " + corral::quoted(record.experiment) + " at level " + corral::quoted(record.level) +
                        " is not in manifest.json");
    const auto [experiment, level_index] = found->second;
    LevelTable& level = layout.tables[experiment].levels[level_index];
    const auto [row, is_new] = rows.try_emplace(keys.of(record), level.pairs.size());
    if (is_new) {
      level.pairs.push_back(record.pair);
      level.selections.emplace_back();
      level.roles.push_back(role_of(record, layout.tables[experiment].info.least_true_matches));
      level.value.push_back(kAbsent);
      for (auto& [name, column] : level.of_pairs) column.push_back(kAbsent);
    }
    layout.places.push_back({&record, experiment, level_index, row->second});
  }
  return layout;
}

/// What all methods share.
void fill_row(LevelTable& level, std::size_t row, const StudyRecord& record) {
  if (!record.selection.empty()) level.selections[row] = record.selection;
  if (record.value) level.value[row] = *record.value;
  for (const Measure* measure : measures_with(kOfPair))
    if (const auto number = measure->of(record)) level.of_pairs[measure->name][row] = *number;
}

/// The records of a method at a level: of each row its repeats.
using MethodRecords = std::vector<std::vector<const StudyRecord*>>;

MethodColumns columns_of(const LevelTable& level, const MethodRecords& records, const std::set<std::string>& untried) {
  MethodColumns columns;
  for (const Measure& measure : measures()) {
    if (measure.has(kOfPair)) continue;
    RowNumbers& column = columns.numbers[measure.name];
    for (std::size_t row = 0; row < level.pairs.size(); ++row) {
      RowNumbers numbers;
      if (untried.count(measure.name) == 0)
        for (const StudyRecord* record : records[row])
          numbers.push_back(counted_number(measure, *record, level.roles[row]));
      column.push_back(mean_of(numbers));
    }
  }
  for (std::size_t row = 0; row < records.size(); ++row) {
    const bool is_judged = level.roles[row] == PairRole::Judged,
               is_in = is_judged || level.roles[row] == PairRole::Unjudged;
    const auto any = [&](const auto& is) { return std::any_of(records[row].begin(), records[row].end(), is); };
    columns.empty += is_judged && any([](const StudyRecord* record) { return record->selected == 0; });
    columns.failed += is_in && any([](const StudyRecord* record) { return !record->selected; });
  }
  return columns;
}

/// Of so many numbers, but for those that are none.
template <class Number>
double mean_over(std::size_t count, const Number& number) {
  double sum = 0;
  int seen = 0;
  for (std::size_t i = 0; i < count; ++i)
    if (const double value = number(i); !std::isnan(value)) sum += value, ++seen;
  return seen > 0 ? sum / seen : kAbsent;
}

double jaccard(const Indices& a, const Indices& b) {
  Indices both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  const std::size_t either = a.size() + b.size() - both.size();
  return either > 0 ? static_cast<double>(both.size()) / static_cast<double>(either) : kAbsent;
}

double agreement(const PairSelections& selections, const std::vector<std::string>& methods) {
  RowNumbers indices;
  for (auto a = selections.selected.begin(); a != selections.selected.end(); ++a)
    for (auto b = std::next(a); b != selections.selected.end(); ++b)
      if (std::count(methods.begin(), methods.end(), a->first) && std::count(methods.begin(), methods.end(), b->first))
        indices.push_back(jaccard(a->second, b->second));
  return mean_of(indices);
}

}  // namespace

int LevelTable::count(PairRole role) const { return static_cast<int>(std::count(roles.begin(), roles.end(), role)); }

const RowNumbers* LevelTable::column(const Measure& measure, const std::string& method) const {
  if (measure.has(kOfPair)) return &of_pairs.at(measure.name);
  const auto found = methods.find(method);
  return found == methods.end() ? nullptr : &found->second.numbers.at(measure.name);
}

std::vector<ExperimentTable> experiment_tables(const StudyFolder& run) {
  Layout layout = lay_out(run);
  const auto level_of = [&](const Place& place) -> LevelTable& {
    return layout.tables[place.experiment].levels[place.level];
  };
  for (const Place& place : layout.places) fill_row(level_of(place), place.row, *place.record);
  std::set<std::string> if_tried;
  for (const Measure* measure : measures_with(kIfTried)) if_tried.insert(measure->name);
  std::vector<std::set<std::string>> untried(layout.tables.size(), if_tried);
  std::map<std::tuple<std::size_t, std::size_t, std::string>, MethodRecords> cells;
  for (const Place& place : layout.places) {
    if (place.record->status.state == MethodState::NotApplicable) continue;  // not tried
    MethodRecords& rows = cells[{place.experiment, place.level, place.record->method}];
    rows.resize(level_of(place).pairs.size());
    rows[place.row].push_back(place.record);
    for (const std::string& name : if_tried)
      if (measure(name).of(*place.record)) untried[place.experiment].erase(name);
  }
  for (const auto& [key, records] : cells) {
    const auto& [experiment, level_index, method] = key;
    LevelTable& level = layout.tables[experiment].levels[level_index];
    level.methods[method] = columns_of(level, records, untried[experiment]);
  }
  return std::move(layout.tables);
}

double mean_of(const RowNumbers& column) {
  return mean_over(column.size(), [&](std::size_t i) { return column[i]; });
}

double mean_of(const RowNumbers& column, const std::vector<int>& rows) {
  return mean_over(rows.size(), [&](std::size_t i) { return column[static_cast<std::size_t>(rows[i])]; });
}

int present_in(const RowNumbers& column) {
  return static_cast<int>(std::count_if(column.begin(), column.end(), [](double value) { return !std::isnan(value); }));
}

bool is_within(const StudyLevel& level, double low, double high) {
  constexpr double kRounding = 1e-9;
  return level.low >= low - kRounding && level.high <= high + kRounding;
}

double median_of(RowNumbers values) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double value) { return std::isnan(value); }),
               values.end());
  return quantile_of(std::move(values), 0.5);
}

std::vector<RowNumbers> selection_agreement(const StudyFolder& run, const ExperimentTable& table,
                                            const std::vector<std::string>& methods) {
  std::map<std::string, double> known;
  std::vector<RowNumbers> agreements;
  for (const LevelTable& level : table.levels) {
    RowNumbers& column = agreements.emplace_back();
    for (const std::string& selection : level.selections) {
      const std::string file = (std::filesystem::path(run.folder) / selection).string();
      const auto [entry, is_new] = known.try_emplace(selection, kAbsent);
      if (is_new && !selection.empty() && std::filesystem::exists(file))
        entry->second = agreement(read_selections(file), methods);
      column.push_back(entry->second);
    }
  }
  return agreements;
}

}  // namespace corral
