// SPDX-License-Identifier: MIT
#include "apps/report/figure/panel.h"

#include <algorithm>

#include "io/text/csv_file.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

std::string cell(const std::optional<double>& value) { return value ? to_text(*value) : ""; }

}  // namespace

double place_of(const Panel& panel, std::size_t level) {
  if (panel.axes == PanelAxes::Levels) return static_cast<double>(level + 1);
  return parse_double(panel.levels[level]).value_or(static_cast<double>(level + 1));
}

std::string panel_csv(const Panel& panel) {
  std::vector<std::string> header = {"level", "x"};
  for (const PanelSeries& series : panel.series)
    for (const char* suffix : {"", "_low", "_high"}) header.push_back(series.method + suffix);
  std::string text = csv_line(header);
  for (std::size_t level = 0; level < panel.levels.size(); ++level) {
    const auto has_value = [&](const PanelSeries& series) { return series.values[level].value.has_value(); };
    if (std::none_of(panel.series.begin(), panel.series.end(), has_value)) continue;
    std::vector<std::string> cells = {panel.levels[level], to_text(place_of(panel, level))};
    for (const PanelSeries& series : panel.series)
      for (const auto& value : {series.values[level].value, series.values[level].low, series.values[level].high})
        cells.push_back(cell(value));
    text += csv_line(cells);
  }
  return text;
}

}  // namespace corral
