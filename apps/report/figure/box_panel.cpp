// SPDX-License-Identifier: MIT
#include "apps/report/figure/box_panel.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/report/figure/axis.h"
#include "apps/report/figure/drawing.h"
#include "apps/report/figure/folders.h"
#include "apps/report/figure/printed_text.h"
#include "io/text/csv_file.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

Decades decades_of(const BoxPanel& panel) {
  Decades decades;
  for (const Box& box : panel.boxes)
    for (const auto& quantile : box.quantiles) decades.add(quantile);
  return decades;
}

/// The commands that draw a box, the `row`-th of the data, at its place y.
std::string box_text(std::size_t row, const std::string& color) {
  const std::string data = "  data skip 1 every ::" + std::to_string(row) + "::" + std::to_string(row) + " using ";
  const std::string pen = " linewidth 0.8 linecolor rgb '" + color + "'", y = "(y($1))";
  const auto across = [&](const std::string& quantile, const std::string& half, const std::string& style) {
    return data + "(at(" + quantile + ")):(y($1)-" + half + "):(0):(2*" + half + ") with vectors nohead" + style +
           " notitle";
  };
  return data + "(at(3)):" + y + ":(at(7)-at(3)):(0) with vectors nohead" + pen + " notitle, \\\n" +
         across("3", "0.15", pen) + ", \\\n" + across("7", "0.15", pen) + ", \\\n" + data + "(at(5)):" + y +
         ":(at(4)):(at(6)):(y($1)-0.3):(y($1)+0.3) with boxxyerror fillstyle solid 0.35 border" + pen +
         " notitle, \\\n" + across("5", "0.3", " linewidth 1.8 linecolor rgb '#000000'");
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
  constexpr double kRow = 13;
  const auto count = static_cast<double>(panel.boxes.size());
  std::vector<std::string> methods, names;
  for (const Box& box : panel.boxes) methods.push_back(box.method);
  const auto styles = method_styles(methods, panel.titles);
  std::vector<double> rows;
  std::string plot;
  for (std::size_t i = 0; i < panel.boxes.size(); ++i) {
    const MethodStyle& style = styles.at(panel.boxes[i].method);
    names.push_back(shortened(style.label, kMostOfName));
    rows.push_back(count - static_cast<double>(i));
    plot += box_text(i, style.color) + (i + 1 < panel.boxes.size() ? ", \\\n" : "\n");
  }
  const Decades decades = decades_of(panel);
  const double left = kGap + width_beside_axis(names);
  const double right = kColumnWidth - kGap - printed_width(decades.labels().back()) / 2;
  std::vector<double> places;
  for (std::size_t i = 0; i < decades.numbers().size(); ++i)
    places.push_back(left +
                     (right - left) * static_cast<double>(i) / static_cast<double>(decades.numbers().size() - 1));
  const AxisLabels labels = fit_labels(decades.labels(), places);
  const std::vector<std::string> title = wrapped(panel.title, kColumnWidth - 2 * kGap);
  const std::vector<std::string> axis = wrapped(panel.axis, right - left);
  const double top = kGap + static_cast<double>(title.size()) * kLine, bottom = top + kRow * count;
  Drawing page(kColumnWidth, bottom + labels.depth + static_cast<double>(axis.size()) * kLine + kGap);
  page.paragraph(kColumnWidth / 2, kGap / 2, title);
  page.paragraph((left + right) / 2, bottom + labels.depth, axis);
  return figure_script(panel.name, page,
                       {page.margins(left, right, top, bottom) + logarithmic_axis("x", decades, labels.texts) +
                        "set yrange [0.4:" + to_text(count + 0.6) + "]\nset ytics " + tics_text(names, rows) +
                        "\nset grid noytics xtics\n" + "at(k) = valid(k) ? (column(k) < " + to_text(decades.low()) +
                        " ? " + to_text(decades.low()) + " : column(k)) : " + to_text(decades.high()) +
                        "  # no value: the right border\ny(x) = " + to_text(count + 1) + " - x\ndata = '" +
                        std::string(kFromScripts) + kData + panel.name + ".csv'\nplot \\\n" + plot});
}

}  // namespace corral
