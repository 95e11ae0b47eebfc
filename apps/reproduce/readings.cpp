// SPDX-License-Identifier: MIT
#include "apps/reproduce/readings.h"

#include <algorithm>

#include "apps/pair/option_names.h"
#include "apps/runtime/embedded_files.h"
#include "grouping/registry.h"
#include "io/text/toml_file.h"

namespace corral {

const EmbeddedFiles& embedded_readings();

namespace {

std::string required(const TomlTable& table, const std::string& key) {
  const std::string text = table.text(key).value_or("");
  if (text.empty()) table.fail(key, "expected " + key + " = \"...\"");
  return text;
}

template <std::size_t N>
std::string one_of(const TomlTable& table, const std::string& key, const std::array<const char*, N>& words,
                   const std::string& otherwise) {
  const std::string word = table.text(key).value_or(otherwise);
  std::string list;
  for (const char* each : words) list += (list.empty() ? "" : " | ") + std::string(each);
  if (std::find(words.begin(), words.end(), word) == words.end())
    table.fail(key, "found " + toml_text(word) + ", expected " + list);
  return word;
}

void read_options(const TomlTable& table, Reading& reading) {
  for (const std::string& name : table.keys()) {
    const auto defaults = default_options(name);
    if (!defaults) table.fail(name, "expected the name of a grouper, detector or descriptor");
    const TomlTable options = table.table(name).value();
    std::vector<std::string> known;
    for (const OptionValue& option : *defaults) known.push_back(option.name);
    options.only(known);
    for (const std::string& option : options.keys())
      reading.options[name][option] = options.scalar_text(option).value_or("");
  }
}

void read_means(const TomlTable& table, Reading& reading) {
  table.only({"f1", "over", "empty", "least_true_matches"});
  reading.averaging.half_sum = one_of(table, "f1", std::array{"harmonic", "half sum"}, "harmonic") == "half sum";
  reading.averaging.pooled = one_of(table, "over", std::array{"pairs", "matches"}, "pairs") == "matches";
  reading.averaging.leave_out_empty = one_of(table, "empty", std::array{"zero", "left out"}, "zero") == "left out";
  reading.least_true_matches = static_cast<int>(table.integer("least_true_matches").value_or(1));
  if (reading.least_true_matches < 1) table.fail("least_true_matches", "expected a number of at least 1");
}

Reading read_reading(const TomlTable& table) {
  table.only({"name", "text", "from", "evidence", "options", "matching", "pairs", "means", "experiments"});
  Reading reading;
  reading.name = required(table, "name");
  reading.text = required(table, "text");
  reading.from = one_of(table, "from", kReadingSources, "");
  reading.evidence = required(table, "evidence");
  if (const auto options = table.table("options")) read_options(*options, reading);
  if (const auto matching = table.table("matching")) {
    matching->only({"resolution", "detector", "normals"});
    for (const std::string& key : matching->keys()) reading.matching[key] = required(*matching, key);
  }
  const std::string form = one_of(table, "pairs", choice_names(PairForm()), "as-stored");
  for (std::size_t i = 0; i < choice_names(PairForm()).size(); ++i)
    if (form == choice_names(PairForm())[i]) reading.pairs = static_cast<PairForm>(i);
  if (const auto means = table.table("means")) read_means(*means, reading);
  reading.experiments = table.texts("experiments");
  return reading;
}

}  // namespace

std::vector<OpenPoint> parse_readings(const std::string& path, const std::string& text) {
  const TomlTable table = TomlTable::parse(path, text);
  table.only({"point"});
  std::vector<OpenPoint> points;
  for (const TomlTable& each : table.tables("point")) {
    each.only({"name", "question", "reading"});
    OpenPoint point{required(each, "name"), required(each, "question"), {}};
    for (const OpenPoint& other : points)
      if (other.name == point.name) each.fail("name", toml_text(point.name) + " occurs twice");
    for (const TomlTable& reading : each.tables("reading")) {
      point.readings.push_back(read_reading(reading));
      for (std::size_t i = 0; i + 1 < point.readings.size(); ++i)
        if (point.readings[i].name == point.readings.back().name)
          reading.fail("name", toml_text(point.readings[i].name) + " occurs twice");
    }
    if (point.readings.empty()) each.fail("reading", "expected [[point.reading]]");
    points.push_back(std::move(point));
  }
  if (points.empty()) table.fail("point", "expected [[point]]");
  return points;
}

std::vector<OpenPoint> built_in_readings() {
  return parse_readings("readings.toml", embedded_readings().at("readings.toml"));
}

std::string to_text(const std::vector<OpenPoint>& points, const Combination& combination) {
  std::string text;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (combination[i] > 0)
      text += (text.empty() ? "" : " ") + points[i].name + "=" +
              points[i].readings[static_cast<std::size_t>(combination[i])].name;
  return text.empty() ? "text" : text;
}

int departures(const Combination& combination) {
  return static_cast<int>(
      std::count_if(combination.begin(), combination.end(), [](int reading) { return reading > 0; }));
}

ReadingSettings settings_of(const std::vector<OpenPoint>& points, const Combination& combination) {
  ReadingSettings settings;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Reading& reading = points[i].readings[static_cast<std::size_t>(combination[i])];
    for (const auto& [name, options] : reading.options)
      for (const auto& [option, value] : options) settings.options[name][option] = value;
    for (const auto& [key, value] : reading.matching) settings.matching[key] = value;
    if (reading.pairs != PairForm::AsStored) settings.pairs = reading.pairs;
    settings.averaging.half_sum |= reading.averaging.half_sum;
    settings.averaging.pooled |= reading.averaging.pooled;
    settings.averaging.leave_out_empty |= reading.averaging.leave_out_empty;
    settings.least_true_matches = std::max(settings.least_true_matches, reading.least_true_matches);
  }
  return settings;
}

bool changes_matches(const Reading& reading) {
  const auto is_of_surfaces = [](const auto& options) { return !look_up(groupers(), options.first); };
  return reading.pairs != PairForm::AsStored || !reading.matching.empty() ||
         std::any_of(reading.options.begin(), reading.options.end(), is_of_surfaces);
}

Combination matching_part(const std::vector<OpenPoint>& points, const Combination& combination,
                          const std::string& experiment) {
  Combination part(combination.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Reading& reading = points[i].readings[static_cast<std::size_t>(combination[i])];
    const auto& touched = reading.experiments;
    const bool is_touched = touched.empty() || std::find(touched.begin(), touched.end(), experiment) != touched.end();
    if (changes_matches(reading) && is_touched) part[i] = combination[i];
  }
  return part;
}

}  // namespace corral
