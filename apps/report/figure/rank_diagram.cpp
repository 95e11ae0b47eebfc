// SPDX-License-Identifier: MIT
#include "apps/report/figure/rank_diagram.h"

#include <algorithm>
#include <numeric>

#include "apps/report/figure/panel.h"
#include "apps/runtime/text_table.h"
#include "io/csv_file.h"
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

/// Lines and words in units of ranks (x) and of rows below the axis (y).
class Drawing {
 public:
  void line(double x1, double y1, double x2, double y2, const std::string& style) {
    text_ += "set arrow from " + to_text(x1) + "," + to_text(y1) + " to " + to_text(x2) + "," + to_text(y2) +
             " nohead " + style + "\n";
  }
  void words(double x, double y, const std::string& text, const std::string& style) {
    text_ += "set label " + gnuplot_text(text) + " at " + to_text(x) + "," + to_text(y) + " " + style + "\n";
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

const std::string kThin = "linewidth 0.7 linecolor rgb '#000000'";

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
  const auto styles = method_styles(diagram.methods);
  const std::vector<int> order = best_first(diagram);
  const auto count = static_cast<int>(order.size());
  const auto rank = [&](int method) { return diagram.average_ranks[static_cast<std::size_t>(method)]; };
  Drawing drawing;
  drawing.line(1, 0, count, 0, kThin);
  for (int i = 1; i <= count; ++i) {
    drawing.line(i, 0, i, 0.25, kThin);
    drawing.words(i, 0.6, std::to_string(i), "center");
  }
  drawing.line(1, 1.5, std::min<double>(1 + diagram.critical_difference, count), 1.5,
               "linewidth 1.5 linecolor rgb '#000000'");
  drawing.words(1, 2.0, "critical difference " + fixed(diagram.critical_difference, 2), "left");
  double row = 0;
  for (const auto& clique : diagram.cliques) {  // bars that touch no grouper's line
    const auto [low, high] =
        std::minmax_element(clique.begin(), clique.end(), [&](int a, int b) { return rank(a) < rank(b); });
    row -= 0.45;
    drawing.line(rank(*low) - 0.06, row, rank(*high) + 0.06, row, "linewidth 3 linecolor rgb '#444444'");
  }
  const int left_half = (count + 1) / 2;
  double lowest = row;
  for (int i = 0; i < count; ++i) {  // the better half to the left, from the best down; the others to the right
    const int method = order[static_cast<std::size_t>(i)];
    const bool is_left = i < left_half;
    const double y = row - 0.9 * (1 + (is_left ? i : count - 1 - i)), end = is_left ? 0.7 : count + 0.3;
    const MethodStyle& style = styles.at(diagram.methods[static_cast<std::size_t>(method)]);
    const std::string pen = "linewidth 1.2 linecolor rgb '" + style.color + "'";
    drawing.line(rank(method), 0, rank(method), y, pen);
    drawing.line(rank(method), y, end, y, pen);
    drawing.words(end + (is_left ? -0.1 : 0.1), y, style.label + " " + fixed(rank(method), 2),
                  is_left ? "right" : "left");
    lowest = std::min(lowest, y);
  }
  const double height = 0.36 * (4.5 - lowest), side = 0.24 * count + 0.6;
  return script_head(height) + "unset border\nunset tics\nunset grid\nunset key\nset margins 0,0,0,0\nset xrange [" +
         to_text(1 - side) + ":" + to_text(count + side) + "]\nset yrange [" + to_text(lowest - 0.6) + ":3.6]\n" +
         drawing.text() + "set label " + gnuplot_text(diagram.title) + " at graph 0.5,0.97 center\n" +
         script_tail(diagram.name, "plot NaN notitle\n", height);
}

}  // namespace corral
