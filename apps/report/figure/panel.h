// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/report/figure/method_style.h"

namespace corral {

/// A value with its interval; a missing one is absent and drawn as a gap.
struct PanelValue {
  std::optional<double> value, low, high;
};

struct PanelSeries {
  std::string method;
  std::vector<PanelValue> values;  ///< one for each level
};

/// A row or column of a table beside the values, such as the number of pairs of a level.
struct PanelCount {
  std::string name;
  std::vector<std::string> cells;  ///< one for each level, or for each series
};

enum class PanelAxes {
  Levels,      ///< the levels are evenly spaced and labelled; values from 0 to 1
  Curve,       ///< the labels are numbers; values from 0 to 1
  Logarithmic  ///< the labels are numbers; both axes are logarithmic
};

/// Curves, one for each grouper, and the table behind them.
struct Panel {
  std::string name;  ///< of its files, without ending: letters, digits and . _ + - only
  std::string x_axis, y_axis;
  PanelAxes axes = PanelAxes::Levels;
  bool smaller_is_better = false;
  std::vector<std::string> levels;
  std::vector<PanelSeries> series;  ///< in the order of the legend
  std::vector<PanelCount> level_counts, series_counts;
  std::string note;  ///< a note for readers of the table
  MethodTitles titles = {};
};

/// The position of a level on the axis.
double place_of(const Panel& panel, std::size_t level);

/// level,x, then <method>,<method>_low,<method>_high of each series; empty where a value is absent. A level without any
/// value has no row, so that lines continue across it.
std::string panel_csv(const Panel& panel);

/// The panel as a LaTeX table that needs no package: a row for each grouper, the best of every level in bold.
std::string panel_latex(const Panel& panel);

/// Text that LaTeX prints verbatim; line breaks become spaces.
std::string latex_text(const std::string& text);

}  // namespace corral
