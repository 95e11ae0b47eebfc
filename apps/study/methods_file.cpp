// SPDX-License-Identifier: MIT
#include "apps/study/methods_file.h"

#include <algorithm>
#include <filesystem>

#include "grouping/registry.h"
#include "io/text/line_reader.h"
#include "io/text/toml_file.h"
#include "kernel/error.h"

namespace corral {
namespace {

std::string name_of(const TomlTable& table) {
  const std::string name = table.text("name").value_or("");
  if (!is_method_name(name))
    table.fail("name",
               "found " + corral::quoted(name) +
                   ", expected name = \"...\" of letters, digits and . _ + - only, and none that is in every study");
  return name;
}

ForeignMethod method_of(const TomlTable& table, const std::filesystem::path& folder) {
  table.only({"name", "title", "labels", "poses", "times", "time_ms"});
  const auto pattern = [&](const char* key) {
    const std::string text = table.text(key).value_or("");
    return text.empty() ? text : (folder / text).lexically_normal().string();
  };
  ForeignMethod method{name_of(table), "", pattern("labels"), pattern("poses"), pattern("times"), {}};
  method.title = table.text("title").value_or(method.name);
  method.time_ms = table.number("time_ms");
  if (method.labels.empty() && method.poses.empty())
    table.fail("labels", "expected labels = \"...\", poses = \"...\" or both");
  if (method.time_ms && !method.times.empty()) table.fail("time_ms", "expected time_ms or times, not both");
  if (method.time_ms && !(*method.time_ms >= 0)) table.fail("time_ms", "expected a time of at least zero");
  return method;
}

/// The text with what stands in braces replaced.
std::string filled(const std::string& pattern, const Dataset& dataset, const DatasetPair& pair) {
  std::string text;
  std::size_t at = 0;
  for (std::size_t open; (open = pattern.find('{', at)) != std::string::npos;) {
    const std::size_t close = pattern.find('}', open);
    if (close == std::string::npos) break;
    const std::string name = pattern.substr(open + 1, close - open - 1);
    const auto& columns = dataset.attributes;
    if (name != "pair" && name != "dataset" && std::find(columns.begin(), columns.end(), name) == columns.end())
      throw IoError(pattern, "{" + name + "}",
                    "expected {pair}, {dataset} or a column of " + dataset.path("pairs.csv"));
    text += pattern.substr(at, open - at);
    text += name == "pair" ? pair.name : name == "dataset" ? dataset.name : attribute_text(dataset, pair, name);
    at = close + 1;
  }
  return text + pattern.substr(at);
}

}  // namespace

std::vector<ForeignMethod> parse_methods(const std::string& path, const std::string& text) {
  const TomlTable root = TomlTable::parse(path, text);
  root.only({"method"});
  std::vector<ForeignMethod> methods;
  for (const TomlTable& table : root.tables("method")) {
    methods.push_back(method_of(table, std::filesystem::path(path).parent_path()));
    const std::string& name = methods.back().name;
    if (std::count_if(methods.begin(), methods.end(), [&](const ForeignMethod& each) { return each.name == name; }) > 1)
      table.fail("name", name + " occurs twice");
  }
  if (methods.empty()) throw IoError(path, "", "no methods, expected [[method]] with name and labels or poses");
  return methods;
}

ForeignAnswer answer_to(const ForeignMethod& method, const Dataset& dataset, const DatasetPair& pair) {
  return {filled(method.labels, dataset, pair), filled(method.poses, dataset, pair),
          filled(method.times, dataset, pair), method.time_ms};
}

void add_methods(Experiment& experiment, const std::vector<ForeignMethod>& methods) {
  if (methods.empty()) return;
  if (experiment.sweep == Sweep::TableSize)
    throw IoError(experiment.info.name, "", "takes times of groupers alone; expected no methods of other programs");
  for (const ForeignMethod& method : methods) {
    experiment.info.methods.push_back(method.name);
    experiment.info.titles[method.name] = method.title;
    experiment.foreign.push_back(method);
  }
}

}  // namespace corral
