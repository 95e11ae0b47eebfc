// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "io/text/line_reader.h"

namespace corral {

/// A table of text cells under a header, as comma-separated values.
struct CsvTable {
  std::vector<std::string> header;             ///< the names of the columns, each once
  std::vector<std::vector<std::string>> rows;  ///< each as long as the header

  int column(const std::string& name) const;  ///< -1 if there is none of that name
};

/// Reads a table row by row: one line per row, cells between commas; a cell in double quotes may hold commas, and doubled
/// quotes. Lines that begin with # are skipped. Throws IoError naming file and line: no header, a column twice, a ragged row,
/// a quote without an end.
class CsvReader {
 public:
  /// Reads the header. `path`, which is used in messages, and `text` must outlive the reader.
  CsvReader(const std::string& path, std::string_view text);

  const std::vector<std::string>& header() const { return header_; }
  bool next();  ///< moves to the next row; false at the end
  const std::vector<std::string>& cells() const { return cells_; }

 private:
  void split();

  LineReader reader_;
  std::vector<std::string> header_, cells_;
};

/// A whole table. Throws as CsvReader.
CsvTable read_csv(const std::string& path);
/// The same for text in memory; `path` is used in messages.
CsvTable parse_csv(const std::string& path, const std::string& text);

/// The same as text, cells in quotes where they need them; reading it back gives the same table. Throws InvalidInput for a
/// cell with a line break.
std::string csv_text(const CsvTable& table);
/// One row, with its line break.
std::string csv_line(const std::vector<std::string>& cells);

}  // namespace corral
