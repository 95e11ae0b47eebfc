// SPDX-License-Identifier: MIT
#include "io/pairs/dataset_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <sstream>

#include "io/text/csv_file.h"
#include "io/text/line_reader.h"
#include "io/text/toml_file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

const std::vector<std::string> kColumns = {"pair", "source", "target", "truth"};
const char* const kMatches = "matches";

std::string one_of(const TomlTable& table, const std::string& key, const std::string& otherwise,
                   const std::vector<std::string>& values) {
  const std::string value = table.text(key).value_or(otherwise);
  std::string expected;
  for (const std::string& each : values) expected += (expected.empty() ? "" : ", ") + each;
  if (std::find(values.begin(), values.end(), value) == values.end())
    table.fail(key, "found " + corral::quoted(value) + ", expected one of " + expected);
  return value;
}

std::string resolution_rule(const TomlTable& table) {
  const std::string rule = table.scalar_text("resolution").value_or("mean");
  if (rule == "mean" || rule == "source" || rule == "target") return rule;
  const std::optional<double> length = parse_double(rule);
  if (!length || !(*length > 0) || !std::isfinite(*length))
    table.fail("resolution",
               "found " + corral::quoted(rule) + ", expected mean, source, target or a length above zero");
  return rule;
}

bool is_name(const std::string& name) {
  const auto fits = [](unsigned char letter) {
    return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') || (letter >= '0' && letter <= '9') ||
           letter == '.' || letter == '_' || letter == '+' || letter == '-';
  };
  return !name.empty() && name[0] != '.' && std::all_of(name.begin(), name.end(), fits);
}

constexpr char kBetweenTruths = ';';

void split_truths(const std::string& cell, DatasetPair& pair) {
  std::istringstream stream(cell);
  std::getline(stream, pair.truth, kBetweenTruths);
  for (std::string truth; std::getline(stream, truth, kBetweenTruths);)
    if (!truth.empty()) pair.equal_truths.push_back(truth);
}

void read_pairs(const std::string& path, Dataset& dataset) {
  const CsvTable table = read_csv(path);
  int columns[4];
  for (std::size_t i = 0; i < kColumns.size(); ++i) {
    columns[i] = table.column(kColumns[i]);
    if (columns[i] < 0) throw IoError(path, "header", "the column " + kColumns[i] + " is missing");
  }
  const int matches = table.column(kMatches);
  for (const std::string& name : table.header)
    if (name != kMatches && std::find(kColumns.begin(), kColumns.end(), name) == kColumns.end())
      dataset.attributes.push_back(name);
  std::set<std::string> names;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const auto& cells = table.rows[row];
    const auto cell = [&](int i) { return cells[static_cast<std::size_t>(columns[i])]; };
    const std::string place = "pair " + std::to_string(row + 1);
    DatasetPair pair{cell(0), cell(1), cell(2), cell(3), {}};
    split_truths(cell(3), pair);
    if (matches >= 0) pair.matches = cells[static_cast<std::size_t>(matches)];
    if (!is_name(pair.name))
      throw IoError(path, place,
                    "the name " + corral::quoted(pair.name) + ": expected letters, digits and . _ + - only");
    if (!names.insert(pair.name).second)
      throw IoError(path, place, "the name " + corral::quoted(pair.name) + " occurs twice");
    const bool has_neither = pair.source.empty() && pair.target.empty();
    if (has_neither ? pair.matches.empty() : pair.source.empty() || pair.target.empty())
      throw IoError(path, place, "a pair without source or target, expected both, or a table of matches");
    for (const std::string& attribute : dataset.attributes)
      pair.attributes.push_back(cells[static_cast<std::size_t>(table.column(attribute))]);
    dataset.pairs.push_back(std::move(pair));
  }
  if (dataset.pairs.empty()) throw IoError(path, "", "no pairs, expected one line for each");
}

}  // namespace

std::vector<std::string> DatasetPair::files() const {
  std::vector<std::string> all = {source, target, truth, matches};
  all.insert(all.end(), equal_truths.begin(), equal_truths.end());
  return all;
}

DatasetPair Dataset::with_paths(DatasetPair pair) const {
  for (std::string* file : {&pair.source, &pair.target, &pair.truth, &pair.matches})
    if (!file->empty()) *file = path(*file);
  for (std::string& truth : pair.equal_truths) truth = path(truth);
  return pair;
}

std::string Dataset::path(const std::string& file) const {
  return (std::filesystem::path(folder) / file).lexically_normal().string();
}

Dataset read_dataset(const std::string& folder) {
  Dataset dataset;
  dataset.folder = folder;
  const std::string path = dataset.path("dataset.toml");
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored) && std::filesystem::exists(dataset.path(kRecipeName), ignored))
    throw IoError(folder, "", "is unfinished: its manifest is missing; repeat the command that makes it to continue");
  if (!std::filesystem::exists(path, ignored))
    throw IoError(path, "", "does not exist, expected the folder of one data set, with dataset.toml and pairs.csv");
  const TomlTable table = TomlTable::read(path);
  table.only({"name", "kind", "units", "resolution", "provenance", "licence", "citation"});
  if (!table.text("name")) throw IoError(path, "", "the key name is missing, expected name = \"...\"");
  dataset.name = *table.text("name");
  if (!is_name(dataset.name)) table.fail("name", "expected letters, digits and . _ + - only");
  dataset.kind = one_of(table, "kind", "pairs", {"retrieval", "recognition", "registration", "pairs"});
  dataset.units = one_of(table, "units", "unknown", {"mm", "m", "unknown"});
  dataset.resolution = resolution_rule(table);
  dataset.provenance = table.text("provenance").value_or("");
  dataset.licence = table.text("licence").value_or("");
  dataset.citation = table.texts("citation");
  read_pairs(dataset.path("pairs.csv"), dataset);
  return dataset;
}

std::string dataset_toml_text(const Dataset& dataset) {
  std::string text;
  const auto put = [&](const std::string& key, const std::string& value) {
    text += key + " = " + toml_text(value) + "\n";
  };
  put("name", dataset.name);
  put("kind", dataset.kind);
  put("units", dataset.units);
  put("resolution", dataset.resolution);
  put("provenance", dataset.provenance);
  put("licence", dataset.licence);
  text += "citation = [";
  for (const std::string& work : dataset.citation) text += "\n  " + toml_text(work) + ",";
  return text + (dataset.citation.empty() ? "]\n" : "\n]\n");
}

std::string pairs_csv_text(const Dataset& dataset) {
  CsvTable table{kColumns, {}};
  const bool has_matches = std::any_of(dataset.pairs.begin(), dataset.pairs.end(),
                                       [](const DatasetPair& pair) { return !pair.matches.empty(); });
  if (has_matches) table.header.push_back(kMatches);
  table.header.insert(table.header.end(), dataset.attributes.begin(), dataset.attributes.end());
  for (const DatasetPair& pair : dataset.pairs) {
    std::string truths = pair.truth;
    for (const std::string& truth : pair.equal_truths) truths += kBetweenTruths + truth;
    table.rows.push_back({pair.name, pair.source, pair.target, truths});
    if (has_matches) table.rows.back().push_back(pair.matches);
    table.rows.back().insert(table.rows.back().end(), pair.attributes.begin(), pair.attributes.end());
  }
  return csv_text(table);
}

std::string attribute_text(const Dataset& dataset, const DatasetPair& pair, const std::string& attribute) {
  const auto found = std::find(dataset.attributes.begin(), dataset.attributes.end(), attribute);
  return found == dataset.attributes.end()
             ? std::string()
             : pair.attributes[static_cast<std::size_t>(found - dataset.attributes.begin())];
}

std::optional<double> attribute_number(const Dataset& dataset, const DatasetPair& pair, const std::string& attribute) {
  const std::string text = attribute_text(dataset, pair, attribute);
  if (text.empty()) return std::nullopt;
  const std::optional<double> number = parse_double(text);
  if (!number || !std::isfinite(*number))
    throw IoError(dataset.path("pairs.csv"), "pair " + pair.name,
                  attribute + " is " + corral::quoted(text) + ", expected a finite number or nothing");
  return number;
}

std::string scene_of(const Dataset& dataset, const DatasetPair& pair) {
  const auto& columns = dataset.attributes;
  const bool has_scenes = std::find(columns.begin(), columns.end(), "scene") != columns.end();
  return attribute_text(dataset, pair, has_scenes ? "scene" : "object");
}

}  // namespace corral
