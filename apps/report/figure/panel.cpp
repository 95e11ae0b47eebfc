// SPDX-License-Identifier: MIT
#include "apps/report/figure/panel.h"

#include <algorithm>

#include "apps/runtime/text_table.h"
#include "io/csv_file.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

std::string cell(const std::optional<double>& value) { return value ? to_text(*value) : ""; }

/// The position of a level on the axis.
double place_of(const Panel& panel, std::size_t level) {
  if (panel.axes == PanelAxes::Levels) return static_cast<double>(level + 1);
  return parse_double(panel.levels[level]).value_or(static_cast<double>(level + 1));
}

bool has_intervals(const Panel& panel) {
  for (const PanelSeries& series : panel.series)
    for (const PanelValue& value : series.values)
      if (value.low || value.high) return true;
  return false;
}

std::string level_tics(const Panel& panel) {
  std::size_t letters = 0;
  std::string tics;
  for (std::size_t i = 0; i < panel.levels.size(); ++i) {
    tics += (i > 0 ? ", " : "") + gnuplot_text(panel.levels[i]) + " " + to_text(place_of(panel, i));
    letters += panel.levels[i].size() + 2;
  }
  return "set xtics (" + tics + ")" +
         (letters > (panel.axes == PanelAxes::Logarithmic ? 24 : 64) ? " rotate by 40 right" : "") + "\n";
}

std::string axes_text(const Panel& panel) {
  std::string text = "set title " + gnuplot_text(panel.title) + " offset 0,-0.6\nset xlabel " +
                     gnuplot_text(panel.x_axis) + " offset 0,0.4\nset ylabel " + gnuplot_text(panel.y_axis) +
                     " offset 1.2,0\n";
  if (panel.axes == PanelAxes::Logarithmic) return text + "set logscale xy\nset format y '%g'\n" + level_tics(panel);
  text += "set yrange [0:1.03]\nset ytics 0.2\n";
  if (panel.axes == PanelAxes::Curve) return text + "set autoscale xfix\n";
  return text + "set xrange [0.5:" + to_text(static_cast<double>(panel.levels.size()) + 0.5) + "]\n" +
         level_tics(panel);
}

}  // namespace

std::string gnuplot_text(const std::string& text) {
  std::string quoted = "'";
  for (const char character : text) {
    if (character == '\'') quoted += '\'';  // a quote is doubled
    quoted += static_cast<unsigned char>(character) < ' ' ? ' ' : character;
  }
  return quoted + "'";
}

std::string script_head(double height_cm) {
  return "# Made by corral report. Change what you like and run gnuplot on this file.\n"
         "set datafile separator ','\n"
         "set terminal pdfcairo noenhanced size 8cm," +
         to_text(height_cm) +
         "cm font 'sans,7' fontscale 1 linewidth 1 rounded\n"
         "set border 3 linewidth 0.6 linecolor rgb '#404040'\n"
         "set tics nomirror out scale 0.5\n"
         "set grid ytics linecolor rgb '#dddddd' linewidth 0.5 dashtype 1\n"
         "set key outside bottom center horizontal Left reverse samplen 2.6 width 1 spacing 1 maxrows 3 height 0.7\n";
}

std::string script_tail(const std::string& name, const std::string& plot, double height_cm) {
  const std::string pixels = std::to_string(static_cast<int>(480 * height_cm / 8));
  return "set output '" + name + ".pdf'\n" + plot + "set terminal svg noenhanced size 480," + pixels +
         " font 'sans,11' linewidth 1.4 rounded\nset output '" + name + ".svg'\nreplot\nset output\n";
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

std::string panel_script(const Panel& panel) {
  constexpr double kHeight = 6.2;
  std::vector<std::string> methods;
  for (const PanelSeries& series : panel.series) methods.push_back(series.method);
  const auto styles = method_styles(methods);
  const bool intervals = has_intervals(panel);
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
    const std::string color = " linecolor rgb '" + style.color + "'";
    if (intervals)
      bars += "  data skip 1 using " + x + value(1) + ":(0):(" + column(2) + "-" + column(1) +
              ") with vectors nohead linewidth 0.8" + color + " notitle, \\\n";
    lines +=
        "  data skip 1 using " + x + value(0) +
        (style.point > 0 ? " with linespoints pointsize 0.6 pointtype " + std::to_string(style.point) : " with lines") +
        " linewidth 1.3 dashtype " + (style.dash.empty() ? "1" : style.dash) + color + " title " +
        gnuplot_text(style.label) + (i + 1 < panel.series.size() ? ", \\\n" : "\n");
  }
  return script_head(kHeight) + axes_text(panel) + "data = '" + panel.name + ".csv'\n" +
         script_tail(panel.name, "plot \\\n" + bars + lines, kHeight);
}

}  // namespace corral
