// SPDX-License-Identifier: MIT
#include "apps/results/level_table.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numeric>
#include <tuple>

#include "apps/pair/evaluate_pair.h"
#include "apps/results/statistics.h"
#include "io/line_reader.h"
#include "kernel/error.h"
#include "kernel/evaluation.h"

namespace corral {
namespace {

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

template <class Value>
double number(const std::optional<Value>& value) {
  return value ? static_cast<double>(*value) : kAbsent;
}

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
      for (RowNumbers* column :
           {&level.value, &level.matches, &level.true_matches, &level.inlier_ratio, &level.frame_share})
        column->push_back(kAbsent);
    }
    layout.places.push_back({&record, experiment, level_index, row->second});
  }
  return layout;
}

/// What all methods share.
void fill_row(LevelTable& level, std::size_t row, const StudyRecord& record) {
  const auto fill = [&](RowNumbers& column, double value) {
    if (!std::isnan(value)) column[row] = value;
  };
  if (!record.selection.empty()) level.selections[row] = record.selection;
  fill(level.value, number(record.value));
  fill(level.matches, number(record.matches));
  fill(level.true_matches, number(record.true_matches));
  fill(level.frame_share, number(record.frame_share));
  if (record.matches && record.true_matches && *record.matches > 0)
    fill(level.inlier_ratio, number(record.true_matches) / number(record.matches));
}

void count_rows(LevelTable& level, int least_true_matches) {
  for (std::size_t row = 0; row < level.pairs.size(); ++row) {
    const bool failed = std::isnan(level.matches[row]);
    const bool excluded = !failed && !(level.true_matches[row] >= std::max(1, least_true_matches));
    level.failed += failed;
    level.excluded += excluded;
    level.counts.push_back(!failed && !excluded);
  }
}

double success_of(const PoseScores& scores) {
  return scores.mean_error_pr && *scores.mean_error_pr <= kSuccessPr ? 1 : 0;
}

double error_of(const std::optional<double>& error) { return error.value_or(std::numeric_limits<double>::infinity()); }

/// A column and the number that a record has for it.
struct Column {
  RowNumbers MethodColumns::*column;
  double (*number)(const StudyRecord& record);
};

const std::vector<Column> kColumns = {
    {&MethodColumns::precision, [](const StudyRecord& record) { return record.precision.value_or(0); }},
    {&MethodColumns::recall, [](const StudyRecord& record) { return record.recall.value_or(0); }},
    {&MethodColumns::f1, [](const StudyRecord& record) { return record.f1.value_or(0); }},
    {&MethodColumns::nonempty_precision, [](const StudyRecord& record) { return number(record.precision); }},
    {&MethodColumns::selected, [](const StudyRecord& record) { return 1.0 * record.selected.value_or(0); }},
    {&MethodColumns::correct, [](const StudyRecord& record) { return 1.0 * record.correct.value_or(0); }},
    {&MethodColumns::success, [](const StudyRecord& record) { return success_of(record.refined); }},
    {&MethodColumns::initial_success, [](const StudyRecord& record) { return success_of(record.initial); }},
    {&MethodColumns::dense_success, [](const StudyRecord& record) { return success_of(record.dense); }},
    {&MethodColumns::success_area,
     [](const StudyRecord& record) { return success_area({record.refined.mean_error_pr}); }},
    {&MethodColumns::rotation_error_deg,
     [](const StudyRecord& record) { return error_of(record.refined.rotation_error_deg); }},
    {&MethodColumns::translation_error_pr,
     [](const StudyRecord& record) { return error_of(record.refined.translation_error_pr); }},
    {&MethodColumns::mean_error_pr, [](const StudyRecord& record) { return error_of(record.refined.mean_error_pr); }},
    {&MethodColumns::time_ms, [](const StudyRecord& record) { return number(record.time_ms); }}};

/// The records of a method at a level: of each row its repeats.
using MethodRecords = std::vector<std::vector<const StudyRecord*>>;

MethodColumns columns_of(const LevelTable& level, const MethodRecords& records) {
  MethodColumns columns;
  for (std::size_t row = 0; row < records.size(); ++row) {
    const std::vector<const StudyRecord*>& repeats = records[row];
    const bool counts = level.counts[row] != 0;
    for (const Column& column : kColumns) {
      RowNumbers numbers;
      if (counts || column.column == &MethodColumns::time_ms)
        for (const StudyRecord* record : repeats) numbers.push_back(column.number(*record));
      (columns.*column.column).push_back(mean_of(numbers));
    }
    const auto any = [&](const auto& is) { return counts && std::any_of(repeats.begin(), repeats.end(), is); };
    columns.empty += any([](const StudyRecord* record) { return record->selected == 0; });
    columns.failed += any([](const StudyRecord* record) { return !record->selected; });
  }
  return columns;
}

/// Where no surface was laid on the other, that is no failure to do so.
void drop_dense(ExperimentTable& table) {
  for (LevelTable& level : table.levels)
    for (auto& [method, columns] : level.methods) columns.dense_success.assign(level.pairs.size(), kAbsent);
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
  const auto level_of = [&](const Place& place) -> LevelTable& {
    return layout.tables[place.experiment].levels[place.level];
  };
  for (const Place& place : layout.places) fill_row(level_of(place), place.row, *place.record);
  std::vector<bool> has_dense(layout.tables.size(), false);
  std::map<std::tuple<std::size_t, std::size_t, std::string>, MethodRecords> cells;
  for (const Place& place : layout.places) {
    MethodRecords& rows = cells[{place.experiment, place.level, place.record->method}];
    rows.resize(level_of(place).pairs.size());
    rows[place.row].push_back(place.record);
    if (place.record->dense.rotation_error_deg) has_dense[place.experiment] = true;
  }
  for (ExperimentTable& table : layout.tables)
    for (LevelTable& level : table.levels) count_rows(level, table.info.least_true_matches);
  for (const auto& [key, records] : cells) {
    LevelTable& level = layout.tables[std::get<0>(key)].levels[std::get<1>(key)];
    level.methods[std::get<2>(key)] = columns_of(level, records);
  }
  for (std::size_t i = 0; i < layout.tables.size(); ++i)
    if (!has_dense[i]) drop_dense(layout.tables[i]);
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
