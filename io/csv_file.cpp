// SPDX-License-Identifier: MIT
#include "io/csv_file.h"

#include <algorithm>
#include <set>

#include "io/file.h"
#include "io/line_reader.h"
#include "kernel/error.h"

namespace corral {
namespace {

std::vector<std::string> split_cells(const LineReader& reader) {
  const std::string_view line = reader.line();
  std::vector<std::string> cells(1);
  for (std::size_t at = 0; at < line.size(); ++at) {
    std::string& cell = cells.back();
    if (line[at] == ',') {
      cells.emplace_back();
    } else if (line[at] != '"') {
      cell += line[at];
    } else {
      if (!cell.empty()) reader.fail("a quote inside a cell, expected quotes around the whole cell");
      while (true) {
        if (++at >= line.size()) reader.fail("a quote without an end");
        if (line[at] != '"')
          cell += line[at];
        else if (at + 1 < line.size() && line[at + 1] == '"')
          cell += line[at++];
        else
          break;
      }
      if (at + 1 < line.size() && line[at + 1] != ',') reader.fail("text after a closing quote, expected a comma");
    }
  }
  return cells;
}

}  // namespace

int CsvTable::column(const std::string& name) const {
  const auto found = std::find(header.begin(), header.end(), name);
  return found == header.end() ? -1 : static_cast<int>(found - header.begin());
}

CsvTable read_csv(const std::string& path) { return parse_csv(path, read_file(path)); }

CsvTable parse_csv(const std::string& path, const std::string& text) {
  if (text.empty()) throw IoError(path, "", "the file is empty, expected a header line");
  LineReader reader(path, text, '#');
  reader.need("a header line");
  CsvTable table;
  table.header = split_cells(reader);
  std::set<std::string> names;
  for (const std::string& name : table.header) {
    if (name.empty()) reader.fail("a column without a name");
    if (!names.insert(name).second) reader.fail("the column " + quoted(name) + " occurs twice");
  }
  while (reader.next()) {
    table.rows.push_back(split_cells(reader));
    if (table.rows.back().size() != table.header.size())
      reader.fail("found " + std::to_string(table.rows.back().size()) + " cells, expected " +
                  std::to_string(table.header.size()) + " as in the header");
  }
  return table;
}

std::string csv_line(const std::vector<std::string>& cells) {
  std::string line;
  for (const std::string& cell : cells) {
    if (cell.find_first_of("\r\n") != std::string::npos)
      throw InvalidInput("csv_line", "cell", quoted(cell), "text without a line break");
    if (&cell != &cells.front()) line += ',';
    const bool is_plain = cell.find_first_of(",\"") == std::string::npos && (cell.empty() || cell[0] != '#') &&
                          cell.find_first_of(" \t") == std::string::npos;
    if (is_plain) {
      line += cell;
      continue;
    }
    line += '"';
    for (const char letter : cell) line += letter == '"' ? std::string("\"\"") : std::string(1, letter);
    line += '"';
  }
  if (line.empty()) line = "\"\"";  // a blank line is no row
  return line + "\n";
}

std::string csv_text(const CsvTable& table) {
  std::string text = csv_line(table.header);
  for (const auto& row : table.rows) text += csv_line(row);
  return text;
}

}  // namespace corral
