// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/runtime/json.h"

namespace corral {

/// Columns of text under a header, numbers to the right; "-" where a cell is empty.
class TextTable {
 public:
  explicit TextTable(std::vector<std::string> header);
  void add(std::vector<std::string> row);
  std::string str() const;
  std::string markdown() const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

/// A column of a table for people: its header, its key in the JSON of a row, and the decimals of its numbers.
struct TableColumn {
  std::string header, key;
  int decimals = 0;
};
std::string table_text(const std::vector<Json>& rows, const std::vector<TableColumn>& columns);

/// A number with so many decimals; empty if absent.
std::string fixed(std::optional<double> value, int decimals);

}  // namespace corral
