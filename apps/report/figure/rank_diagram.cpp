// SPDX-License-Identifier: MIT
#include "apps/report/figure/rank_diagram.h"

#include <algorithm>
#include <numeric>

#include "apps/report/figure/axis.h"
#include "apps/report/figure/drawing.h"
#include "apps/report/figure/printed_text.h"
#include "apps/runtime/text_table.h"
#include "io/text/csv_file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

std::vector<int> best_first(const RankDiagram& diagram) {
  std::vector<int> order(diagram.methods.size());
  std::iota(order.begin(), order.end(), 0);
  const auto rank = [&](int method) { return diagram.average_ranks[static_cast<std::size_t>(method)]; };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return rank(a) < rank(b); });
  return order;
}

void check(const RankDiagram& diagram) {
  const std::size_t count = diagram.methods.size();
  if (count < 2) throw InvalidInput("rank diagram", "methods", static_cast<double>(count), "2 or more");
  if (diagram.average_ranks.size() != count)
    throw InvalidInput("rank diagram", "average_ranks", static_cast<double>(diagram.average_ranks.size()),
                       "one for each grouper");
  for (const auto& clique : diagram.cliques)
    for (const int method : clique)
      if (clique.size() < 2 || method < 0 || static_cast<std::size_t>(method) >= count)
        throw InvalidInput("rank diagram", "cliques", method, "places of 2 or more groupers");
}

const std::string kThin = "linewidth 0.7 linecolor rgb '#000000'";

constexpr double kAside = 8;  // the line of a name goes so far beyond the axis
constexpr double kBar = 4;    // from one bar of a clique to the next

/// Ranks along the page.
struct Axis {
  double first = 0, unit = 1;
  double at(double rank) const { return first + (rank - 1) * unit; }
};

std::vector<std::string> names_of(const RankDiagram& diagram, const std::vector<int>& order) {
  const auto styles = method_styles(diagram.methods, diagram.titles);
  std::vector<std::string> names;
  for (const int place : order) {
    const auto method = static_cast<std::size_t>(place);
    names.push_back(shortened(styles.at(diagram.methods[method]).label, kMostOfName) + " " +
                    fixed(diagram.average_ranks[method], 2));
  }
  return names;
}

void draw_axis(Drawing& page, const Axis& axis, double y, std::size_t count) {
  std::vector<std::string> ranks;
  std::vector<double> places;
  for (std::size_t rank = 1; rank <= count; ++rank) {
    ranks.push_back(std::to_string(rank));
    places.push_back(axis.at(static_cast<double>(rank)));
  }
  const AxisLabels labels = fit_labels(ranks, places);
  page.line(places.front(), y, places.back(), y, kThin);
  for (std::size_t i = 0; i < count; ++i) {
    page.line(places[i], y, places[i], y - 3, kThin);
    if (!labels.texts[i].empty()) page.words(places[i], y - 4 - kLine / 2, labels.texts[i], Align::Center);
  }
}

void draw_difference(Drawing& page, const Axis& axis, double y, double difference, std::size_t count) {
  const double end = axis.at(std::min(1 + difference, static_cast<double>(count)));
  page.words(axis.at(1), y - kLine / 2 - 2, "critical difference " + fixed(difference, 2), Align::Left);
  page.line(axis.at(1), y, end, y, "linewidth 1.5 linecolor rgb '#000000'");
  for (const double x : {axis.at(1), end}) page.line(x, y - 2, x, y + 2, kThin);
}

/// Bars over the groupers that do not differ, which touch no other grouper's line.
void draw_cliques(Drawing& page, const Axis& axis, double y, const RankDiagram& diagram) {
  for (const auto& clique : diagram.cliques) {
    const auto rank = [&](int method) { return diagram.average_ranks[static_cast<std::size_t>(method)]; };
    const auto [low, high] =
        std::minmax_element(clique.begin(), clique.end(), [&](int a, int b) { return rank(a) < rank(b); });
    page.line(axis.at(rank(*low)) - 2, y, axis.at(rank(*high)) + 2, y, "linewidth 3 linecolor rgb '#444444'");
    y += kBar;
  }
}

}  // namespace

std::string rank_csv(const RankDiagram& diagram) {
  std::string text =
      "# critical difference " + to_text(diagram.critical_difference) + "\n" + csv_line({"method", "average_rank"});
  for (const int method : best_first(diagram))
    text += csv_line({diagram.methods[static_cast<std::size_t>(method)],
                      to_text(diagram.average_ranks[static_cast<std::size_t>(method)])});
  return text;
}

std::string rank_script(const RankDiagram& diagram) {
  check(diagram);
  const std::vector<int> order = best_first(diagram);
  const std::size_t count = order.size(), left_half = (count + 1) / 2;
  const std::vector<std::string> names = names_of(diagram, order);
  // The better half of the names to the left, from the best down; the others to the right, from the worst down.
  const auto middle = names.begin() + static_cast<std::ptrdiff_t>(left_half);
  const double left = widest_of({names.begin(), middle}) + kAside + 2 * kGap;
  const double right = widest_of({middle, names.end()}) + kAside + 2 * kGap;
  const bool fits_column = kColumnWidth - left - right >= 14 * static_cast<double>(count - 1);
  const double width = fits_column ? kColumnWidth : kPageWidth;
  const std::vector<std::string> title = wrapped(diagram.title, width - 2 * kGap);
  const Axis axis{left, (width - left - right) / static_cast<double>(count - 1)};
  const double difference_y = 2 * kGap + static_cast<double>(title.size()) * kLine + kLine;
  const double axis_y = difference_y + 2 * kLine;
  const double bars_y = axis_y + kGap + kBar * static_cast<double>(diagram.cliques.size());
  Drawing page(width, bars_y + static_cast<double>(left_half) * kLine + kGap);
  page.paragraph(width / 2, kGap / 2, title);
  draw_axis(page, axis, axis_y, count);
  draw_difference(page, axis, difference_y, diagram.critical_difference, count);
  draw_cliques(page, axis, axis_y + kGap, diagram);
  const auto styles = method_styles(diagram.methods, diagram.titles);
  for (std::size_t i = 0; i < count; ++i) {
    const auto method = static_cast<std::size_t>(order[i]);
    const bool is_left = i < left_half;
    const double x = axis.at(diagram.average_ranks[method]);
    const double y = bars_y + (static_cast<double>(is_left ? i : count - 1 - i) + 0.5) * kLine;
    const double end = is_left ? left - kAside : width - right + kAside;
    const std::string pen = "linewidth 1.2 linecolor rgb '" + styles.at(diagram.methods[method]).color + "'";
    page.line(x, axis_y, x, y, pen);
    page.line(x, y, end, y, pen);
    page.words(end + (is_left ? -kGap : kGap), y, names[i], is_left ? Align::Right : Align::Left);
  }
  return figure_script(
      diagram.name, page,
      {"unset border\nunset tics\nunset grid\nset xrange [0:1]\nset yrange [0:1]\nplot NaN notitle\n"});
}

}  // namespace corral
