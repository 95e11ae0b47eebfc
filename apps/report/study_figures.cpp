// SPDX-License-Identifier: MIT
#include "apps/report/study_figures.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "io/csv_file.h"
#include "kernel/error.h"
#include "kernel/evaluation.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

/// A column of summary.csv that becomes a panel.
struct Measure {
  std::string column, name, axis;
  bool of_pose = false;  ///< then the bounds stand beside the methods
};

const std::vector<Measure> kMeasures = {
    {"precision", "precision", "precision"},
    {"recall", "recall", "recall"},
    {"f1", "f1", "F1"},
    {"success_5pr", "success", "aligned within 5 pr", true},
    {"initial_success_5pr", "initial-success", "aligned within 5 pr, unrefined", true},
    {"dense_success_5pr", "dense-success", "aligned within 5 pr, dense", true}};

/// The rows of a summary that belong to one experiment.
class Summary {
 public:
  Summary(const std::string& path, const CsvTable& table, const ExperimentInfo& info) : path_(path), table_(table) {
    const std::vector<std::string> first = {"experiment", "dataset", "level", "method"};
    if (table.header.size() < 4 || !std::equal(first.begin(), first.end(), table.header.begin()))
      throw IoError(path, "header", "expected experiment,dataset,level,method and the means");
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
      const auto& cells = table.rows[row];
      if (cells[0] == info.name && cells[1] == info.dataset) rows_[{cells[2], cells[3]}] = row;
    }
  }

  bool has(const std::string& column) const { return table_.column(column) >= 0; }

  std::string text(const std::string& level, const std::string& method, const std::string& column) const {
    const auto row = rows_.find({level, method});
    const int place = table_.column(column);
    return row == rows_.end() || place < 0 ? "" : table_.rows[row->second][static_cast<std::size_t>(place)];
  }

  std::optional<double> number(const std::string& level, const std::string& method, const std::string& column) const {
    const std::string cell = text(level, method, column);
    if (cell.empty()) return std::nullopt;
    const auto value = parse_double(cell);
    if (!value) throw IoError(path_, column, "found '" + cell + "', expected a number or nothing");
    return value;
  }

 private:
  const std::string& path_;
  const CsvTable& table_;
  std::map<std::pair<std::string, std::string>, std::size_t> rows_;
};

Panel empty_panel(const ExperimentInfo& info, const std::string& measure) {
  Panel panel;
  panel.name = file_name_part(info.name) + "-" + file_name_part(info.dataset) + "-" + measure;
  panel.title = (info.figure.empty() ? "" : "(" + info.figure + ") ") + info.title + ", " + info.dataset;
  panel.x_axis = info.axis;
  for (const StudyLevel& level : info.levels) panel.levels.push_back(level.label);
  return panel;
}

std::vector<std::string> methods_of(const ExperimentInfo& info, bool with_bounds) {
  std::vector<std::string> methods = info.methods;
  if (with_bounds) methods.insert(methods.end(), {"oracle", "floor"});
  return methods;
}

bool has_value(const PanelSeries& series) {
  return std::any_of(series.values.begin(), series.values.end(), [](const PanelValue& value) { return value.value; });
}

/// Drops bounds, or everything, without a value; true if anything is left.
bool keep_drawn(Panel& panel) {
  const auto is_empty_bound = [](const PanelSeries& series) { return is_bound(series.method) && !has_value(series); };
  panel.series.erase(std::remove_if(panel.series.begin(), panel.series.end(), is_empty_bound), panel.series.end());
  return std::any_of(panel.series.begin(), panel.series.end(), has_value);
}

std::string pairs_note(const ExperimentInfo& info) {
  return "Means over pairs. An empty selection counts as 0, a missing pose as a failure. Excluded: pairs with fewer "
         "true matches than " +
         std::to_string(info.least_true_matches) + ", for all methods.";
}

Panel level_panel(const ExperimentInfo& info, const Summary& summary, const Measure& measure) {
  Panel panel = empty_panel(info, measure.name);
  panel.y_axis = measure.axis;
  panel.note = pairs_note(info);
  PanelCount empty{"empty", {}}, pairs{"pairs", {}}, excluded{"excluded", {}};
  for (const std::string& method : methods_of(info, measure.of_pose)) {
    PanelSeries series{method, {}};
    double count = 0;
    for (const std::string& level : panel.levels) {
      series.values.push_back({summary.number(level, method, measure.column),
                               summary.number(level, method, measure.column + "_low"),
                               summary.number(level, method, measure.column + "_high")});
      count += summary.number(level, method, "empty").value_or(0);
    }
    panel.series.push_back(series);
    empty.cells.push_back(to_text(count));
  }
  for (const std::string& level : panel.levels)
    if (!info.methods.empty()) {
      pairs.cells.push_back(summary.text(level, info.methods[0], "pairs"));
      excluded.cells.push_back(summary.text(level, info.methods[0], "excluded"));
    }
  panel.level_counts = {pairs, excluded};
  if (!measure.of_pose) panel.series_counts = {empty};
  return panel;
}

/// The records that the means of an experiment are over, by method.
std::map<std::string, std::vector<const StudyRecord*>> counted_records(const RunFolder& run,
                                                                       const ExperimentInfo& info) {
  std::map<std::string, std::vector<const StudyRecord*>> counted;
  for (const StudyRecord& record : run.records)
    if (record.experiment == info.name && record.dataset == info.dataset && record.matches &&
        record.true_matches.value_or(-1) >= info.least_true_matches)
      counted[record.method].push_back(&record);
  return counted;
}

void add_distributions(const RunFolder& run, const ExperimentInfo& info, StudyFigures& figures) {
  const auto records = counted_records(run, info);
  Panel curve = empty_panel(info, "success-curve");
  curve.axes = PanelAxes::Curve;
  curve.x_axis = "mean error at most (pr)";
  curve.y_axis = "share of pairs";
  curve.note = "Refined poses over the pairs of all levels; a missing pose is a failure.";
  curve.levels.clear();
  for (const double threshold : success_thresholds_pr()) curve.levels.push_back(to_text(threshold));
  BoxPanel boxes{empty_panel(info, "mean-error").name, curve.title, "mean error (pr), no pose at the top", {}};
  for (const std::string& method : methods_of(info, true)) {
    const auto found = records.find(method);
    if (found == records.end()) continue;
    std::vector<std::optional<double>> errors;
    for (const StudyRecord* record : found->second) errors.push_back(record->refined.mean_error_pr);
    boxes.boxes.push_back(box_of(method, errors));
    PanelSeries series{method, {}};
    for (const double share : success_curve(errors, success_thresholds_pr())) series.values.push_back({share, {}, {}});
    curve.series.push_back(series);
  }
  const auto has_pose = [](const Box& box) { return box.without < box.pairs; };
  if (std::none_of(boxes.boxes.begin(), boxes.boxes.end(), has_pose)) return;
  figures.panels.push_back(curve);
  figures.boxes.push_back(boxes);
}

/// Median times with their quartiles.
Panel time_panel(const RunFolder& run, const ExperimentInfo& info) {
  Panel panel = empty_panel(info, "time");
  panel.axes = PanelAxes::Logarithmic;
  panel.y_axis = "time (ms)";
  panel.note = "Median wall time of the grouping alone, one thread.";
  std::map<std::pair<std::string, std::string>, std::vector<std::optional<double>>> times;
  for (const StudyRecord& record : run.records)
    if (record.experiment == info.name && record.dataset == info.dataset && record.time_ms)
      times[{record.method, record.level}].push_back(record.time_ms);
  for (const std::string& method : info.methods) {
    PanelSeries series{method, {}};
    for (const std::string& level : panel.levels) {
      const Box box = box_of(method, times[{method, level}]);
      series.values.push_back({box.quantiles[2], box.quantiles[1], box.quantiles[3]});
    }
    panel.series.push_back(series);
  }
  return panel;
}

}  // namespace

std::string file_name_part(const std::string& text) {
  std::string part = text;
  for (char& character : part)
    if (std::isalnum(static_cast<unsigned char>(character)) == 0 &&
        std::string("._+").find(character) == std::string::npos)
      character = '_';
  return part;
}

StudyFigures study_figures(const std::vector<RunFolder>& runs) {
  StudyFigures figures;
  std::set<std::string> names;
  for (const RunFolder& run : runs) {
    const std::string path = (std::filesystem::path(run.folder) / "summary.csv").string();
    std::optional<CsvTable> table;  // a run that only takes times has none
    for (const ExperimentInfo& info : run.experiments) {
      if (!names.insert(empty_panel(info, "").name).second)
        throw IoError(run.folder, "", "experiment " + info.name + " on " + info.dataset + " stands in another run too");
      if (info.attribute == "table_size") {
        Panel panel = time_panel(run, info);
        if (keep_drawn(panel)) figures.panels.push_back(panel);
        continue;
      }
      if (!table) table = read_csv(path);
      const Summary summary(path, *table, info);
      for (const Measure& measure : kMeasures) {
        if (!summary.has(measure.column)) continue;
        Panel panel = level_panel(info, summary, measure);
        if (keep_drawn(panel)) figures.panels.push_back(panel);
      }
      add_distributions(run, info, figures);
    }
  }
  return figures;
}

}  // namespace corral
