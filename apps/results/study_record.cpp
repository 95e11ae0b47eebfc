// SPDX-License-Identifier: MIT
#include "apps/results/study_record.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "apps/results/measures.h"
#include "io/disk/file.h"
#include "io/text/csv_file.h"
#include "io/text/line_reader.h"
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
  visit("scene", record.scene);
  visit("method", record.method);
  visit("repeat", record.repeat);
  visit("value", record.value);
  visit("status", record.status);
  visit("truth", record.truth);
  for (const Measure& measure : measures()) visit_stored(measure, record, visit);
  visit("selection", record.selection);
}

std::string cell_text(const SharedText& value) { return value; }
std::string cell_text(const MethodStatus& value) { return to_text(value); }
std::string cell_text(int value) { return std::to_string(value); }
std::string cell_text(double value) { return to_text(value); }
template <class Value>
std::string cell_text(const std::optional<Value>& value) {
  return value ? cell_text(*value) : std::string();
}
std::string cell_text(const OptionalNumber& value) { return cell_text(std::optional<double>(value)); }

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

/// Reads the cells of a column of records.csv into records.
class RecordReader {
 public:
  explicit RecordReader(const CsvReader& table, const std::string& path) : path_(path) {
    for (const std::string& name : record_columns()) {
      const auto found = std::find(table.header().begin(), table.header().end(), name);
      if (found == table.header().end()) throw IoError(path, "header", "the column " + name + " is missing");
      const auto is_it = [&](const Measure& measure) { return measure.name == name; };
      const auto measured = std::find_if(measures().begin(), measures().end(), is_it);
      columns_.push_back({static_cast<std::size_t>(found - table.header().begin()),
                          measured == measures().end() ? std::nullopt : std::optional<double>(measured->largest),
                          SharedText()});
    }
  }

  StudyRecord read(const std::vector<std::string>& cells, std::size_t row) {
    StudyRecord record;
    auto column = columns_.begin();
    visit_columns(record, [&](const auto& name, auto& field) {
      const std::string& cell = cells[column->place];
      if (!parse(cell, field, *column))
        throw IoError(path_, "row " + std::to_string(row),
                      name + (" is " + quoted(cell)) + ", which is no value of that column");
      ++column;
    });
    return record;
  }

 private:
  struct Column {
    std::size_t place;              // in the file
    std::optional<double> largest;  // of a measure
    SharedText last;                // of a text: most rows have that of the row before
  };

  bool parse(const std::string& cell, SharedText& field, Column& column) {
    if (!(column.last == cell)) column.last = texts_.emplace(cell, cell).first->second;
    field = column.last;
    return true;
  }
  static bool parse(const std::string& cell, OptionalNumber& field, const Column& column) {
    std::optional<double> number;
    if (!parse_cell(cell, number)) return false;
    field = number;
    return !number || !column.largest || (*number >= 0 && *number <= *column.largest);
  }
  template <class Value>
  static bool parse(const std::string& cell, Value& field, const Column&) {
    return parse_cell(cell, field);
  }

  const std::string& path_;
  std::vector<Column> columns_;
  std::unordered_map<std::string, SharedText> texts_;
};

}  // namespace

const std::vector<std::string>& record_columns() {
  static const std::vector<std::string> columns = [] {
    std::vector<std::string> names;
    const StudyRecord record;
    visit_columns(record, [&](const std::string& name, const auto&) { names.emplace_back(name); });
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
  const std::string text = read_file(path);
  CsvReader table(path, text);
  RecordReader reader(table, path);
  std::vector<StudyRecord> records;
  records.reserve(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')));
  while (table.next()) records.push_back(reader.read(table.cells(), records.size() + 1));
  return records;
}

}  // namespace corral
