// SPDX-License-Identifier: MIT
#include "apps/experiment/level_table.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numeric>
#include <set>
#include <tuple>

#include "apps/experiment/statistics.h"
#include "io/line_reader.h"
#include "kernel/error.h"

namespace corral {
namespace {

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

template <class Value>
double number(const std::optional<Value>& value) {
  return value ? static_cast<double>(*value) : kAbsent;
}

/// A row of a level: a pair at a value of the swept attribute, so that one pair may give tables of several sizes.
using RowKey = std::tuple<std::string, double>;
RowKey row_key(const StudyRecord& record) { return {record.pair, record.value.value_or(0)}; }

/// Where a record belongs.
struct Place {
  std::size_t experiment, level, row;
};

/// The experiments with their levels, and a place for each record.
struct Layout {
  std::vector<ExperimentTable> tables;
  std::vector<Place> places;
};

Layout lay_out(const RunFolder& run) {
  Layout layout;
  std::map<std::pair<std::string, std::string>, std::pair<std::size_t, std::size_t>> levels;
  for (const ExperimentInfo& info : run.experiments) {
    ExperimentTable& table = layout.tables.emplace_back();
    table.info = info;
    for (const StudyLevel& level : info.levels) {
      levels[{info.name, level.label}] = {layout.tables.size() - 1, table.levels.size()};
      table.levels.emplace_back().level = level;
    }
  }
  std::map<std::tuple<std::size_t, std::size_t, RowKey>, std::size_t> rows;
  for (const StudyRecord& record : run.records) {
    const auto found = levels.find({record.experiment, record.level});
    if (found == levels.end())
      throw IoError((std::filesystem::path(run.folder) / "records.csv").string(), "",
                    "experiment " + corral::quoted(record.experiment) + " at level " + corral::quoted(record.level) +
                        " is not in manifest.json");
    const auto [experiment, level_index] = found->second;
    LevelTable& level = layout.tables[experiment].levels[level_index];
    const auto [row, is_new] = rows.try_emplace({experiment, level_index, row_key(record)}, level.pairs.size());
    if (is_new) {
      level.pairs.push_back(record.pair);
      for (RowNumbers* column :
           {&level.value, &level.matches, &level.true_matches, &level.inlier_ratio, &level.frame_share})
        column->push_back(kAbsent);
    }
    layout.places.push_back({experiment, level_index, row->second});
  }
  return layout;
}

/// What all methods share.
void fill_row(LevelTable& level, std::size_t row, const StudyRecord& record) {
  const auto fill = [&](RowNumbers& column, double value) {
    if (!std::isnan(value)) column[row] = value;
  };
  fill(level.value, number(record.value));
  fill(level.matches, number(record.matches));
  fill(level.true_matches, number(record.true_matches));
  fill(level.frame_share, number(record.frame_share));
  if (record.matches && record.true_matches && *record.matches > 0)
    fill(level.inlier_ratio, number(record.true_matches) / number(record.matches));
}

void count_rows(LevelTable& level, int least_true_matches) {
  for (const double true_matches : level.true_matches) {
    const bool failed = std::isnan(true_matches), excluded = true_matches < std::max(1, least_true_matches);
    level.failed += failed;
    level.excluded += excluded;
    level.counts.push_back(!failed && !excluded);
  }
}

std::vector<RowNumbers*> columns_of(MethodColumns& columns) {
  return {&columns.precision, &columns.recall,  &columns.f1,      &columns.nonempty_precision,
          &columns.selected,  &columns.correct, &columns.success, &columns.time_ms};
}

/// In the order of columns_of.
std::vector<double> numbers_of(const StudyRecord& record, bool counts) {
  std::vector<double> numbers(8, kAbsent);
  if (counts)
    numbers = {record.precision.value_or(0),
               record.recall.value_or(0),
               record.f1.value_or(0),
               number(record.precision),
               static_cast<double>(record.selected.value_or(0)),
               static_cast<double>(record.correct.value_or(0)),
               record.refined.rmse_pr && *record.refined.rmse_pr <= kSuccessPr ? 1.0 : 0.0,
               kAbsent};
  numbers.back() = number(record.time_ms);
  return numbers;
}

/// Sums over repeats and, of each number, how many there were.
struct RepeatSums {
  std::vector<RowNumbers> sums, seen;
  std::set<std::size_t> empty;
};

MethodColumns mean_columns(const RepeatSums& repeats) {
  MethodColumns columns;
  const std::vector<RowNumbers*> list = columns_of(columns);
  for (std::size_t i = 0; i < list.size(); ++i)
    for (std::size_t row = 0; row < repeats.sums[i].size(); ++row)
      list[i]->push_back(repeats.seen[i][row] > 0 ? repeats.sums[i][row] / repeats.seen[i][row] : kAbsent);
  columns.empty = static_cast<int>(repeats.empty.size());
  return columns;
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

int LevelTable::counted() const { return std::accumulate(counts.begin(), counts.end(), 0); }

std::vector<ExperimentTable> experiment_tables(const RunFolder& run) {
  Layout layout = lay_out(run);
  for (std::size_t i = 0; i < run.records.size(); ++i) {
    const Place& place = layout.places[i];
    fill_row(layout.tables[place.experiment].levels[place.level], place.row, run.records[i]);
  }
  for (ExperimentTable& table : layout.tables)
    for (LevelTable& level : table.levels) count_rows(level, table.info.least_true_matches);

  std::map<std::tuple<std::size_t, std::size_t, std::string>, RepeatSums> sums;
  for (std::size_t i = 0; i < run.records.size(); ++i) {
    const StudyRecord& record = run.records[i];
    const Place& place = layout.places[i];
    const LevelTable& level = layout.tables[place.experiment].levels[place.level];
    RepeatSums& repeats = sums[{place.experiment, place.level, record.method}];
    const bool counts = level.counts[place.row] != 0;
    const std::vector<double> numbers = numbers_of(record, counts);
    repeats.sums.resize(numbers.size(), RowNumbers(level.pairs.size(), 0.0));
    repeats.seen.resize(numbers.size(), RowNumbers(level.pairs.size(), 0.0));
    for (std::size_t j = 0; j < numbers.size(); ++j) {
      if (std::isnan(numbers[j])) continue;
      repeats.sums[j][place.row] += numbers[j];
      repeats.seen[j][place.row] += 1;
    }
    if (counts && record.selected.value_or(0) == 0) repeats.empty.insert(place.row);
  }
  for (const auto& [key, repeats] : sums) {
    const auto& [experiment, level, method] = key;
    layout.tables[experiment].levels[level].methods[method] = mean_columns(repeats);
  }
  return std::move(layout.tables);
}

double mean_of(const RowNumbers& column) {
  double sum = 0;
  int seen = 0;
  for (const double value : column) {
    if (std::isnan(value)) continue;
    sum += value;
    ++seen;
  }
  return seen > 0 ? sum / seen : kAbsent;
}

double mean_of(const RowNumbers& column, const std::vector<int>& rows) {
  double sum = 0;
  int seen = 0;
  for (const int row : rows) {
    const double value = column[static_cast<std::size_t>(row)];
    if (std::isnan(value)) continue;
    sum += value;
    ++seen;
  }
  return seen > 0 ? sum / seen : kAbsent;
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

double pooled_precision(const LevelTable& level, const std::string& method) {
  const MethodColumns& columns = level.methods.at(method);
  double correct = 0, selected = 0;
  for (std::size_t row = 0; row < level.pairs.size(); ++row) {
    if (std::isnan(columns.selected[row])) continue;
    correct += columns.correct[row];
    selected += columns.selected[row];
  }
  return selected > 0 ? correct / selected : kAbsent;
}

double pooled_recall(const LevelTable& level, const std::string& method) {
  const MethodColumns& columns = level.methods.at(method);
  double correct = 0, true_matches = 0;
  for (std::size_t row = 0; row < level.pairs.size(); ++row) {
    if (std::isnan(columns.correct[row])) continue;
    correct += columns.correct[row];
    true_matches += level.true_matches[row];
  }
  return true_matches > 0 ? correct / true_matches : kAbsent;
}

std::vector<RowNumbers> selection_agreement(const RunFolder& run, const ExperimentTable& table,
                                            const std::vector<std::string>& methods) {
  std::map<std::tuple<std::string, RowKey>, std::string> files;  // by level and row
  for (const StudyRecord& record : run.records)
    if (record.experiment == table.info.name && !record.selection.empty())
      files[{record.level, row_key(record)}] = (std::filesystem::path(run.folder) / record.selection).string();
  std::map<std::string, double> known;
  std::vector<RowNumbers> agreements;
  for (const LevelTable& level : table.levels) {
    RowNumbers& column = agreements.emplace_back();
    for (std::size_t row = 0; row < level.pairs.size(); ++row) {
      const double value = std::isnan(level.value[row]) ? 0 : level.value[row];
      const auto file = files.find({level.level.label, RowKey{level.pairs[row], value}});
      column.push_back(kAbsent);
      if (file == files.end()) continue;
      const auto [entry, is_new] = known.try_emplace(file->second, kAbsent);
      if (is_new && std::filesystem::exists(file->second))
        entry->second = agreement(read_selections(file->second), methods);
      column.back() = entry->second;
    }
  }
  return agreements;
}

}  // namespace corral
