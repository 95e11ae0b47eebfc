// SPDX-License-Identifier: MIT
#include "apps/report/study_figures.h"

#include <algorithm>
#include <map>
#include <set>

#include "apps/pair/evaluate_pair.h"
#include "apps/report/reliability_figures.h"
#include "kernel/error.h"
#include "kernel/evaluation.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

/// The rows of an experiment in the summary, by level and method.
using SummaryRows = std::map<std::pair<std::string, std::string>, const SummaryRow*>;

SummaryRows rows_of(const StudyResults& study, const ExperimentInfo& info) {
  SummaryRows rows;
  for (const SummaryRow& row : study.summary)
    if (row.experiment == info.name) rows[{row.level, row.method}] = &row;
  return rows;
}

/// The name of a measure as a part of a file name.
std::string file_part(const Measure& measure) {
  std::string part = measure.word();
  std::replace(part.begin(), part.end(), ' ', '-');
  return part;
}

/// Measures that share a figure, from left to right, and its name; any other has a figure of its own.
const std::vector<std::pair<std::string, std::vector<std::string>>> kTogether = {
    {"precision-recall", {"precision", "recall"}}, {"registration", {"initial_success_5pr", "success_5pr"}}};

/// The names of the figures over levels, with their measures.
std::vector<std::pair<std::string, std::vector<const Measure*>>> level_figures() {
  std::vector<std::pair<std::string, std::vector<const Measure*>>> figures;
  for (const Measure* drawn : measures_with(kFigure)) {
    const auto holds = [&](const auto& shared) {
      return std::find(shared.second.begin(), shared.second.end(), drawn->name) != shared.second.end();
    };
    const auto shared = std::find_if(kTogether.begin(), kTogether.end(), holds);
    if (shared == kTogether.end()) {
      figures.push_back({file_part(*drawn), {drawn}});
      continue;
    }
    if (std::any_of(figures.begin(), figures.end(), [&](const auto& made) { return made.first == shared->first; }))
      continue;
    figures.push_back({shared->first, {}});
    for (const std::string& name : shared->second) figures.back().second.push_back(&measure(name));
  }
  return figures;
}

std::string file_name(const ExperimentInfo& info, const std::string& figure) {
  return file_name_part(info.name) + "-" + file_name_part(info.dataset) + "-" + figure;
}

std::string title_of(const ExperimentInfo& info) {
  return (info.figure.empty() ? "" : "(" + info.figure + ") ") + info.title + ", " + info.dataset;
}

Panel empty_panel(const ExperimentInfo& info, const std::string& measure) {
  Panel panel;
  panel.name = file_name(info, measure);
  panel.x_axis = info.axis;
  panel.titles = info.titles;
  for (const StudyLevel& level : info.levels) panel.levels.push_back(level.label);
  return panel;
}

std::vector<std::string> methods_of(const ExperimentInfo& info, bool with_bounds) {
  std::vector<std::string> methods = info.methods;
  if (with_bounds) methods.insert(methods.end(), {"oracle", "baseline"});
  return methods;
}

bool has_value(const PanelSeries& series) {
  return std::any_of(series.values.begin(), series.values.end(), [](const PanelValue& value) { return value.value; });
}

/// Drops series without a value; true if any is left.
bool keep_drawn(Panel& panel) {
  for (auto i = static_cast<std::ptrdiff_t>(panel.series.size()) - 1; i >= 0; --i) {
    if (has_value(panel.series[static_cast<std::size_t>(i)])) continue;
    panel.series.erase(panel.series.begin() + i);
    for (PanelCount& count : panel.series_counts) count.cells.erase(count.cells.begin() + i);
  }
  return !panel.series.empty();
}

std::string pairs_note(const ExperimentInfo& info) {
  return "Means over pairs. An empty selection counts as 0, a missing pose as a failure. Excluded: pairs with fewer "
         "correct matches than " +
         std::to_string(info.least_true_matches) + ", for all groupers.";
}

Panel level_panel(const ExperimentInfo& info, const SummaryRows& rows, const Measure& measure) {
  Panel panel = empty_panel(info, file_part(measure));
  panel.y_axis = measure.axis_title();
  panel.smaller_is_better = measure.better == Better::Smaller;
  panel.note = pairs_note(info);
  PanelCount empty{"empty", {}}, pairs{"pairs", {}}, excluded{"excluded", {}}, misfit{"misfit", {}};
  const bool with_bounds = measure.has(kWithBounds);
  for (const std::string& method : methods_of(info, with_bounds)) {
    PanelSeries series{method, {}};
    int count = 0;
    for (const std::string& level : panel.levels) {
      const SummaryRow& row = *rows.at({level, method});
      const SummaryValue value = row.of(measure.name);
      series.values.push_back({value.value, value.low, value.high});
      count += row.empty;
    }
    panel.series.push_back(series);
    empty.cells.push_back(std::to_string(count));
  }
  for (const std::string& level : panel.levels) {
    SummaryRow most;  // methods that do not apply to a pair do not count it
    for (const std::string& method : info.methods) {
      const SummaryRow& row = *rows.at({level, method});
      if (row.pairs + row.excluded + row.misfit > most.pairs + most.excluded + most.misfit) most = row;
    }
    pairs.cells.push_back(std::to_string(most.pairs));
    excluded.cells.push_back(std::to_string(most.excluded));
    misfit.cells.push_back(std::to_string(most.misfit));
  }
  panel.level_counts = {pairs, excluded};
  if (std::any_of(misfit.cells.begin(), misfit.cells.end(), [](const auto& cell) { return cell != "0"; }))
    panel.level_counts.push_back(misfit);
  if (!with_bounds) panel.series_counts = {empty};
  return panel;
}

/// The records that the means of an experiment are over, by method.
std::map<std::string, std::vector<const StudyRecord*>> counted_records(const StudyFolder& run,
                                                                       const ExperimentInfo& info) {
  std::map<std::string, std::vector<const StudyRecord*>> counted;
  for (const StudyRecord& record : run.records)
    if (record.experiment == info.name && record.dataset == info.dataset &&
        role_of(record, info.least_true_matches) == PairRole::Judged &&
        record.status.state != MethodState::NotApplicable)
      counted[record.method].push_back(&record);
  return counted;
}

/// The share of pairs that a grouper registers within a time, by its refined pose and the time of the grouping alone.
void add_budgets(const ExperimentInfo& info, const std::map<std::string, std::vector<const StudyRecord*>>& records,
                 StudyFigures& figures) {
  Panel panel = empty_panel(info, "success-in-time");
  panel.x_axis = "time of the grouping at most";
  panel.y_axis = "aligned within 5 pr";
  panel.note = "Pairs of all levels; wall time of the grouping alone, in one thread. Stated times are left out.";
  panel.levels = {"1 ms", "10 ms", "100 ms", "1 s"};
  for (const std::string& method : info.methods) {
    const auto found = records.find(method);
    if (found == records.end() || info.titles.count(method) > 0) continue;  // of another program
    PanelSeries series{method, {}};
    for (const double budget_ms : {1, 10, 100, 1000}) {
      const auto registers = [&](const StudyRecord* record) {
        const auto& error = record->refined.mean_error_pr;
        return record->time_ms && *record->time_ms <= budget_ms && error && *error <= kSuccessPr;
      };
      const auto count = std::count_if(found->second.begin(), found->second.end(), registers);
      series.values.push_back({static_cast<double>(count) / static_cast<double>(found->second.size()), {}, {}});
    }
    panel.series.push_back(series);
  }
  if (!panel.series.empty()) figures.panels.push_back({panel.name, title_of(info), {panel}});
}

/// What the probabilities of poses are worth, where they were asked for.
void add_reliability(const ExperimentInfo& info, const std::map<std::string, std::vector<const StudyRecord*>>& records,
                     StudyFigures& figures) {
  std::vector<RatedPoses> rated;
  for (const std::string& method : info.methods) {
    const auto found = records.find(method);
    if (found != records.end()) rated.push_back(rated_poses(method, found->second));
  }
  PanelFigure figure{file_name(info, "reliability"), title_of(info), {}};
  Panel curve = empty_panel(info, "reliability-curve"), coverage = empty_panel(info, "reliability-coverage");
  curve.note = coverage.note = "Refined poses over the pairs of all levels; right: mean error of at most 5 pr.";
  draw_reliability(rated, curve);
  draw_coverage(rated, coverage);
  if (curve.series.empty()) return;
  figure.panels = {curve, coverage};
  figures.panels.push_back(figure);
}

void add_distributions(const StudyFolder& run, const ExperimentInfo& info, StudyFigures& figures) {
  const auto records = counted_records(run, info);
  Panel curve = empty_panel(info, "success-curve");
  curve.axes = PanelAxes::Curve;
  curve.x_axis = "mean error at most (pr)";
  curve.y_axis = "share of pairs";
  curve.note = "Refined poses over the pairs of all levels; a missing pose is a failure.";
  curve.levels.clear();
  for (const double threshold : success_thresholds_pr()) curve.levels.push_back(to_text(threshold));
  BoxPanel boxes{
      file_name(info, "mean-error"), title_of(info), "mean error (pr), no pose at the right", {}, info.titles};
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
  add_budgets(info, records, figures);
  add_reliability(info, records, figures);
  const auto has_pose = [](const Box& box) { return box.without < box.pairs; };
  if (std::none_of(boxes.boxes.begin(), boxes.boxes.end(), has_pose)) return;
  figures.panels.push_back({curve.name, title_of(info), {curve}});
  figures.boxes.push_back(boxes);
}

/// Median times with their quartiles.
Panel time_panel(const StudyFolder& run, const ExperimentInfo& info) {
  Panel panel = empty_panel(info, "time");
  panel.axes = PanelAxes::Logarithmic;
  const Measure& time = measure("time_ms");
  panel.y_axis = time.title + " (" + time.unit + ")";
  panel.smaller_is_better = time.better == Better::Smaller;
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

StudyFigures study_figures(const std::vector<StudyResults>& studies) {
  StudyFigures figures;
  std::set<std::string> names;
  for (const StudyResults& study : studies)
    for (const ExperimentInfo& info : study.run->experiments) {
      if (!names.insert(file_name(info, "")).second)
        throw IoError(study.run->folder, "",
                      "experiment " + info.name + " on " + info.dataset + " is in another study too");
      if (is_of_times(info)) {
        Panel panel = time_panel(*study.run, info);
        if (keep_drawn(panel)) figures.panels.push_back({panel.name, title_of(info), {panel}});
        continue;
      }
      const SummaryRows rows = rows_of(study, info);
      for (const auto& [name, measures] : level_figures()) {
        PanelFigure figure{file_name(info, name), title_of(info), {}};
        for (const Measure* measure : measures) {
          Panel panel = level_panel(info, rows, *measure);
          if (keep_drawn(panel)) figure.panels.push_back(panel);
        }
        if (!figure.panels.empty()) figures.panels.push_back(figure);
      }
      add_distributions(*study.run, info, figures);
    }
  return figures;
}

}  // namespace corral
