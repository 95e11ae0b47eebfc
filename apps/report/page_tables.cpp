// SPDX-License-Identifier: MIT
#include "apps/report/page_tables.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>

#include "apps/report/figure/method_style.h"
#include "apps/runtime/json.h"
#include "io/csv_file.h"
#include "io/file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

std::string path_in(const RunFolder& run, const std::string& name) {
  return (std::filesystem::path(run.folder) / name).string();
}

/// Five digits are more than a page can show.
Json rounded(const std::optional<double>& value) {
  if (!value || !std::isfinite(*value)) return nullptr;
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.5g", *value);
  return *parse_double(digits);
}

/// The manifest without what the page shows elsewhere, or is too long for it.
Json facts_of(const RunFolder& run) {
  const std::string path = path_in(run, "manifest.json");
  try {
    const Json manifest = Json::parse(read_file(path));
    Json facts = Json::object();
    for (const auto& [name, value] : manifest.items())
      if (name != "experiments" && name != "pairs")
        facts[name] = compact_json(value).size() > 4000
                          ? Json(std::to_string(value.size()) + " entries, see manifest.json")
                          : value;
    return facts;
  } catch (const Json::exception& error) {
    throw IoError(path, "", std::string("not the manifest of a run: ") + error.what());
  }
}

/// The rows that belong to the experiment: names of level and method, the rest as numbers.
Json means_of(const ExperimentInfo& experiment, const std::string& path, const CsvTable& summary) {
  Json means = Json::array();
  const auto cell = [&](std::size_t row, const char* name) {
    return summary.rows[row][static_cast<std::size_t>(summary.column(name))];
  };
  for (std::size_t row = 0; row < summary.rows.size(); ++row) {
    if (cell(row, "experiment") != experiment.name) continue;
    Json mean = {{"level", cell(row, "level")}, {"method", cell(row, "method")}};
    for (std::size_t column = 0; column < summary.header.size(); ++column) {
      const std::string &name = summary.header[column], &text = summary.rows[row][column];
      if (mean.contains(name) || name == "experiment" || name == "dataset") continue;
      const auto number = parse_double(text);
      if (!text.empty() && !number)
        throw IoError(path, "row " + std::to_string(row + 1), "the " + name + " '" + text + "' is no number");
      mean[name] = rounded(number);
    }
    means.push_back(mean);
  }
  return means;
}

/// The means of a study, or the times of a run that took nothing else.
CsvTable means_table(const RunFolder& run, std::string& path) {
  path = path_in(run, "summary.csv");
  std::vector<std::string> columns = {"experiment", "level",  "method", "pairs",
                                      "precision",  "recall", "f1",     "success_5pr"};
  if (!std::filesystem::exists(path) && std::filesystem::exists(path_in(run, "time.csv"))) {
    path = path_in(run, "time.csv");
    columns = {"experiment", "level", "method", "runs", "median_ms"};
  }
  CsvTable table = read_csv(path);
  for (const std::string& name : columns)
    if (table.column(name) < 0) throw IoError(path, "header", "the column " + name + " is missing");
  return table;
}

Json experiments_of(const RunFolder& run, int number) {
  std::string path;
  const CsvTable summary = means_table(run, path);
  Json experiments = Json::array();
  for (const ExperimentInfo& experiment : run.experiments) {
    Json levels = Json::array(), bounds = Json::array();
    for (const StudyLevel& level : experiment.levels) levels.push_back(level.label);
    for (const StudyRecord& record : run.records)
      if (record.experiment == experiment.name && is_bound(record.method) &&
          std::find(bounds.begin(), bounds.end(), record.method) == bounds.end())
        bounds.push_back(record.method);
    experiments.push_back({{"run", number},
                           {"name", experiment.name},
                           {"title", experiment.title},
                           {"figure", experiment.figure},
                           {"dataset", experiment.dataset},
                           {"attribute", experiment.attribute},
                           {"axis", experiment.axis},
                           {"levels", levels},
                           {"methods", experiment.methods},
                           {"bounds", bounds},
                           {"threshold_pr", rounded(experiment.threshold_pr)},
                           {"least_true_matches", experiment.least_true_matches},
                           {"means", means_of(experiment, path, summary)}});
  }
  return experiments;
}

/// Names that stand in many records, each once.
class Words {
 public:
  int number(const std::string& word) {
    const auto [place, is_new] = numbers_.emplace(word, static_cast<int>(words_.size()));
    if (is_new) words_.push_back(word);
    return place->second;
  }
  const std::vector<std::string>& list() const { return words_; }

 private:
  std::map<std::string, int> numbers_;
  std::vector<std::string> words_;
};

Json whole(const std::optional<int>& value) { return value ? Json(*value) : Json(nullptr); }

void add_record(Json& columns, Words& words, int run, const StudyRecord& record) {
  columns["run"].push_back(run);
  for (const auto& [name, word] : {std::pair<const char*, const std::string*>{"experiment", &record.experiment},
                                   {"dataset", &record.dataset},
                                   {"level", &record.level},
                                   {"pair", &record.pair},
                                   {"method", &record.method},
                                   {"status", &record.status},
                                   {"selection", &record.selection}})
    columns[name].push_back(words.number(*word));
  columns["repeat"].push_back(record.repeat);
  columns["matches"].push_back(whole(record.matches));
  columns["true_matches"].push_back(whole(record.true_matches));
  columns["selected"].push_back(whole(record.selected));
  columns["correct"].push_back(whole(record.correct));
  columns["precision"].push_back(rounded(record.precision));
  columns["recall"].push_back(rounded(record.recall));
  columns["f1"].push_back(rounded(record.f1));
  columns["initial_mean_error_pr"].push_back(rounded(record.initial.mean_error_pr));
  columns["refined_mean_error_pr"].push_back(rounded(record.refined.mean_error_pr));
  columns["dense_mean_error_pr"].push_back(rounded(record.dense.mean_error_pr));
  columns["rotation_error_deg"].push_back(rounded(record.refined.rotation_error_deg));
  columns["translation_error_pr"].push_back(rounded(record.refined.translation_error_pr));
  columns["time_ms"].push_back(rounded(record.time_ms));
}

/// How each method looks in the figures.
Json styles_of(const std::vector<RunFolder>& runs) {
  std::vector<std::string> methods = {"oracle", "floor"};
  for (const RunFolder& run : runs)
    for (const ExperimentInfo& experiment : run.experiments)
      methods.insert(methods.end(), experiment.methods.begin(), experiment.methods.end());
  Json styles = Json::object();
  for (const auto& [method, style] : method_styles(methods))
    styles[method] = {{"label", style.label}, {"color", style.color}, {"point", style.point}, {"dash", style.dash}};
  return styles;
}

}  // namespace

Json page_tables(const std::vector<RunFolder>& runs) {
  Json folders = Json::array(), experiments = Json::array(), columns = Json::object();
  Words words;
  for (std::size_t number = 0; number < runs.size(); ++number) {
    const RunFolder& run = runs[number];
    const std::string name = std::filesystem::path(run.folder).lexically_normal().filename().string();
    folders.push_back({{"folder", name.empty() ? run.folder : name}, {"facts", facts_of(run)}});
    for (const Json& experiment : experiments_of(run, static_cast<int>(number))) experiments.push_back(experiment);
    for (const StudyRecord& record : run.records) add_record(columns, words, static_cast<int>(number), record);
  }
  return {{"runs", folders},
          {"experiments", experiments},
          {"styles", styles_of(runs)},
          {"words", words.list()},
          {"records", columns}};
}

}  // namespace corral
