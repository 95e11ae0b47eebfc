// SPDX-License-Identifier: MIT
// corral report and corral draw, as a user types them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "apps/report/pair_gallery.h"
#include "apps/report/study_figures.h"
#include "io/text/csv_file.h"
#include "kernel/error.h"
#include "tests/support/program.h"

namespace corral {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Outcome;
using ::testing::StartsWith;
using testing::Workplace;

bool has_gnuplot() { return std::system("gnuplot --version >/dev/null 2>&1") == 0; }

/// Without PATH no program is found, gnuplot least of all.
struct EmptyPath {
  EmptyPath() : kept(std::getenv("PATH")) { ::setenv("PATH", "/nowhere", 1); }
  ~EmptyPath() { ::setenv("PATH", kept.c_str(), 1); }
  std::string kept;
};

StudyRecord record_of(const std::string& pair, const std::string& method, std::optional<double> mean_error_pr) {
  StudyRecord record;
  record.experiment = "noise";
  record.dataset = "b3r";
  record.level = "0.1";
  record.pair = pair;
  record.method = method;
  record.status = {MethodState::Refined};
  record.matches = 10;
  record.true_matches = 5;
  record.refined.mean_error_pr = mean_error_pr;
  return record;
}

/// run/: an experiment of two levels; the second of method gc is absent.
void put_run(const Workplace& place, const std::string& run = "run", const std::string& pairs = "{}",
             const std::vector<StudyRecord>& more = {}) {
  std::filesystem::create_directories(place / (run + "/selections"));
  place.put(run + "/manifest.json", R"json({"experiments": [{"name": "noise", "title": "Noise", "figure": "a",
    "dataset": "b3r", "attribute": "noise_pr", "axis": "noise (pr)",
    "levels": [{"label": "0.1", "low": 0.1, "high": 0.1},
    {"label": "0.2", "low": 0.2, "high": 0.2}], "methods": ["ss", "gc"], "foreign_methods": [], "threshold_pr": 4, "least_true_matches": 3}],
    "pairs": )json" + pairs + "}");
  std::vector<StudyRecord> records = {
      record_of("a", "ss", 0.5),  record_of("b", "ss", 3.0),     record_of("c", "ss", {}),
      record_of("c2", "ss", 6.0), record_of("d", "ss", 1.0),     record_of("e", "ss", {}),
      record_of("a", "gc", 1.0),  record_of("a", "oracle", 0.5), record_of("other", "ss", 4.0)};
  const double precisions[] = {0.25, 0.75, 0, 1, 1, 1, 0.75, 1, 0.25};
  for (std::size_t i = 0; i < records.size(); ++i) records[i].selected = 4, records[i].precision = precisions[i];
  records[2].selected = 0, records[2].precision = std::nullopt;  // empty
  records[4].true_matches = 2;                                   // excluded
  records[5].matches.reset();                                    // failed
  records[8].level = "0.2";
  records.insert(records.end(), more.begin(), more.end());
  std::string text = csv_line(record_columns());
  for (const StudyRecord& record : records) text += record_line(record);
  place.put(run + "/records.csv", text);
}

StudyFigures figures_of(const std::vector<StudyFolder>& runs) { return study_figures(results_of(runs)); }

const Panel& panel_named(const StudyFigures& figures, const std::string& name) {
  for (const PanelFigure& figure : figures.panels)
    for (const Panel& panel : figure.panels)
      if (panel.name == name) return panel;
  throw std::out_of_range(name);
}

TEST(StudyFigures, TakeTheMeansAsTheyStandAndLeaveGaps) {
  const Workplace place;
  put_run(place);
  const StudyFigures figures = figures_of({read_study(place / "run")});
  std::vector<std::string> names;
  for (const PanelFigure& figure : figures.panels) {
    names.push_back(figure.name + ":");
    for (const Panel& panel : figure.panels) names.push_back(panel.name);
    EXPECT_EQ(figure.title, "(a) Noise, b3r");
  }
  EXPECT_THAT(names, ::testing::ElementsAre("noise-b3r-precision-recall:", "noise-b3r-precision", "noise-b3r-recall",
                                            "noise-b3r-f1:", "noise-b3r-f1",
                                            "noise-b3r-registration:", "noise-b3r-initial-success", "noise-b3r-success",
                                            "noise-b3r-success-in-time:", "noise-b3r-success-in-time",
                                            "noise-b3r-success-curve:",
                                            "noise-b3r-success-curve"));  // nobody tried the dense pose
  const Panel& precision = panel_named(figures, "noise-b3r-precision");
  ASSERT_EQ(precision.series.size(), 2U);  // without the bounds
  EXPECT_EQ(precision.series[0].values[0].value, 0.5);
  EXPECT_GT(precision.series[0].values[0].high, 0.5);
  EXPECT_EQ(precision.series[1].values[0].value, 0.75);
  EXPECT_FALSE(precision.series[1].values[1].value);  // a gap: neither 0 nor that of another level
  EXPECT_EQ(precision.y_axis, "precision");
  EXPECT_EQ(precision.level_counts[0].cells, (std::vector<std::string>{"4", "1"}));
  EXPECT_EQ(precision.level_counts[1].cells, (std::vector<std::string>{"1", "0"}));
  EXPECT_EQ(precision.series_counts[0].cells, (std::vector<std::string>{"1", "0"}));
  const Panel& success = panel_named(figures, "noise-b3r-success");
  ASSERT_EQ(success.series.size(), 3U);
  EXPECT_EQ(success.series[2].method, "oracle");  // the baseline has no value
  EXPECT_EQ(success.y_axis, "aligned within 5 pr");
}

TEST(StudyFigures, LeaveOutAGrouperThatAppliesToNothingWithItsCounts) {
  const Workplace place;
  put_run(place);
  StudyFolder run = read_study(place / "run");
  run.records = {record_of("a", "ss", {}), record_of("a", "gc", {})};
  run.records[0].status = {MethodState::NotApplicable};
  run.records[1].selected = 0;
  const StudyFigures figures = figures_of({run});
  const Panel& recall = panel_named(figures, "noise-b3r-recall");
  ASSERT_EQ(recall.series.size(), 1U);
  EXPECT_EQ(recall.series[0].method, "gc");
  EXPECT_EQ(recall.series_counts[0].cells, std::vector<std::string>{"1"});
  EXPECT_EQ(recall.level_counts[0].cells, (std::vector<std::string>{"1", "0"}));
}

TEST(StudyFigures, CurvesAndBoxesLeaveExcludedUnjudgedAndFailedPairsOut) {
  const Workplace place;
  StudyRecord unjudged = record_of("f", "ss", {});
  unjudged.true_matches.reset();
  put_run(place, "run", "{}", {unjudged});
  const StudyFigures figures = figures_of({read_study(place / "run")});
  const Panel& curve = panel_named(figures, "noise-b3r-success-curve");
  ASSERT_EQ(curve.series.size(), 3U);
  EXPECT_EQ(curve.levels.front(), "0.5");
  EXPECT_EQ(curve.levels.back(), "5");
  EXPECT_EQ(curve.series[0].values.front().value, 0.2);  // 0.5 pr of the five pairs that count
  EXPECT_EQ(curve.series[0].values.back().value, 0.6);
  ASSERT_EQ(figures.boxes.size(), 1U);
  EXPECT_EQ(figures.boxes[0].boxes[0].pairs, 5);
  EXPECT_EQ(figures.boxes[0].boxes[0].without, 1);
}

TEST(StudyFigures, TimesAreMediansOnLogarithmicAxes) {
  const Workplace place;
  put_run(place);
  StudyFolder run = read_study(place / "run");
  run.experiments[0].attribute = "table_size";
  run.records.clear();
  for (const double time_ms : {1.0, 2.0, 9.0}) {
    run.records.push_back(record_of("a", "gc", {}));
    run.records.back().time_ms = time_ms;
  }
  const StudyFigures figures = figures_of({run});
  ASSERT_EQ(figures.panels.size(), 1U);
  const Panel& panel = panel_named(figures, "noise-b3r-time");
  EXPECT_EQ(panel.axes, PanelAxes::Logarithmic);
  ASSERT_EQ(panel.series.size(), 1U) << "a grouper without times is not drawn";
  EXPECT_EQ(panel.series[0].method, "gc");
  EXPECT_EQ(panel.series[0].values[0].value, 2);
  EXPECT_EQ(panel.series[0].values[0].low, 1.5);
}

TEST(StudyFigures, RefuseTheSameExperimentTwice) {
  const Workplace place;
  put_run(place);
  const StudyFolder run = read_study(place / "run");
  EXPECT_THROW(figures_of({run, run}), IoError);
}

TEST(Report, ARunThatIsHalfMadeOrTwiceTheSameIsNamed) {
  const Workplace place;
  put_run(place);
  put_run(place, "again");
  for (const char* command : {"report run again -o out", "claims run again"})
    EXPECT_THAT(place.corral(command).err, AllOf(StartsWith("corral: again: "), HasSubstr("is in another study too")));
  std::filesystem::remove(place / "run/records.csv");
  for (const char* command : {"report run -o out", "claims run", "compare run"}) {
    const Outcome outcome = place.corral(command);
    EXPECT_EQ(outcome.status, 3);
    EXPECT_THAT(outcome.err, StartsWith("corral: run: is unfinished"));
  }
  place.put("run/manifest.json", "{");
  const Outcome outcome = place.corral("compare run");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("run/manifest.json, byte 2: is not JSON"), Not(HasSubstr("exception"))));
  EXPECT_FALSE(std::filesystem::exists(place / "out"));
}

TEST(Gallery, TakesThePairInTheMiddleOfEachDataSet) {
  StudyFolder run;
  const auto add = [&](const std::string& dataset, const std::string& pair, int true_matches) {
    StudyRecord record = record_of(pair, "ss", {});
    record.dataset = dataset;
    record.true_matches = true_matches;
    record.selection = "selections/" + pair + ".csv";
    run.records.push_back(record);
    run.pairs[dataset + "/" + pair].source = "model.ply";
  };
  for (const auto& [pair, count] : {std::pair<const char*, int>{"a", 9}, {"b", 1}, {"c", 5}, {"d", 7}})
    add("b3r", pair, count);
  add("u3m", "a", 3);
  add("u3m", "table", 2);
  run.pairs["u3m/table"].source.clear();  // of matches alone: there is nothing to draw
  run.records.push_back(record_of("no selection", "ss", {}));
  const std::vector<StudyFolder> runs = {run};
  const auto names = [&](const std::vector<std::string>& asked) {
    std::vector<std::string> found;
    for (const GalleryPair& pair : choose_gallery(runs, asked)) found.push_back(pair.name());
    return found;
  };
  EXPECT_THAT(names({}), ::testing::ElementsAre("b3r/c", "u3m/a"));  // of shares 1, 5, 7, 9 the lower middle
  EXPECT_THAT(names({"a", "b3r/d"}), ::testing::ElementsAre("b3r/a", "u3m/a", "b3r/d"));
  EXPECT_THROW(names({"no selection"}), InvalidInput);
  EXPECT_THROW(names({"u3m/d"}), InvalidInput);
}

TEST(Report, WithoutGnuplotEverythingElseIsThere) {
  const Workplace place;
  put_run(place);
  const EmptyPath path;
  const Outcome outcome = place.corral("report run -o out");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("gnuplot cannot be run"), HasSubstr("out")));
  EXPECT_EQ(testing::lines_in(outcome.err), 1U);
  for (const char* file : {"data/noise-b3r-precision.csv", "tables/noise-b3r-precision.tex",
                           "scripts/noise-b3r-precision-recall.gp", "data/noise-b3r-mean-error.csv"})
    EXPECT_TRUE(std::filesystem::exists(place / ("out/" + std::string(file)))) << file;
}

TEST(Report, SameRunSameBytes) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const Workplace place;
  put_run(place);
  for (const char* out : {"one", "two"}) {
    const Outcome outcome = place.corral("report run -o " + std::string(out));
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "the report is " + std::string(out) + "/index.html\n");
  }
  for (const std::string name :
       {"noise-b3r-precision-recall", "noise-b3r-registration", "noise-b3r-success-curve", "noise-b3r-mean-error"})
    for (const char* ending : {".pdf", ".svg"}) {
      const std::string file = "/figures/" + name + ending;
      EXPECT_EQ(place.text("one" + file), place.text("two" + file)) << file;
      EXPECT_GT(place.text("one" + file).size(), 2000U);
    }
  EXPECT_THAT(place.text("one/figures/noise-b3r-f1.pdf"), HasSubstr("/CreationDate (D:19700101000000"));
  EXPECT_THAT(place.text("one/figures/noise-b3r-f1.svg"), AllOf(HasSubstr("GC"), HasSubstr("noise (pr)")));
}

/// A pair with files as corral evaluate writes them; without a mesh if it is told so.
void put_pair_run(const Workplace& place, const std::string& target) {
  place.put_pair();
  const std::string selection = "selections/b3r-ball.csv";
  StudyRecord record = record_of("ball", "ss", 0.25);
  record.selection = selection;
  put_run(
      place, "run",
      R"({"b3r/ball": {"source": "model.ply", "target": ")" + target + R"(", "truth": "truth.txt", "resolution": 1}})",
      {record});
  PairSelections selections{{0, 700, 1400}, {0, 700, 5}, {0.5, 4, 99}, {{"ss", {0, 2}}}};
  place.put("run/" + selection, selections_text(selections, {"ss", "gc"}));
  place.put("run/selections/b3r-ball.poses.csv",
            poses_text({{"ss", "initial", read_transform(place / "truth.txt")}, {"ss", "refined", {}}}));
}

TEST(Report, DrawsPairs) {
  const Workplace place;
  put_pair_run(place, "copy.ply");
  const EmptyPath path;  // the pictures need no gnuplot
  const Outcome nobody = place.corral("report run -o out --pairs b3r/bal");
  EXPECT_EQ(nobody.status, 3);
  EXPECT_THAT(nobody.err, HasSubstr("--pairs is b3r/bal, expected a pair with selections, such as b3r/ball"));
  EXPECT_EQ(place.corral("report run -o out").status, 1);
  for (const char* name : {"matches", "SS", "GC", "all_matches", "aligned"})
    EXPECT_THAT(place.text("out/pairs/b3r-ball-" + std::string(name) + ".png"), StartsWith("\x89PNG")) << name;
  EXPECT_EQ(place.corral("report run -o again --pairs b3r/ball").status, 1);
  EXPECT_EQ(place.text("again/pairs/b3r-ball-matches.png"), place.text("out/pairs/b3r-ball-matches.png"));
}

TEST(Report, AMissingMeshCostsOnlyItsPictures) {
  const Workplace place;
  put_pair_run(place, "gone.ply");
  const Outcome outcome = place.corral("report run -o out");
  EXPECT_EQ(outcome.status, has_gnuplot() ? 4 : 1);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("no pictures of b3r/ball"), HasSubstr("gone.ply")));
  EXPECT_TRUE(std::filesystem::exists(place / "out/tables/noise-b3r-precision.tex"));
}

TEST(Draw, MatchesAndPoses) {
  const Workplace place;
  place.put_pair();
  ASSERT_EQ(place.corral("match model.ply copy.ply -o matches.csv").status, 0);
  for (const char* method : {"gc", "ss"})
    ASSERT_EQ(place.corral("group matches.csv -m " + std::string(method) + " -o group_" + method + ".csv").status, 0);
  const std::string draw = "draw model.ply copy.ply --width 300 ";
  for (const std::string arguments :
       {"--matches matches.csv -o a.png", "--matches matches.csv --group group_gc.csv --truth truth.txt -o b.png",
        "--matches matches.csv --group group_gc.csv group_ss.csv -o c.png", "--pose truth.txt -o d.png"}) {
    const Outcome outcome = place.corral(draw + arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.out + outcome.err, "");
    const std::string name = arguments.substr(arguments.size() - 5), bytes = place.text(name);
    EXPECT_THAT(bytes, StartsWith("\x89PNG")) << arguments;
    EXPECT_EQ(place.corral(draw + arguments).status, 0);
    EXPECT_EQ(place.text(name), bytes) << arguments;
  }
  EXPECT_EQ(place.corral(draw + "-o e.png").status, 2);
  EXPECT_EQ(place.corral(draw + "--matches matches.csv --pose truth.txt -o e.png").status, 2);
  EXPECT_EQ(place.corral(draw + "--pose truth.txt --group group_gc.csv -o e.png").status, 2);
  EXPECT_EQ(place.corral(draw + "--pose truth.txt -o e.jpg").status, 2);
  EXPECT_EQ(place.corral("draw model.ply copy.ply --width 9 --pose truth.txt -o e.png").status, 2);
  place.put("group_gc.csv", "row,selected,score\n0,1,\n");  // of another table
  EXPECT_EQ(place.corral(draw + "--matches matches.csv --group group_gc.csv -o e.png").status, 3);
  EXPECT_THAT(place.names(), Not(Contains("e.png")));
}

}  // namespace
}  // namespace corral
