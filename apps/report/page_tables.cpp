// SPDX-License-Identifier: MIT
#include "apps/report/page_tables.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>

#include "apps/report/figure/method_style.h"
#include "apps/results/found_statements.h"
#include "apps/runtime/json.h"
#include "io/disk/file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

std::string path_in(const StudyFolder& run, const std::string& name) {
  return (std::filesystem::path(run.folder) / name).string();
}

/// Five digits are more than a page can show.
Json rounded(const std::optional<double>& value) {
  if (!value || !std::isfinite(*value)) return nullptr;
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.5g", *value);
  return *parse_double(digits);
}

/// The manifest without parts that the page shows elsewhere or that are too long. The order of its entries is that of the file;
/// what is long is not read in order, which would compare each of its names with all before it.
Json facts_of(const StudyFolder& run) {
  const std::string path = path_in(run, "manifest.json");
  try {
    const std::string text = read_file(path);
    const nlohmann::json manifest = nlohmann::json::parse(text);
    std::map<std::string, std::size_t> entries;  // of what is left out
    for (const auto& [name, value] : manifest.items())
      if (name == "experiments" || name == "pairs" ||
          value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace).size() > 4000)
        entries[name] = value.size();
    const auto is_kept = [&](int depth, Json::parse_event_t event, const Json& parsed) {
      return depth > 1 || event != Json::parse_event_t::key || entries.count(parsed.get<std::string>()) == 0;
    };
    Json facts = Json::parse(text, is_kept);
    for (const auto& [name, count] : entries)
      if (name != "experiments" && name != "pairs") facts[name] = std::to_string(count) + " entries, see manifest.json";
    return facts;
  } catch (const Json::exception& error) {
    throw IoError(path, "", std::string("not the manifest of a study: ") + error.what());
  }
}

/// The rows that belong to the experiment: names of level and method, the rest as numbers.
Json means_of(const StudyResults& study, const ExperimentInfo& experiment) {
  Json means = Json::array();
  if (is_of_times(experiment)) {
    for (const TimeRow& row : time_rows(experiment, study.run->records))
      means.push_back({{"level", row.level},
                       {"method", row.method},
                       {"runs", rounded(row.runs)},
                       {"median_ms", rounded(row.median_ms)},
                       {"mean_ms", rounded(row.mean_ms)},
                       {"lower_quartile_ms", rounded(row.lower_quartile_ms)},
                       {"upper_quartile_ms", rounded(row.upper_quartile_ms)}});
    return means;
  }
  for (const SummaryRow& row : study.summary) {
    if (row.experiment != experiment.name) continue;
    Json& mean = means.emplace_back(Json{{"level", row.level}, {"method", row.method}});
    for (const SummaryCell& cell : summary_cells(row))
      mean[cell.name] = rounded(cell.count ? std::optional<double>(*cell.count) : cell.value);
  }
  return means;
}

Json experiments_of(const StudyResults& study, int number) {
  const StudyFolder& run = *study.run;
  Json experiments = Json::array();
  for (const ExperimentInfo& experiment : run.experiments) {
    Json levels = Json::array(), bounds = Json::array();
    for (const StudyLevel& level : experiment.levels) levels.push_back(level.label);
    int failed = 0;
    for (const StudyRecord& record : run.records) {
      if (!(record.experiment == experiment.name)) continue;
      failed += record.status.state == MethodState::Failed;
      if (is_bound(record.method) && std::find(bounds.begin(), bounds.end(), record.method.str()) == bounds.end())
        bounds.push_back(record.method.str());
    }
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
                           {"failed", failed},
                           {"means", means_of(study, experiment)}});
  }
  return experiments;
}

/// Names that occur in many records, each once.
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

bool is_left_out(PairRole role) { return is_excluded(role) || role == PairRole::Misfit; }

void add_record(Json& columns, Words& words, int run, const StudyRecord& record, PairRole role) {
  columns["run"].push_back(run);
  const std::string status = to_text(record.status);
  for (const auto& [name, word] : {std::pair<const char*, const std::string*>{"experiment", &record.experiment.str()},
                                   {"dataset", &record.dataset.str()},
                                   {"level", &record.level.str()},
                                   {"pair", &record.pair.str()},
                                   {"method", &record.method.str()},
                                   {"status", &status},
                                   {"selection", &record.selection.str()}})
    columns[name].push_back(words.number(*word));
  columns["repeat"].push_back(record.repeat);
  columns["excluded"].push_back(is_left_out(role) ? 1 : 0);
  for (const Measure* measure : measures_with(kOnPage)) {
    const std::optional<double> number = measure->of(record);
    columns[measure->name].push_back(measure->stored.count && number ? Json(static_cast<int>(*number))
                                                                     : rounded(number));
  }
}

/// What there is to show: the measures of a mean that has a panel, and those of single records.
Json measures_of() {
  Json shown = Json::array();
  for (const Measure& measure : measures())
    if (measure.has(kHeadline | kOnPage))
      shown.push_back({{"name", measure.name},
                       {"title", measure.title},
                       {"axis", measure.axis_title()},
                       {"unit", measure.unit},
                       {"decimals", measure.decimals},
                       {"panel", measure.has(kHeadline)},
                       {"record", measure.has(kOnPage)}});
  return shown;
}

/// How each method looks in the figures.
Json styles_of(const std::vector<StudyResults>& studies) {
  std::vector<std::string> methods = {"oracle", "baseline"};
  MethodTitles titles;
  for (const StudyResults& study : studies)
    for (const ExperimentInfo& experiment : study.run->experiments) {
      methods.insert(methods.end(), experiment.methods.begin(), experiment.methods.end());
      titles.insert(experiment.titles.begin(), experiment.titles.end());
    }
  Json styles = Json::object();
  for (const auto& [method, style] : method_styles(methods, titles))
    styles[method] = {{"label", style.label}, {"color", style.color}, {"point", style.point}, {"dash", style.dash}};
  return styles;
}

Json share_json(const MethodShare& share) {
  return {{"method", share.method},    {"pairs", share.pairs},        {"success", rounded(share.success)},
          {"low", rounded(share.low)}, {"high", rounded(share.high)}, {"median_ms", rounded(share.median_ms)}};
}

Json choice_of(const SetTable& table) {
  const MethodChoice choice = choose_method(table);
  Json shown = Json::array(), cells = Json::array();
  for (std::size_t i = 0; i < choice.methods.size(); ++i) {
    shown.push_back(share_json(choice.methods[i]));
    shown.back()["front"] = static_cast<bool>(choice.is_on_front[i]);
  }
  for (std::size_t share = 0; share < kCorrectShares.size(); ++share)
    for (std::size_t count = 0; count < kMatchCounts.size(); ++count) {
      const ChoiceCell& cell = choice.cells[share][count];
      if (cell.pairs == 0) continue;
      Json best = Json::array();
      for (const MethodShare& each : cell.best) best.push_back(share_json(each));
      cells.push_back({{"correct", correct_share_text(share)},
                       {"matches", match_count_text(count)},
                       {"pairs", cell.pairs},
                       {"best", best}});
    }
  return {{"dataset", choice.dataset},
          {"pairs", choice.pairs},
          {"methods", shown},
          {"perfect", choice.perfect ? share_json(*choice.perfect) : Json(nullptr)},
          {"cells", cells}};
}

Json found_json(const FoundStatement& found) {
  return {{"text", found.text},        {"dataset", found.dataset},
          {"pairs", found.pairs},      {"margin", rounded(found.margin)},
          {"low", rounded(found.low)}, {"high", rounded(found.high)}};
}

/// By the name of the experiment.
std::map<std::string, int> least_true_matches(const StudyFolder& run) {
  std::map<std::string, int> least;
  for (const ExperimentInfo& experiment : run.experiments) least[experiment.name] = experiment.least_true_matches;
  return least;
}

/// Of all records.
Json totals_of(const std::vector<StudyResults>& studies) {
  std::size_t records = 0, failed = 0, pairs = 0, exclusions = 0;
  for (const StudyResults& study : studies) {
    std::map<std::string, int> least = least_true_matches(*study.run);
    std::set<std::pair<std::string, std::string>> seen;
    std::set<std::tuple<std::string, std::string, std::string>> excluded;
    for (const StudyRecord& record : study.run->records) {
      ++records;
      failed += record.status.state == MethodState::Failed ? 1 : 0;
      seen.emplace(record.dataset, record.pair);
      if (is_left_out(role_of(record, least[record.experiment])))
        excluded.emplace(record.experiment, record.level, record.pair);
    }
    pairs += seen.size();
    exclusions += excluded.size();
  }
  return {{"records", records}, {"pairs", pairs}, {"exclusions", exclusions}, {"failed", failed}};
}

}  // namespace

Json page_tables(const std::vector<StudyResults>& studies, const PageRecords& carried) {
  Json folders = Json::array(), experiments = Json::array(), columns = Json::object();
  Words words;
  for (std::size_t number = 0; number < studies.size(); ++number) {
    const StudyFolder& run = *studies[number].run;
    const std::string name = std::filesystem::path(run.folder).lexically_normal().filename().string();
    folders.push_back({{"folder", name.empty() ? run.folder : name}, {"facts", facts_of(run)}});
    for (const Json& experiment : experiments_of(studies[number], static_cast<int>(number)))
      experiments.push_back(experiment);
    std::map<std::string, int> least = least_true_matches(run);
    for (const StudyRecord* record : carried[number])
      add_record(columns, words, static_cast<int>(number), *record, role_of(*record, least[record->experiment]));
  }
  Json choices = Json::array(), found = Json::array();
  const std::vector<SetTable> sets = set_tables(studies);
  for (const SetTable& set : sets) choices.push_back(choice_of(set));
  for (const FoundStatement& statement : found_statements(sets)) found.push_back(found_json(statement));
  return {{"runs", folders},
          {"experiments", experiments},
          {"measures", measures_of()},
          {"styles", styles_of(studies)},
          {"totals", totals_of(studies)},
          {"choices", choices},
          {"found", found},
          {"words", words.list()},
          {"records", columns}};
}

}  // namespace corral
