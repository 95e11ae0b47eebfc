// SPDX-License-Identifier: MIT
#include "apps/runtime/text_table.h"

#include <algorithm>
#include <cstdio>

#include "kernel/number_text.h"

namespace corral {

TextTable::TextTable(std::vector<std::string> header) { rows_.push_back(std::move(header)); }

void TextTable::add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }

std::string TextTable::str() const {
  const std::size_t columns = rows_.front().size();
  std::vector<std::size_t> widths(columns, 1);
  std::vector<bool> is_text(columns, false);
  for (std::size_t row = 0; row < rows_.size(); ++row)
    for (std::size_t i = 0; i < columns; ++i) {
      const std::string& cell = rows_[row].at(i);
      widths[i] = std::max(widths[i], cell.size());
      if (row > 0 && !cell.empty() && !parse_double(cell)) is_text[i] = true;
    }
  std::string text;
  for (const auto& row : rows_) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string cell = row[i].empty() ? "-" : row[i];
      const std::string space(widths[i] - cell.size(), ' ');
      line += (i > 0 ? "  " : "") + (is_text[i] ? cell + space : space + cell);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

std::string TextTable::markdown() const {
  std::string text;
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    text += "|";
    for (const std::string& cell : rows_[row]) {
      std::string escaped;
      for (const char letter : cell) escaped += letter == '|' ? std::string("\\|") : std::string(1, letter);
      text += " " + escaped + " |";
    }
    text += "\n";
    if (row > 0) continue;
    text += "|";
    for (std::size_t i = 0; i < rows_[0].size(); ++i) text += " --- |";
    text += "\n";
  }
  return text;
}

std::string table_text(const std::vector<Json>& rows, const std::vector<TableColumn>& columns) {
  std::vector<std::string> header;
  for (const TableColumn& column : columns) header.push_back(column.header);
  TextTable table(header);
  for (const Json& row : rows) {
    std::vector<std::string> cells;
    for (const TableColumn& column : columns) {
      const Json& value = row.at(column.key);
      if (value.is_number())
        cells.push_back(fixed(value.get<double>(), column.decimals));
      else
        cells.push_back(value.is_null() ? "" : value.get<std::string>());
    }
    table.add(cells);
  }
  return table.str();
}

std::string fixed(std::optional<double> value, int decimals) {
  if (!value) return "";
  std::string text(static_cast<std::size_t>(std::snprintf(nullptr, 0, "%.*f", decimals, *value)) + 1, '\0');
  std::snprintf(text.data(), text.size(), "%.*f", decimals, *value);
  text.pop_back();
  return text;
}

}  // namespace corral
