// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace corral {

/// A table of text cells under a header, as comma-separated values.
struct CsvTable {
  std::vector<std::string> header;             ///< the names of the columns, each once
  std::vector<std::vector<std::string>> rows;  ///< each as long as the header

  int column(const std::string& name) const;  ///< -1 if there is none of that name
};

/// Reads a table: one line per row, cells between commas; a cell in double quotes may hold commas, and doubled quotes. Lines
/// that begin with # are skipped. Throws IoError naming file and line: no header, a column twice, a ragged row, a quote
/// without an end.
CsvTable read_csv(const std::string& path);
/// The same for text in memory; `path` is used in messages.
CsvTable parse_csv(const std::string& path, const std::string& text);

/// The same as text, cells in quotes where they need them; reading it back gives the same table. Throws InvalidInput for a
/// cell with a line break.
std::string csv_text(const CsvTable& table);
/// One row, with its line break.
std::string csv_line(const std::vector<std::string>& cells);

}  // namespace corral
