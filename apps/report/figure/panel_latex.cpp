// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>

#include "apps/report/figure/panel.h"
#include "apps/runtime/text_table.h"

namespace corral {
namespace {

/// Three decimals for shares, three digits for times.
std::string number_text(const Panel& panel, double value) {
  if (panel.axes != PanelAxes::Logarithmic) return fixed(value, 3);
  return fixed(value, value >= 100 ? 0 : value >= 10 ? 1 : value >= 1 ? 2 : 3);
}

/// The best value of a level as printed; empty if there is none.
std::string best_of(const Panel& panel, std::size_t level) {
  std::optional<double> best;
  for (const PanelSeries& series : panel.series) {
    const std::optional<double>& value = series.values[level].value;
    if (!value || is_bound(series.method)) continue;
    if (!best || (panel.smaller_is_better ? *value < *best : *value > *best)) best = value;
  }
  return best ? number_text(panel, *best) : "";
}

}  // namespace

std::string latex_text(const std::string& text) {
  static const std::map<char, std::string> special = {{'\\', "\\textbackslash{}"},
                                                      {'{', "\\{"},
                                                      {'}', "\\}"},
                                                      {'$', "\\$"},
                                                      {'&', "\\&"},
                                                      {'#', "\\#"},
                                                      {'%', "\\%"},
                                                      {'_', "\\_"},
                                                      {'^', "\\^{}"},
                                                      {'~', "\\~{}"},
                                                      {'<', "$<$"},
                                                      {'>', "$>$"},
                                                      {'|', "$|$"},
                                                      {'"', "''"}};
  std::string escaped;
  for (const char character : text) {
    const auto found = special.find(character);
    if (found != special.end())
      escaped += found->second;
    else
      escaped += static_cast<unsigned char>(character) < ' ' ? ' ' : character;
  }
  return escaped;
}

std::string panel_latex(const Panel& panel) {
  std::vector<std::string> methods;
  for (const PanelSeries& series : panel.series) methods.push_back(series.method);
  const auto styles = method_styles(methods, panel.titles);
  const std::size_t columns = 1 + panel.levels.size() + panel.series_counts.size();
  // A row must not begin with a bracket, which would be read as an option of the previous row.
  std::string text = "\\begin{tabular}{l" + std::string(columns - 1, 'r') + "}\n\\hline\n" + latex_text(panel.y_axis);
  for (const std::string& level : panel.levels) text += " & " + latex_text(level);
  for (const PanelCount& count : panel.series_counts) text += " & " + latex_text(count.name);
  text += " \\\\\n\\hline\n";
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    const PanelSeries& series = panel.series[i];
    text += "{" + latex_text(styles.at(series.method).label) + "}";
    for (std::size_t level = 0; level < panel.levels.size(); ++level) {
      const std::optional<double>& value = series.values[level].value;
      const std::string number = value ? number_text(panel, *value) : "--";
      const bool is_best = !is_bound(series.method) && number == best_of(panel, level);
      text += " & " + (is_best ? "\\textbf{" + number + "}" : number);
    }
    for (const PanelCount& count : panel.series_counts) text += " & " + latex_text(count.cells[i]);
    text += " \\\\\n";
  }
  if (!panel.level_counts.empty()) text += "\\hline\n";
  for (const PanelCount& count : panel.level_counts) {
    text += "{" + latex_text(count.name) + "}";
    for (const std::string& number : count.cells) text += " & " + latex_text(number);
    text += " \\\\\n";  // fewer cells than columns are allowed
  }
  text += "\\hline\n";
  if (!panel.note.empty())
    text += "\\multicolumn{" + std::to_string(columns) + "}{l}{\\footnotesize " + latex_text(panel.note) + "} \\\\\n";
  return text + "\\end{tabular}\n";
}

}  // namespace corral
