// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <set>

#include "apps/report/figure/box_panel.h"
#include "apps/report/figure/drawing.h"
#include "apps/report/figure/gnuplot.h"
#include "apps/report/figure/panel_figure.h"
#include "apps/report/figure/rank_diagram.h"
#include "grouping/registry.h"
#include "io/text/csv_file.h"
#include "kernel/error.h"
#include "tests/apps/report/figure/report_folder.h"

namespace corral {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

Panel small_panel() {
  Panel panel;
  panel.name = "noise-b3r-recall";
  panel.x_axis = "noise (pr)";
  panel.y_axis = "recall";
  panel.levels = {"[0,1)", "[1,2)", "[2,3]"};
  panel.series = {{"gc", {{0.5, 0.4, 0.625}, {}, {0.25, {}, {}}}}, {"my_own", {{0.75, {}, {}}, {0.0, {}, {}}, {}}}};
  panel.level_counts = {{"pairs", {"8", "0", "7"}}};
  panel.series_counts = {{"empty", {"0", "3"}}};
  panel.note = "100 % of them";
  return panel;
}

TEST(MethodStyle, EveryMethodOfThePaperHasItsOwnAndStrangersToo) {
  std::vector<std::string> methods = {"mine", "an \"odd\" one", "oracle", "baseline"};
  for (const Grouper& grouper : groupers()) methods.push_back(grouper.name);
  const auto styles = method_styles(methods);
  std::set<std::string> colors;
  std::set<int> points;
  for (const std::string& method : methods)
    if (!is_bound(method)) {
      colors.insert(styles.at(method).color);
      if (look_up(groupers(), method)) points.insert(styles.at(method).point);
    }
  EXPECT_EQ(colors.size(), groupers().size() + 2);
  EXPECT_EQ(points.size(), groupers().size());
  EXPECT_EQ(styles.at("hough").label, "3DHV");
  EXPECT_EQ(styles.at("mine").label, "mine");
  EXPECT_EQ(method_styles({"si"}).at("si").color, styles.at("si").color);
  EXPECT_TRUE(is_bound("baseline"));
  EXPECT_FALSE(is_bound("si"));
}

TEST(Panel, AbsentValuesAreEmptyCells) {
  const CsvTable table = parse_csv("panel", panel_csv(small_panel()));
  EXPECT_THAT(table.header,
              ElementsAre("level", "x", "gc", "gc_low", "gc_high", "my_own", "my_own_low", "my_own_high"));
  ASSERT_EQ(table.rows.size(), 3U);
  EXPECT_THAT(table.rows[0], ElementsAre("[0,1)", "1", "0.5", "0.4", "0.625", "0.75", "", ""));
  EXPECT_THAT(table.rows[1], ElementsAre("[1,2)", "2", "", "", "", "0", "", ""));
  EXPECT_THAT(table.rows[2], ElementsAre("[2,3]", "3", "0.25", "", "", "", "", ""));
  Panel empty_level = small_panel();
  empty_level.series[1].values[1].value.reset();
  const CsvTable without = parse_csv("panel", panel_csv(empty_level));
  ASSERT_EQ(without.rows.size(), 2U);
  EXPECT_EQ(without.rows[1][1], "3");
  Panel curve = small_panel();
  curve.axes = PanelAxes::Curve;
  curve.levels = {"0.5", "2", "7"};
  EXPECT_EQ(parse_csv("panel", panel_csv(curve)).rows[2][1], "7");
}

PanelFigure figure_of(const Panel& panel) { return {panel.name, "(a) Noise, it's", {panel}}; }

TEST(Panel, TheScriptReadsItsOwnFileAndQuotesWhatItIsTold) {
  const std::string script = panel_script(figure_of(small_panel()));
  EXPECT_THAT(script, HasSubstr("data = '../data/noise-b3r-recall.csv'"));
  EXPECT_THAT(script, HasSubstr("set output '../figures/noise-b3r-recall.'.ending"));
  EXPECT_THAT(script, HasSubstr("set label '(a) Noise, it''s' at "));
  EXPECT_THAT(script, HasSubstr("set xtics norotate offset 0,0.3 ('[0,1)' 1, '[1,2)' 2, '[2,3]' 3)"));
  EXPECT_THAT(script, HasSubstr("(valid(6)?column(6):NaN) with linespoints"));  // my_own, third of its columns is 8
  EXPECT_THAT(script, HasSubstr("set label 'my_own' at "));
  EXPECT_THAT(script, HasSubstr(pen_of(method_styles({"gc"}).at("gc"))));
  EXPECT_THAT(script, HasSubstr("with vectors nohead"));
  EXPECT_THAT(script, Not(HasSubstr("logscale")));
  Panel plain = small_panel();
  plain.axes = PanelAxes::Logarithmic;
  plain.levels = {"250", "500", "1000"};
  plain.series[0].values[0] = {1.0, {}, {}};
  EXPECT_THAT(panel_script(figure_of(plain)), AllOf(HasSubstr("set logscale x\n"), HasSubstr("set logscale y\n")));
  EXPECT_THAT(panel_script(figure_of(plain)), Not(HasSubstr("with vectors")));  // no interval is given
  EXPECT_EQ(gnuplot_text("`ls`\n'$x'"), "'`ls` ''$x'''");
  EXPECT_EQ(tics_text({"50 %", ""}, {1, 2.5}), "('50 %%' 1, '' 2.5)");  // labels of tics are formats
}

TEST(Panel, BarsOfMoreThanNineSeriesAreNotDrawn) {
  Panel panel = small_panel();
  while (panel.series.size() < 9) panel.series.push_back(panel.series.front());
  for (std::size_t i = 0; i < 9; ++i) panel.series[i].method = "m" + std::to_string(i);
  EXPECT_THAT(panel_script(figure_of(panel)), HasSubstr("with vectors nohead"));
  panel.series.push_back(panel.series.front());
  panel.series.back().method = "m9";
  EXPECT_THAT(panel_script(figure_of(panel)), Not(HasSubstr("with vectors")));
}

TEST(Panel, OneIsAColumnWideAndTwoArePageWideUnderOneLegend) {
  const std::string one = panel_script(figure_of(small_panel()));
  EXPECT_THAT(one, HasSubstr("size 8.500cm,"));
  PanelFigure figure = figure_of(small_panel());
  figure.panels.push_back(small_panel());
  figure.panels[1].name = "other";
  const std::string two = panel_script(figure);
  EXPECT_THAT(two, AllOf(HasSubstr("size 17.000cm,"), HasSubstr("'../data/other.csv'")));
  const std::string entry = "set label 'my_own' at ";
  EXPECT_EQ(two.find(entry), two.rfind(entry));
}

TEST(Panel, TheTableIsLatex) {
  const std::string text = panel_latex(small_panel());
  EXPECT_THAT(text, HasSubstr("\\begin{tabular}{lrrrr}\n\\hline\nrecall & [0,1) & [1,2) & [2,3] & empty \\\\\n"));
  EXPECT_THAT(text, HasSubstr("{GC} & 0.500 & -- & \\textbf{0.250} & 0 \\\\\n"));
  EXPECT_THAT(text, HasSubstr("{my\\_own} & \\textbf{0.750} & \\textbf{0.000} & -- & 3 \\\\\n"));
  EXPECT_THAT(text, HasSubstr("{pairs} & 8 & 0 & 7 \\\\\n"));
  EXPECT_THAT(text, HasSubstr("\\multicolumn{5}{l}{\\footnotesize 100 \\% of them}"));
  Panel times = small_panel();
  times.axes = PanelAxes::Logarithmic;
  times.smaller_is_better = true;
  times.levels = {"1", "2", "3"};
  EXPECT_THAT(panel_latex(times), HasSubstr("\\textbf{0.500} & -- & \\textbf{0.250}"));  // the least is best
  times.series.push_back({"oracle", {{0.125, {}, {}}, {}, {}}});
  times.series_counts.clear();
  EXPECT_THAT(panel_latex(times), HasSubstr("{oracle} & 0.125 & -- & --"));  // a bound is never the best
  EXPECT_EQ(latex_text("a_b%{c}\\^~#$&<>\n"), "a\\_b\\%\\{c\\}\\textbackslash{}\\^{}\\~{}\\#\\$\\&$<$$>$ ");
}

TEST(BoxPanel, QuantilesCountAbsentValuesAsTheWorst) {
  const Box box = box_of("gc", {4.0, 1.0, std::nullopt, 2.0, 3.0});
  EXPECT_EQ(box.pairs, 5);
  EXPECT_EQ(box.without, 1);
  EXPECT_DOUBLE_EQ(*box.quantiles[0], 1.2);
  EXPECT_EQ(box.quantiles[1], 2.0);
  EXPECT_EQ(box.quantiles[2], 3.0);
  EXPECT_EQ(box.quantiles[3], 4.0);
  EXPECT_FALSE(box.quantiles[4]);
  EXPECT_FALSE(box_of("gc", {}).quantiles[2]);
  EXPECT_EQ(box_of("gc", {7.0}).quantiles[4], 7.0);
  const BoxPanel panel{
      "noise-b3r-rmse", "Noise", "RMSE (pr)", {box_of("gc", {4.0, 1.0, std::nullopt}), box_of("o'dd", {0.25})}};
  EXPECT_EQ(box_csv(panel),
            "x,method,q05,q25,q50,q75,q95,pairs,without\n1,gc,1.3,2.5,4,,,3,1\n"
            "2,o'dd,0.25,0.25,0.25,0.25,0.25,1,0\n");
  EXPECT_THAT(box_script(panel), HasSubstr("set xrange [0.1:10]"));
  EXPECT_THAT(box_script(panel), HasSubstr("set ytics ('GC' 2, 'o''dd' 1)"));  // the first on top
}

TEST(RankDiagram, DrawsMethodsAndCliquesWhereTheirRanksAre) {
  const RankDiagram diagram{"ranks", "F1", {"gc", "ss", "ransac"}, {2.25, 2.5, 1.25}, 0.75, {{0, 1}}};
  EXPECT_EQ(rank_csv(diagram), "# critical difference 0.75\nmethod,average_rank\nransac,1.25\ngc,2.25\nss,2.5\n");
  const std::string script = rank_script(diagram);
  const auto place_of = [&](const std::string& text) {
    const std::size_t at = script.find(" at screen ", script.find("'" + text + "'"));
    return std::stod(script.substr(at + 11));
  };
  const double one = place_of("1"), unit = place_of("2") - one;
  EXPECT_NEAR(place_of("3"), one + 2 * unit, 1e-4);
  // The lines of the groupers begin at their ranks.
  std::vector<double> starts;
  const std::string arrow = "set arrow from screen ", color = method_styles({"gc"}).at("gc").color;
  for (std::size_t at = script.find(arrow); at != std::string::npos; at = script.find(arrow, at + 1))
    if (script.substr(at, script.find('\n', at) - at).find(color) != std::string::npos)
      starts.push_back(std::stod(script.substr(at + arrow.size())));
  ASSERT_EQ(starts.size(), 2U);
  EXPECT_NEAR(starts[0], one + 1.25 * unit, 1e-4);
  EXPECT_LT(place_of("RANSAC 1.25"), one);  // the best on the left
  EXPECT_LT(place_of("GC 2.25"), one);
  EXPECT_GT(place_of("SS 2.50"), one + 2 * unit);
  EXPECT_THAT(script, HasSubstr("linewidth 3"));  // the clique
  EXPECT_THAT(script, HasSubstr("size 8.500cm,"));
  std::vector<std::string> many;
  for (int i = 0; i < 20; ++i) many.push_back("grouper" + std::to_string(i));
  EXPECT_THAT(rank_script({"ranks", "", many, std::vector<double>(20, 10.5), 1, {}}), HasSubstr("size 17.000cm,"));
  EXPECT_THROW(rank_script({"ranks", "", {"gc"}, {1}, 1, {}}), InvalidInput);
  EXPECT_THROW(rank_script({"ranks", "", {"gc", "ss"}, {1}, 1, {}}), InvalidInput);
  EXPECT_THROW(rank_script({"ranks", "", {"gc", "ss"}, {1, 2}, 1, {{0, 2}}}), InvalidInput);
}

TEST(Gnuplot, DrawsEveryKindOfScript) {
  if (std::system("gnuplot --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "gnuplot is not installed";
  const testing::ReportFolder folder;
  const RankDiagram ranks{"ranks", "F1", {"gc", "ss", "ransac"}, {2.25, 2.5, 1.25}, 0.75, {{0, 1}}};
  EXPECT_THAT(folder.svg_of("ranks", rank_csv(ranks), rank_script(ranks)), HasSubstr("RANSAC 1.25"));
  Panel panel = small_panel();
  panel.name = "odd";
  panel.series[0].method = "a 'b' \"c\", `d`";
  for (const PanelAxes axes : {PanelAxes::Levels, PanelAxes::Curve, PanelAxes::Logarithmic}) {
    panel.axes = axes;
    if (axes != PanelAxes::Levels) panel.levels = {"1", "20", "300"};
    EXPECT_THAT(folder.svg_of("odd", panel_csv(panel), panel_script(figure_of(panel))), HasSubstr("`d`"));
  }
  const BoxPanel boxes{
      "boxes", "Noise", "RMSE", {box_of("gc", {4.0, 1.0, std::nullopt}), box_of("ss", {std::nullopt})}};
  EXPECT_THAT(folder.svg_of("boxes", box_csv(boxes), box_script(boxes)), HasSubstr("GC"));
  testing::put_text(folder / "scripts/bad.gp", "plot sin(\n");
  EXPECT_THROW(run_gnuplot(folder.path(), "bad"), GnuplotError);
}

// The lines between the points of a curve: a gap where a value is absent, none where all are there.
TEST(Gnuplot, AnAbsentValueBreaksTheLine) {
  if (std::system("gnuplot --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "gnuplot is not installed";
  const testing::ReportFolder folder;
  const auto moves = [&](const std::vector<PanelValue>& values) {
    Panel panel;
    panel.name = "gaps";
    panel.levels = {"1", "2", "3", "4", "5"};
    panel.series = {{"gc", values}, {"ss", std::vector<PanelValue>(5, {0.25, {}, {}})}};
    const std::string svg = folder.svg_of("gaps", panel_csv(panel), panel_script(figure_of(panel)));
    return std::count(svg.begin(), svg.end(), 'M');
  };
  const PanelValue half{0.5, {}, {}};
  EXPECT_EQ(moves({half, half, {}, half, half}), moves({half, half, half, half, half}) + 1);
}

}  // namespace
}  // namespace corral
