// SPDX-License-Identifier: MIT
#include "apps/report/figure/box_panel.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/report/figure/panel.h"
#include "io/csv_file.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

/// The axis from a power of ten below every quantile to one above; a decade if there is none.
std::string range_text(const BoxPanel& panel) {
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (const Box& box : panel.boxes)
    for (const auto& quantile : box.quantiles)
      if (quantile && *quantile > 0) {
        low = std::min(low, *quantile);
        high = std::max(high, *quantile);
      }
  if (!(high > 0)) low = high = 1;
  return "bottom = " + to_text(std::pow(10, std::floor(std::log10(low)))) +
         "\ntop = " + to_text(std::pow(10, std::floor(std::log10(high)) + 1)) + "\nset yrange [bottom:top]\n";
}

}  // namespace

Box box_of(const std::string& method, const std::vector<std::optional<double>>& values) {
  Box box{method, {}, static_cast<int>(values.size()), 0};
  std::vector<double> sorted;
  for (const auto& value : values) sorted.push_back(value.value_or(std::numeric_limits<double>::infinity()));
  std::sort(sorted.begin(), sorted.end());
  box.without = static_cast<int>(std::count(sorted.begin(), sorted.end(), std::numeric_limits<double>::infinity()));
  if (sorted.empty()) return box;
  const std::array<double, 5> shares = {0.05, 0.25, 0.5, 0.75, 0.95};
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const double at = shares[i] * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const double share = at - static_cast<double>(below);
    const double quantile = share > 0 ? (1 - share) * sorted[below] + share * sorted[below + 1] : sorted[below];
    if (std::isfinite(quantile)) box.quantiles[i] = quantile;
  }
  return box;
}

std::string box_csv(const BoxPanel& panel) {
  std::string text = csv_line({"x", "method", "q05", "q25", "q50", "q75", "q95", "pairs", "without"});
  for (std::size_t i = 0; i < panel.boxes.size(); ++i) {
    const Box& box = panel.boxes[i];
    std::vector<std::string> cells = {std::to_string(i + 1), box.method};
    for (const auto& quantile : box.quantiles) cells.push_back(quantile ? to_text(*quantile) : "");
    cells.push_back(std::to_string(box.pairs));
    cells.push_back(std::to_string(box.without));
    text += csv_line(cells);
  }
  return text;
}

std::string box_script(const BoxPanel& panel) {
  constexpr double kHeight = 5.4;
  std::vector<std::string> methods;
  for (const Box& box : panel.boxes) methods.push_back(box.method);
  const auto styles = method_styles(methods);
  std::string tics, plot = "plot \\\n";
  // An infinite quantile is drawn at the upper border, a quantile of zero at the lower.
  const auto column = [](int number) {
    const std::string text = std::to_string(number);
    return ":(valid(" + text + ")?(column(" + text + ")<bottom?bottom:column(" + text + ")):top)";
  };
  for (std::size_t i = 0; i < panel.boxes.size(); ++i) {
    const MethodStyle& style = styles.at(panel.boxes[i].method);
    const std::string rows = "  data skip 1 every ::" + std::to_string(i) + "::" + std::to_string(i) + " using 1";
    tics += (i > 0 ? ", " : "") + gnuplot_text(style.label) + " " + std::to_string(i + 1);
    plot += rows + column(4) + column(3) + column(7) + column(6) +
            " with candlesticks whiskerbars 0.5 fillstyle solid 0.35 border linewidth 0.8 linecolor rgb '" +
            style.color + "' notitle, \\\n" + rows + column(5) + column(5) + column(5) + column(5) +
            " with candlesticks linewidth 1.8 linecolor rgb '#000000' notitle" +
            (i + 1 < panel.boxes.size() ? ", \\\n" : "\n");
  }
  return script_head(kHeight) + "set title " + gnuplot_text(panel.title) + " offset 0,-0.6\nset ylabel " +
         gnuplot_text(panel.y_axis) +
         " offset 1.2,0\nset xrange [0.4:" + to_text(static_cast<double>(panel.boxes.size()) + 0.6) + "]\nset xtics (" +
         tics + ")" + (panel.boxes.size() > 9 ? " rotate by 40 right" : "") + "\nset logscale y\nset format y '%g'\n" +
         range_text(panel) + "set boxwidth 0.55\ndata = '" + panel.name + ".csv'\n" +
         script_tail(panel.name, plot, kHeight);
}

}  // namespace corral
