// SPDX-License-Identifier: MIT
#include "apps/pair/confidence_file.h"

#include <algorithm>

#include "apps/runtime/embedded_files.h"
#include "io/text/toml_file.h"
#include "kernel/number_text.h"

namespace corral {

const EmbeddedFiles& embedded_confidence();

namespace {

std::string list(const ConfidenceSignals& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "[" : ", ") + to_text(value);
  return text + "]";
}

std::string table_text(const std::string& name, const ConfidenceModel& model) {
  return "\n[" + name + "]\npairs = " + std::to_string(model.pairs) + "\ngroups = " + std::to_string(model.groups) +
         "\nright = " + std::to_string(model.right) + "\nmean = " + list(model.mean) +
         "\ndeviation = " + list(model.deviation) + "\nlow = " + list(model.low) + "\nhigh = " + list(model.high) +
         "\nweight = " + list(model.weight) + "\nbias = " + to_text(model.bias) + "\nslope = " + to_text(model.slope) +
         "\nshift = " + to_text(model.shift) + "\n";
}

ConfidenceModel read_model(const TomlTable& root, const std::string& name) {
  const auto table = root.table(name);
  if (!table) root.fail(name, "expected a table [" + name + "]");
  table->only({"pairs", "groups", "right", "mean", "deviation", "low", "high", "weight", "bias", "slope", "shift"});
  const auto values = [&](const char* key) {
    const std::vector<double> found = table->numbers(key);
    if (found.size() != kSignals) table->fail(key, "expected " + std::to_string(kSignals) + " numbers");
    ConfidenceSignals signals;
    std::copy(found.begin(), found.end(), signals.begin());
    return signals;
  };
  const auto value = [&](const char* key) {
    const auto found = table->number(key);
    if (!found) table->fail(key, "expected a number");
    return *found;
  };
  ConfidenceModel model;
  model.mean = values("mean"), model.deviation = values("deviation"), model.weight = values("weight");
  model.low = values("low"), model.high = values("high");
  model.bias = value("bias"), model.slope = value("slope"), model.shift = value("shift");
  model.pairs = static_cast<int>(value("pairs")), model.groups = static_cast<int>(value("groups"));
  model.right = static_cast<int>(value("right"));
  return model;
}

}  // namespace

std::string confidence_text(const ConfidenceModels& models) {
  std::string names;
  for (const char* name : kSignalNames) names += (names.empty() ? "" : ", ") + std::string(name);
  return "# How probable it is that a pose of 'corral register' is right, by its signals: " + names +
         ".\n# Written by 'corral calibrate'.\n" + table_text("surfaces", models.surfaces) +
         table_text("table", models.table);
}

ConfidenceModels parse_confidence(const std::string& path, const std::string& text) {
  const TomlTable root = TomlTable::parse(path, text);
  root.only({"surfaces", "table"});
  return {read_model(root, "surfaces"), read_model(root, "table")};
}

const ConfidenceModels& built_in_confidence() {
  static const ConfidenceModels models =
      parse_confidence("confidence.toml", embedded_confidence().at("confidence.toml"));
  return models;
}

}  // namespace corral
