// SPDX-License-Identifier: MIT
#include "apps/results/level_table.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <tuple>

#include "apps/results/statistics.h"
#include "io/text/line_reader.h"
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

/// Tells the tables of a pair at a level apart: by the value of the swept attribute and, where that is the same, by their
/// order, as each begins with repeat 0 of a method.
class RowFinder {
 public:
  /// The row of a record at a level; `next` if none has it yet.
  std::size_t row_of(const LevelTable& level, const StudyRecord& record, std::size_t next) {
    Tables& tables = tables_[{&level, record.pair, record.value.value_or(0)}];
    const auto is_it = [&](const auto& count) { return count.first == record.method; };
    auto count = std::find_if(tables.counts.begin(), tables.counts.end(), is_it);
    if (count == tables.counts.end()) count = tables.counts.insert(count, {record.method, 0});
    if (record.repeat == 0 || count->second == 0) ++count->second;
    if (count->second > tables.rows.size()) tables.rows.push_back(next);
    return tables.rows[count->second - 1];
  }

 private:
  /// Those of one pair with one value.
  struct Tables {
    std::vector<std::pair<SharedText, std::size_t>> counts;  // that each method has begun
    std::vector<std::size_t> rows;
  };
  std::map<std::tuple<const LevelTable*, std::string, double>, Tables> tables_;
};

/// What the manifest says of a record's level is looked up once for a run of records.
class LevelFinder {
 public:
  using Place = std::pair<std::size_t, std::size_t>;  // experiment, level

  void add(const std::string& experiment, const std::string& level, const Place& place) {
    places_[{experiment, level}] = place;
  }
  /// Null if there is none.
  const Place* of(const StudyRecord& record) {
    if (last_ && record.experiment == last_->first.first && record.level == last_->first.second) return &last_->second;
    const auto found = places_.find({record.experiment, record.level});
    if (found == places_.end()) return nullptr;
    last_ = &*found;
    return &found->second;
  }

 private:
  using Places = std::map<std::pair<std::string, std::string>, Place>;
  Places places_;
  const Places::value_type* last_ = nullptr;
};

Layout lay_out(const StudyFolder& run) {
  Layout layout;
  LevelFinder levels;
  for (const ExperimentInfo& info : run.experiments) {
    ExperimentTable& table = layout.tables.emplace_back();
    table.info = info;
    for (const StudyLevel& level : info.levels) {
      levels.add(info.name, level.label, {layout.tables.size() - 1, table.levels.size()});
      table.levels.emplace_back().level = level;
      for (const Measure* measure : measures_with(kOfPair)) table.levels.back().of_pairs[measure->name];
    }
  }
  RowFinder rows;
  layout.places.reserve(run.records.size());
  for (const StudyRecord& record : run.records) {
    if (record.level.empty()) continue;
    const LevelFinder::Place* const place = levels.of(record);
    if (!place)
      throw IoError((std::filesystem::path(run.folder) / "records.csv").string(), "",
                    "experiment " + corral::quoted(record.experiment.str()) + " at level " +
                        corral::quoted(record.level.str()) + " is not in manifest.json");
    const auto [experiment, level_index] = *place;
    LevelTable& level = layout.tables[experiment].levels[level_index];
    const std::size_t row = rows.row_of(level, record, level.pairs.size());
    if (row == level.pairs.size()) {
      level.pairs.push_back(record.pair);
      level.scenes.push_back(record.scene);
      level.selections.emplace_back();
      level.roles.push_back(role_of(record, layout.tables[experiment].info.least_true_matches));
      level.value.push_back(kAbsent);
      for (auto& [name, column] : level.of_pairs) column.push_back(kAbsent);
    }
    layout.places.push_back({&record, experiment, level_index, row});
  }
  return layout;
}

/// What all methods share.
void fill_row(LevelTable& level, std::size_t row, const StudyRecord& record,
              const std::vector<const Measure*>& of_pair) {
  if (!record.selection.empty()) level.selections[row] = record.selection;
  if (record.value) level.value[row] = *record.value;
  for (const Measure* measure : of_pair)
    if (const auto number = measure->of(record)) level.of_pairs[measure->name][row] = *number;
}

/// The records of a method at a level: of each row its repeats.
using MethodRecords = std::vector<std::vector<const StudyRecord*>>;

MethodColumns columns_of(const LevelTable& level, const MethodRecords& records) {
  MethodColumns columns;
  for (const Measure& measure : measures()) {
    if (measure.has(kOfPair)) continue;
    RowNumbers& column = columns.numbers[measure.name];
    column.reserve(level.pairs.size());
    RowNumbers numbers;
    for (std::size_t row = 0; row < level.pairs.size(); ++row) {
      numbers.clear();
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

std::vector<ExperimentTable> tabulate(const StudyFolder& run) {
  Layout layout = lay_out(run);
  const auto level_of = [&](const Place& place) -> LevelTable& {
    return layout.tables[place.experiment].levels[place.level];
  };
  const std::vector<const Measure*> of_pair = measures_with(kOfPair);
  for (const Place& place : layout.places) fill_row(level_of(place), place.row, *place.record, of_pair);
  std::map<std::tuple<std::size_t, std::size_t, std::string>, MethodRecords> cells;
  for (const Place& place : layout.places) {
    if (place.record->status.state == MethodState::NotApplicable) continue;  // not tried
    MethodRecords& rows = cells[{place.experiment, place.level, place.record->method}];
    rows.resize(level_of(place).pairs.size());
    rows[place.row].push_back(place.record);
  }
  for (auto& [key, records] : cells) {
    const auto& [experiment, level_index, method] = key;
    LevelTable& level = layout.tables[experiment].levels[level_index];
    level.methods[method] = columns_of(level, records);
    MethodRecords().swap(records);
  }
  return std::move(layout.tables);
}

void add_tried_of(const StudyRecord& record, std::set<std::string>& tried) {
  static const std::vector<const Measure*> if_tried = measures_with(kIfTried);
  if (record.level.empty() || record.status.state == MethodState::NotApplicable) return;
  for (const Measure* measure : if_tried)
    if (measure->of(record)) tried.insert(measure->name);
}

/// Measures that an experiment did not take have no numbers, for failed groupers either.
void leave_out_untried(const std::set<std::string>& tried, ExperimentTable& table) {
  for (const Measure* measure : measures_with(kIfTried)) {
    if (tried.count(measure->name) > 0) continue;
    for (LevelTable& level : table.levels)
      for (auto& [method, columns] : level.methods) {
        RowNumbers& column = columns.numbers.at(measure->name);
        std::fill(column.begin(), column.end(), kAbsent);
      }
  }
}

template <class Value>
void append(std::vector<Value>&& part, std::vector<Value>& whole) {
  whole.insert(whole.end(), std::make_move_iterator(part.begin()), std::make_move_iterator(part.end()));
}

/// Puts the rows of a level behind those that are there.
void append(LevelTable&& part, LevelTable& whole) {
  const std::size_t before = whole.pairs.size(), rows = before + part.pairs.size();
  append(std::move(part.pairs), whole.pairs);
  append(std::move(part.scenes), whole.scenes);
  append(std::move(part.selections), whole.selections);
  append(std::move(part.roles), whole.roles);
  append(std::move(part.value), whole.value);
  for (auto& [name, column] : part.of_pairs) append(std::move(column), whole.of_pairs[name]);
  for (auto& [method, columns] : part.methods) {
    MethodColumns& of_whole = whole.methods[method];
    of_whole.empty += columns.empty;
    of_whole.failed += columns.failed;
    for (auto& [name, column] : columns.numbers) {
      RowNumbers& all = of_whole.numbers[name];
      all.resize(before, kAbsent);
      append(std::move(column), all);
    }
  }
  for (auto& [method, columns] : whole.methods)
    for (auto& [name, column] : columns.numbers) column.resize(rows, kAbsent);  // not in this part
}

}  // namespace

int LevelTable::count(PairRole role) const { return static_cast<int>(std::count(roles.begin(), roles.end(), role)); }

const RowNumbers* LevelTable::column(const Measure& measure, const std::string& method) const {
  if (measure.has(kOfPair)) return &of_pairs.at(measure.name);
  const auto found = methods.find(method);
  return found == methods.end() ? nullptr : &found->second.numbers.at(measure.name);
}

std::vector<ExperimentTable> experiment_tables(const StudyFolder& run) {
  std::vector<ExperimentTable> tables = tabulate(run);
  std::map<std::string, std::set<std::string>> tried;  // by experiment
  for (const StudyRecord& record : run.records) add_tried_of(record, tried[record.experiment]);
  for (ExperimentTable& table : tables) leave_out_untried(tried[table.info.name], table);
  return tables;
}

void add_tried(const std::vector<StudyRecord>& records, std::set<std::string>& tried) {
  for (const StudyRecord& record : records) add_tried_of(record, tried);
}

TableBuilder::TableBuilder(ExperimentInfo info, std::set<std::string> tried)
    : table_(std::move(tabulate({"", {std::move(info)}, {}, {}}).front())), tried_(std::move(tried)) {}

void TableBuilder::add(std::vector<StudyRecord> records) {
  ExperimentTable part = std::move(tabulate({"", {table_.info}, {}, std::move(records)}).front());
  for (std::size_t level = 0; level < table_.levels.size(); ++level)
    append(std::move(part.levels[level]), table_.levels[level]);
}

ExperimentTable TableBuilder::table() && {
  leave_out_untried(tried_, table_);
  return std::move(table_);
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

double quantile_of_present(RowNumbers values, double share) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double value) { return std::isnan(value); }),
               values.end());
  return quantile_of(std::move(values), share);
}

double median_of(RowNumbers values) { return quantile_of_present(std::move(values), 0.5); }

}  // namespace corral
