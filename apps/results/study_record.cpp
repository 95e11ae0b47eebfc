// SPDX-License-Identifier: MIT
#include "apps/results/study_record.h"

#include <cmath>

#include "apps/results/measures.h"
#include "io/csv_file.h"
#include "io/line_reader.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

/// Calls visit(name, field) for what a measure has stored in a record.
template <class Record, class Visitor>
void visit_stored(const Measure& measure, Record& record, Visitor& visit) {
  const Stored& stored = measure.stored;
  if (stored.count) visit(measure.name, record.*stored.count);
  if (stored.number) visit(measure.name, record.*stored.number);
  if (stored.pose) visit(measure.name, record.*stored.pose.*stored.score);
}

/// Calls visit(name, field) for every column of a record, in order: the one list that writing and reading follow.
template <class Record, class Visitor>
void visit_columns(Record& record, Visitor&& visit) {
  visit("experiment", record.experiment);
  visit("dataset", record.dataset);
  visit("level", record.level);
  visit("pair", record.pair);
  visit("method", record.method);
  visit("repeat", record.repeat);
  visit("value", record.value);
  visit("status", record.status);
  visit("truth", record.truth);
  for (const Measure& measure : measures()) visit_stored(measure, record, visit);
  visit("selection", record.selection);
}

std::string cell_text(const std::string& value) { return value; }
std::string cell_text(const MethodStatus& value) { return to_text(value); }
std::string cell_text(int value) { return std::to_string(value); }
std::string cell_text(double value) { return to_text(value); }
template <class Value>
std::string cell_text(const std::optional<Value>& value) {
  return value ? cell_text(*value) : std::string();
}

bool parse_cell(const std::string& cell, std::string& value) {
  value = cell;
  return true;
}
bool parse_cell(const std::string& cell, MethodStatus& value) {
  const auto status = parse_status(cell);
  if (status) value = *status;
  return status.has_value();
}
bool parse_cell(const std::string& cell, int& value) {
  const auto number = parse_int(cell);
  if (!number || *number < 0 || *number > 1'000'000'000) return false;
  value = static_cast<int>(*number);
  return true;
}
bool parse_cell(const std::string& cell, double& value) {
  const auto number = parse_double(cell);
  if (!number || !std::isfinite(*number)) return false;
  value = *number;
  return true;
}
template <class Value>
bool parse_cell(const std::string& cell, std::optional<Value>& value) {
  if (cell.empty()) return true;
  Value present{};
  if (!parse_cell(cell, present)) return false;
  value = present;
  return true;
}

/// The value is that of any attribute.
template <class Value>
bool is_in_range(const std::string&, const Value&) {
  return true;
}
bool is_in_range(const std::string& name, const std::optional<double>& value) {
  return !value || name == "value" || (*value >= 0 && *value <= measure(name).largest);
}

}  // namespace

const std::vector<std::string>& record_columns() {
  static const std::vector<std::string> columns = [] {
    std::vector<std::string> names;
    const StudyRecord record;
    visit_columns(record, [&](const std::string& name, const auto&) { names.push_back(name); });
    return names;
  }();
  return columns;
}

std::string record_line(const StudyRecord& record) {
  std::vector<std::string> cells;
  visit_columns(record, [&](const std::string&, const auto& field) { cells.push_back(cell_text(field)); });
  return csv_line(cells);
}

std::vector<StudyRecord> read_records(const std::string& path) {
  const CsvTable table = read_csv(path);
  for (const std::string& name : record_columns())
    if (table.column(name) < 0) throw IoError(path, "header", "the column " + name + " is missing");
  std::vector<StudyRecord> records;
  for (const auto& cells : table.rows) {
    StudyRecord& record = records.emplace_back();
    visit_columns(record, [&](const std::string& name, auto& field) {
      const std::string& cell = cells[static_cast<std::size_t>(table.column(name))];
      if (!parse_cell(cell, field) || !is_in_range(name, field))
        throw IoError(path, "row " + std::to_string(records.size()),
                      name + " is " + quoted(cell) + ", which is no value of that column");
    });
  }
  return records;
}

}  // namespace corral
