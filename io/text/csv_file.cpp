// SPDX-License-Identifier: MIT
#include "io/text/csv_file.h"

#include <algorithm>
#include <set>

#include "io/disk/file.h"
#include "kernel/error.h"

namespace corral {

CsvReader::CsvReader(const std::string& path, std::string_view text) : reader_(path, text, '#') {
  if (text.empty()) throw IoError(path, "", "the file is empty, expected a header line");
  reader_.need("a header line");
  split();
  header_ = cells_;
  std::set<std::string> names;
  for (const std::string& name : header_) {
    if (name.empty()) reader_.fail("a column without a name");
    if (!names.insert(name).second) reader_.fail("the column " + quoted(name) + " occurs twice");
  }
}

bool CsvReader::next() {
  if (!reader_.next()) return false;
  split();
  if (cells_.size() != header_.size())
    reader_.fail("found " + std::to_string(cells_.size()) + " cells, expected " + std::to_string(header_.size()) +
                 " as in the header");
  return true;
}

/// The cells keep their memory from line to line.
void CsvReader::split() {
  const std::string_view line = reader_.line();
  std::size_t count = 0;
  const auto add_cell = [&] {
    if (cells_.size() == count) cells_.emplace_back();
    cells_[count++].clear();
  };
  add_cell();
  for (std::size_t at = 0; at < line.size(); ++at) {
    std::string& cell = cells_[count - 1];
    if (line[at] == ',') {
      add_cell();
    } else if (line[at] != '"') {
      cell += line[at];
    } else {
      if (!cell.empty()) reader_.fail("a quote inside a cell, expected quotes around the whole cell");
      while (true) {
        if (++at >= line.size()) reader_.fail("a quote without an end");
        if (line[at] != '"')
          cell += line[at];
        else if (at + 1 < line.size() && line[at + 1] == '"')
          cell += line[at++];
        else
          break;
      }
      if (at + 1 < line.size() && line[at + 1] != ',') reader_.fail("text after a closing quote, expected a comma");
    }
  }
  cells_.resize(count);
}

int CsvTable::column(const std::string& name) const {
  const auto found = std::find(header.begin(), header.end(), name);
  return found == header.end() ? -1 : static_cast<int>(found - header.begin());
}

CsvTable read_csv(const std::string& path) { return parse_csv(path, read_file(path)); }

CsvTable parse_csv(const std::string& path, const std::string& text) {
  CsvReader reader(path, text);
  CsvTable table{reader.header(), {}};
  while (reader.next()) table.rows.push_back(reader.cells());
  return table;
}

std::string csv_line(const std::vector<std::string>& cells) {
  std::string line;
  for (const std::string& cell : cells) {
    bool is_plain = cell.empty() || cell[0] != '#';
    for (const char letter : cell) {
      if (letter == '\r' || letter == '\n')
        throw InvalidInput("csv_line", "cell", quoted(cell), "text without a line break");
      is_plain = is_plain && letter != ',' && letter != '"' && letter != ' ' && letter != '\t';
    }
    if (&cell != &cells.front()) line += ',';
    if (is_plain) {
      line += cell;
      continue;
    }
    line += '"';
    for (const char letter : cell) line.append(letter == '"' ? 2 : 1, letter);
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
