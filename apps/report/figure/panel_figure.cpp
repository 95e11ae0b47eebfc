// SPDX-License-Identifier: MIT
#include "apps/report/figure/panel_figure.h"

#include <algorithm>
#include <cmath>

#include "apps/report/figure/axis.h"
#include "apps/report/figure/drawing.h"
#include "apps/report/figure/folders.h"
#include "apps/report/figure/legend.h"
#include "apps/report/figure/printed_text.h"
#include "apps/runtime/text_table.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

constexpr double kPlotHeight = 115;

std::vector<std::string> methods_of(const PanelFigure& figure) {
  std::vector<std::string> methods;
  for (const Panel& panel : figure.panels)
    for (const PanelSeries& series : panel.series)
      if (std::find(methods.begin(), methods.end(), series.method) == methods.end()) methods.push_back(series.method);
  return methods;
}

constexpr std::size_t kMostWithBars = 9;  // series whose bars can be told apart: seven groupers and two bounds

bool draws_intervals(const Panel& panel) {
  if (panel.series.size() > kMostWithBars) return false;
  for (const PanelSeries& series : panel.series)
    for (const PanelValue& value : series.values)
      if (value.low || value.high) return true;
  return false;
}

Decades decades_of(const Panel& panel) {
  Decades decades;
  for (const PanelSeries& series : panel.series)
    for (const PanelValue& value : series.values)
      for (const auto& number : {value.value, value.low, value.high}) decades.add(number);
  return decades;
}

/// The part of the horizontal axis that is drawn.
struct Range {
  double low, high;
};
Range range_of(const Panel& panel) {
  const double first = place_of(panel, 0), last = place_of(panel, panel.levels.size() - 1);
  if (panel.axes == PanelAxes::Levels) return {first - 0.5, last + 0.5};
  return panel.axes == PanelAxes::Curve ? Range{first, last} : Range{first / 1.2, last * 1.2};
}

std::vector<double> places_of(const Panel& panel) {
  std::vector<double> places;
  for (std::size_t i = 0; i < panel.levels.size(); ++i) places.push_back(place_of(panel, i));
  return places;
}

/// Where a panel lies on the page: its plot within the strips of its labels.
struct Frame {
  AxisLabels labels;                ///< of the horizontal axis
  std::vector<std::string> axis;    ///< its title, in lines
  std::vector<std::string> beside;  ///< labels of the vertical axis
  double start = 0, left = 0, right = 0;
};

Frame frame_of(const Panel& panel, double start, double width) {
  Frame frame;
  frame.beside = panel.axes == PanelAxes::Logarithmic
                     ? decades_of(panel).labels()
                     : std::vector<std::string>{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"};
  frame.start = start + kGap / 2;
  frame.left = frame.start + kLine + width_beside_axis(frame.beside);
  const bool is_inside = panel.axes == PanelAxes::Levels;  // else half of the last label is to the right of the axis
  frame.right = start + width - kGap - (is_inside ? 0 : printed_width(panel.levels.back()) / 2);
  frame.axis = wrapped(panel.x_axis, frame.right - frame.left);
  const Range range = range_of(panel);
  const auto along = [&](double place) {
    const double share = panel.axes == PanelAxes::Logarithmic
                             ? std::log(place / range.low) / std::log(range.high / range.low)
                             : (place - range.low) / (range.high - range.low);
    return frame.left + share * (frame.right - frame.left);
  };
  std::vector<double> places;
  for (const double place : places_of(panel)) places.push_back(along(place));
  frame.labels = fit_labels(panel.levels, places);
  return frame;
}

std::string axes_text(const Panel& panel, const Frame& frame) {
  const Range range = range_of(panel);
  std::string text;
  if (panel.axes == PanelAxes::Logarithmic)
    text = "set logscale x\n" + logarithmic_axis("y", decades_of(panel), frame.beside);
  else
    text = "set yrange [0:1.03]\nset ytics 0.2\nset format y '%.1f'\n";
  return text + "set xrange [" + to_text(range.low) + ":" + to_text(range.high) + "]\nset xtics " +
         (frame.labels.are_upright ? "rotate by 90 right " : "norotate ") + kNearAxis +
         tics_text(frame.labels.texts, places_of(panel)) + "\n";
}

std::string plot_text(const Panel& panel) {
  std::vector<std::string> methods;
  for (const PanelSeries& series : panel.series) methods.push_back(series.method);
  const auto styles = method_styles(methods);
  const bool intervals = draws_intervals(panel);
  std::string bars, lines;
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    const MethodStyle& style = styles.at(panel.series[i].method);
    // Bars are drawn side by side; an absent value breaks the line.
    const double beside = (static_cast<double>(i) - static_cast<double>(panel.series.size() - 1) / 2) * 0.05;
    const std::string x = intervals && panel.axes == PanelAxes::Levels ? "($2+(" + fixed(beside, 3) + "))" : "2";
    const auto column = [&](std::size_t offset) { return "column(" + std::to_string(3 + 3 * i + offset) + ")"; };
    const auto value = [&](std::size_t offset) {
      return ":(valid(" + std::to_string(3 + 3 * i + offset) + ")?" + column(offset) + ":NaN)";
    };
    if (intervals)
      bars += "  data skip 1 using " + x + value(1) + ":(0):(" + column(2) + "-" + column(1) +
              ") with vectors nohead linewidth 0.8 linecolor rgb '" + style.color + "' notitle, \\\n";
    lines += "  data skip 1 using " + x + value(0) +
             (style.point > 0 ? " with linespoints " + marker_of(style) : " with lines") + " " + pen_of(style) +
             " notitle" + (i + 1 < panel.series.size() ? ", \\\n" : "\n");
  }
  return "data = '" + std::string(kFromScripts) + kData + panel.name + ".csv'\nplot \\\n" + bars + lines;
}

}  // namespace

std::string panel_script(const PanelFigure& figure) {
  const double width = figure.panels.size() > 1 ? kPageWidth : kColumnWidth;
  const double share = width / static_cast<double>(figure.panels.size());
  const Legend legend(methods_of(figure), width, figure.panels.front().titles);
  const std::vector<std::string> title = wrapped(figure.title, width - 2 * kGap);
  std::vector<Frame> frames;
  double depth = 0, plot_height = kPlotHeight;
  for (const Panel& panel : figure.panels) {
    frames.push_back(frame_of(panel, share * static_cast<double>(frames.size()), share));
    depth = std::max(depth, frames.back().labels.depth);
    plot_height =
        std::max({plot_height, printed_width(panel.y_axis), kLine * static_cast<double>(frames.back().beside.size())});
  }
  const double legend_top = kGap + static_cast<double>(title.size()) * kLine;
  const double top = legend_top + legend.height() + kGap, bottom = top + plot_height;
  std::size_t axis_lines = 0;
  for (const Frame& frame : frames) axis_lines = std::max(axis_lines, frame.axis.size());
  Drawing page(width, bottom + depth + static_cast<double>(axis_lines) * kLine + kGap);
  page.paragraph(width / 2, kGap / 2, title);
  legend.draw(page, legend_top);
  std::vector<std::string> plots;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Frame& frame = frames[i];
    page.upright_words(frame.start + kLine / 2, (top + bottom) / 2, figure.panels[i].y_axis);
    page.paragraph((frame.left + frame.right) / 2, bottom + depth, frame.axis);
    plots.push_back(page.margins(frame.left, frame.right, top, bottom) + axes_text(figure.panels[i], frame) +
                    plot_text(figure.panels[i]));
  }
  return figure_script(figure.name, page, plots);
}

}  // namespace corral
