// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/pair/match_pair.h"
#include "kernel/evaluation.h"
#include "kernel/options.h"
#include "kernel/rigid_transform.h"

namespace corral {

using Json = nlohmann::ordered_json;  // keys stay in the order of the documentation

template <class Value>
Json json_or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json to_json(const RigidTransform& transform);  ///< four rows of four
Json to_json(const MatchReport& report);
Json to_json(const MatchSettings& settings);  ///< what results depend on
Json to_json(const GroupingScore& score);
Json to_json(const std::vector<OptionValue>& options);  ///< name -> value
Json typed(const std::string& value);                   ///< a bool, a number or else the text itself

/// The stage report in words, for stderr.
std::string stage_report(const MatchReport& report);

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

/// Indented, on lines of its own; bytes that are no UTF-8 (file names may hold any) are replaced.
std::string json_text(const Json& json);

/// Writes to the file, or to stdout if no file is named.
void put(const std::string& path, const std::string& text);
void put(const std::string& path, const Json& json);
/// A line of talk on stderr.
void say(const std::string& line);

}  // namespace corral
