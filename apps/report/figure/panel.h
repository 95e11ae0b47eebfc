// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/report/figure/method_style.h"

namespace corral {

/// A value with the interval that it is known to; what could not be had is absent and drawn as a gap.
struct PanelValue {
  std::optional<double> value, low, high;
};

struct PanelSeries {
  std::string method;
  std::vector<PanelValue> values;  ///< one for each level
};

/// A row or column of a table beside the values, such as how many pairs a level has.
struct PanelCount {
  std::string name;
  std::vector<std::string> cells;  ///< one for each level, or for each series
};

enum class PanelAxes {
  Levels,      ///< the levels stand at even distances under their labels; values from 0 to 1
  Curve,       ///< the labels are numbers; values from 0 to 1
  Logarithmic  ///< the labels are numbers; both axes are logarithmic
};

/// A figure of curves, one for each method, and the table behind it.
struct Panel {
  std::string name;  ///< of its files, without ending: letters, digits and . _ + - only
  std::string title, x_axis, y_axis;
  PanelAxes axes = PanelAxes::Levels;
  bool smaller_is_better = false;
  std::vector<std::string> levels;
  std::vector<PanelSeries> series;  ///< in the order of the legend
  std::vector<PanelCount> level_counts, series_counts;
  std::string note;  ///< what a reader of the table must know
};

/// level,x, then <method>,<method>_low,<method>_high of each series; empty where a value is absent. A level without any
/// value has no row: lines go on beyond it.
std::string panel_csv(const Panel& panel);

/// A script for gnuplot that reads `<name>.csv` beside it and makes `<name>.pdf` and `<name>.svg`, 8 cm wide.
std::string panel_script(const Panel& panel);

/// The panel as a LaTeX table that needs no package: a row for each method, the best of every level in bold.
std::string panel_latex(const Panel& panel);

/// Text that LaTeX prints as it stands; line breaks become spaces.
std::string latex_text(const std::string& text);

/// What every script begins with, and how it ends: both files from what `plot` draws. `height_cm` of 8 cm width.
std::string script_head(double height_cm);
std::string script_tail(const std::string& name, const std::string& plot, double height_cm);

/// Text as a string of gnuplot's that stands for itself.
std::string gnuplot_text(const std::string& text);

}  // namespace corral
