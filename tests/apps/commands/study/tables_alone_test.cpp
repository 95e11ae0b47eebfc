// SPDX-License-Identifier: MIT
// Pairs that are tables of matches, without surfaces: run --matches, evaluate, dataset check.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "apps/results/study_folder.h"
#include "kernel/evaluation.h"
#include "tests/support/small_study.h"

namespace corral {
namespace {

using namespace testing;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr char kMatching[] =
    " --detector uniform --set uniform.spacing_pr=2.5 --set shot.radius_pr=8 --resolution source";

/// The small data set, and data sets of its tables: with all columns, and with coordinates alone.
class TablesAlone : public ::testing::Test {
 protected:
  TablesAlone() {
    put_small_dataset(place_);
    place_.put("small.toml", kSmallExperiment);
    put_tables("tables", [](const std::string& table) { return table; });
    put_tables("bare", [](const std::string& table) {
      CorrespondenceSet matches = read(table);
      CorrespondenceSet bare;
      bare.source_points = matches.source_points, bare.target_points = matches.target_points;
      bare.resolution = matches.resolution;
      return matches_text(bare);
    });
  }

  static CorrespondenceSet read(const std::string& text) {
    const ScratchFolder folder;
    return read_matches(put_text(folder / "table.csv", text));
  }

  template <class Change>
  void put_tables(const std::string& set, const Change& change) {
    std::filesystem::create_directories(place_ / (set + "/b3r"));
    place_.put(set + "/b3r/dataset.toml", "name = \"b3r\"\nresolution = \"source\"\n");
    std::string pairs = "pair,source,target,truth,matches,noise_pr\n";
    for (const std::string model : {"m1", "m2"})
      for (const std::string noise : {"0.05", "0.25", "0.45"}) {
        const std::string name = model + "-" + noise;
        if (!std::filesystem::exists(place_ / (name + ".csv"))) {
          EXPECT_EQ(
              place_
                  .corral("match data/b3r/" + model + ".ply data/b3r/" + name + ".ply -o " + name + ".csv" + kMatching)
                  .status,
              0);
        }
        place_.put(set + "/b3r/" + name + ".csv", change(place_.text(name + ".csv")));
        place_.put(set + "/b3r/" + name + ".txt", place_.text("data/b3r/" + name + ".txt"));
        pairs += name + ",,," + name + ".txt," + name + ".csv," + noise + "\n";
      }
    place_.put(set + "/b3r/pairs.csv", pairs);
  }

  Outcome evaluate(const std::string& data, const std::string& rest) const {
    return place_.corral("evaluate small.toml --data " + data + " " + rest);
  }
  const Workplace place_;
};

TEST_F(TablesAlone, GiveTheSelectionsAndFitsOfTheirSurfaces) {
  ASSERT_EQ(evaluate("data", "-o surfaces").status, 0);
  const Outcome outcome = evaluate("tables", "-o tables-alone");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto on_surfaces = read_study(place_ / "surfaces").records, alone = read_study(place_ / "tables-alone").records;
  ASSERT_EQ(alone.size(), on_surfaces.size());
  for (std::size_t i = 0; i < alone.size(); ++i) {
    EXPECT_EQ(alone[i].method, on_surfaces[i].method);
    EXPECT_EQ(alone[i].selected, on_surfaces[i].selected) << alone[i].method;
    EXPECT_EQ(alone[i].correct, on_surfaces[i].correct);
    EXPECT_EQ(alone[i].refined.rotation_error_deg, on_surfaces[i].refined.rotation_error_deg);
    EXPECT_EQ(alone[i].refined.translation_error_pr, on_surfaces[i].refined.translation_error_pr);
    EXPECT_EQ(alone[i].truth, "fits");
    EXPECT_FALSE(alone[i].refined.add_share) << "there is no surface";
    if (alone[i].selection.empty()) continue;
    EXPECT_EQ(read_selections(place_ / "tables-alone/" + alone[i].selection).selected,
              read_selections(place_ / "surfaces/" + alone[i].selection).selected);
  }
  EXPECT_EQ(place_.corral("report tables-alone -o report").status, 0) << "nothing to draw is no error";
  EXPECT_EQ(place_.corral("compare tables-alone").status, 0);
}

TEST_F(TablesAlone, WhatNeedsAColumnDoesNotApplyToATableWithoutIt) {
  const Outcome outcome = evaluate("bare", "-o run");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("6 pairs, 0 failed"));
  for (const StudyRecord& record : read_study(place_ / "run").records) {
    const bool needs_more =
        record.method == "ss" || record.method == "nnsr" || record.method == "hough" || record.method == "si";
    EXPECT_EQ(record.status.state == MethodState::NotApplicable, needs_more) << record.method;
    EXPECT_EQ(record.selected.has_value(), !needs_more);
  }
  const CsvTable summary = read_csv(place_ / "run/summary.csv");
  const auto cell = [&](const auto& row, const char* column) {
    return row[static_cast<std::size_t>(summary.column(column))];
  };
  for (const auto& row : summary.rows) {
    EXPECT_EQ(cell(row, "pairs"), cell(row, "method") == "ss" || cell(row, "method") == "nnsr" ||
                                          cell(row, "method") == "hough" || cell(row, "method") == "si"
                                      ? "0"
                                      : "2");
    EXPECT_EQ(cell(row, "failed"), "0");
  }
}

TEST_F(TablesAlone, OfCoordinatesAloneHaveAReportToo) {
  ASSERT_EQ(evaluate("bare", "-o run").status, 0);
  const Outcome outcome = place_.corral("report run -o report");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(place_.text("report/data/small-b3r-success-in-time.csv"), HasSubstr("\"1 s\",4,"));
  const std::string table = place_.text("report/tables/small-b3r-f1.tex");
  EXPECT_THAT(table, AllOf(HasSubstr("{pairs} & 2 & 2 & 2 \\\\"), HasSubstr("{RANSAC}"), Not(HasSubstr("{SS}"))));
}

TEST_F(TablesAlone, AreBinnedByTheirShareOfCorrectMatches) {
  place_.put("small.toml", replaced(replaced(kSmallExperiment, "noise_pr", "inlier_ratio"),
                                    "levels = [0.05, 0.25, 0.45]", "bins = [[0, 20], [20, 50], [50, 100]]"));
  for (const char* data : {"data", "tables"}) {
    const std::string run = std::string("run-") + data;
    ASSERT_EQ(evaluate(data, "-o " + run).status, 0);
    int rows = 0;
    for (const StudyRecord& record : read_study(place_ / run).records) {
      const double percent = 100.0 * *record.true_matches / *record.matches;
      EXPECT_EQ(record.value, percent);
      EXPECT_EQ(record.level, percent < 20 ? "[0,20)" : percent < 50 ? "[20,50)" : "[50,100]");
      ++rows;
    }
    EXPECT_EQ(rows, 6 * 10);
  }
}

TEST_F(TablesAlone, ATruthThatFitsOtherwiseIsNamed) {
  const std::string truth = place_.text("tables/b3r/m1-0.05.txt");
  EXPECT_EQ(place_.corral("dataset check tables/b3r").status, 0);
  place_.put("tables/b3r/m1-0.05.txt", transform_text(read_transform(place_ / "tables/b3r/m1-0.05.txt").inverse()));
  const Outcome check = place_.corral("dataset check tables/b3r");
  EXPECT_THAT(check.out + check.err, AllOf(HasSubstr("m1-0.05.txt"), HasSubstr("the truth fits inverted: ")));
  const Outcome outcome = evaluate("tables", "-o run");
  EXPECT_THAT(outcome.err, HasSubstr("warning: truth does not fit: pair m1-0.05: "));
  const Outcome run = place_.corral("run --matches tables/b3r/m1-0.05.csv --truth tables/b3r/m1-0.05.txt");
  EXPECT_THAT(run.err, HasSubstr("truth does not fit: the truth fits inverted: "));
  place_.put("tables/b3r/m1-0.05.csv", "x");
  const Outcome broken = place_.corral("dataset check tables/b3r");
  EXPECT_THAT(broken.out + broken.err, HasSubstr("m1-0.05.csv"));
}

// A symmetric object: a pose is judged by the nearest of the truths, a selection by the one that it follows.
TEST_F(TablesAlone, SeveralTruthsAreEquallyRight) {
  const CorrespondenceSet matches = read(place_.text("m1-0.05.csv"));
  const RigidTransform truth = read_transform(place_ / "data/b3r/m1-0.05.txt");
  // The rows that were incorrect become correct under a second truth.
  const RigidTransform second{truth.rotation * RandomStream(5).rotation(), 2 * truth.translation};
  CorrespondenceSet symmetric = matches;
  const std::vector<bool> labels = label_correct(matches, truth, 4);
  int changed = 0;
  for (int row = 0; row < matches.size(); ++row)
    if (!labels[static_cast<std::size_t>(row)]) {
      ++changed;
      symmetric.target_points.row(row) =
          (second.rotation * matches.source_points.row(row).transpose() + second.translation).transpose();
    }
  const int kept = matches.size() - changed;
  std::filesystem::create_directories(place_ / "two");
  place_.put("two/dataset.toml", "name = \"b3r\"\n");
  place_.put("two/t.csv", matches_text(symmetric));
  place_.put("two/a.txt", transform_text(truth));
  place_.put("two/b.txt", transform_text(second));
  const auto oracle_and_ransac = [&](const std::string& truths) {
    place_.put("two/pairs.csv", "pair,source,target,truth,matches,noise_pr\np,,," + truths + ",t.csv,0.05\n");
    EXPECT_EQ(
        place_
            .corral("evaluate small.toml --data two -o " + truths.substr(0, 1) + "run" + std::to_string(truths.size()))
            .status,
        0);
    std::map<std::string, StudyRecord> found;
    for (const StudyRecord& record :
         read_study(place_ / (truths.substr(0, 1) + "run" + std::to_string(truths.size()))).records)
      found[record.method.str()] = record;
    return found;
  };
  auto first = oracle_and_ransac("a.txt"), other = oracle_and_ransac("b.txt"), both = oracle_and_ransac("a.txt;b.txt");
  EXPECT_EQ(*first["oracle"].selected, kept);
  EXPECT_EQ(*other["oracle"].selected, changed);
  EXPECT_EQ(*both["oracle"].selected, std::max(kept, changed)) << "as a whole: never rows of both";
  EXPECT_EQ(*both["oracle"].true_matches, std::max(kept, changed));
  for (const char* method : {"ransac", "gc", "st"}) {
    const StudyRecord& under_both = both[method];
    EXPECT_EQ(*under_both.correct, std::max(*first[method].correct, *other[method].correct)) << method;
    EXPECT_EQ(*under_both.recall,
              *first[method].correct >= *other[method].correct ? *first[method].recall : *other[method].recall);
    EXPECT_EQ(*under_both.refined.rotation_error_deg,
              std::min(*first[method].refined.rotation_error_deg, *other[method].refined.rotation_error_deg));
  }
  place_.put("two/pairs.csv", "pair,source,target,truth,matches,noise_pr\np,,,a.txt;c.txt,t.csv,0.05\n");
  const Outcome check = place_.corral("dataset check two");
  EXPECT_THAT(check.out + check.err, HasSubstr("does not exist"));
}

TEST_F(TablesAlone, RunTakesATableAsEvaluateDoes) {
  const std::string pair = " --truth data/b3r/m2-0.25.txt --json";
  const auto matched = place_.corral("run data/b3r/m2.ply data/b3r/m2-0.25.ply -o matched" + pair + kMatching).json();
  const auto alone = place_.corral("run --matches matched/matches.csv" + pair).json();
  const auto beside =
      place_.corral("run data/b3r/m2.ply data/b3r/m2-0.25.ply --matches matched/matches.csv" + pair).json();
  ASSERT_EQ(alone["methods"].size(), matched["methods"].size());
  for (std::size_t i = 0; i < matched["methods"].size(); ++i) {
    const auto &on_surfaces = matched["methods"][i], &on_table = alone["methods"][i], &on_both = beside["methods"][i];
    for (const char* key :
         {"method", "selected", "precision", "recall", "rotation_error_deg", "translation_error_pr"}) {
      EXPECT_EQ(on_table.at(key), on_surfaces.at(key)) << key;
      EXPECT_EQ(on_both.at(key), on_surfaces.at(key)) << key;
    }
    EXPECT_EQ(on_both["mean_error_pr"], on_surfaces["mean_error_pr"]) << "beside their meshes";
    EXPECT_TRUE(on_table["add_share"].is_null());
  }
  EXPECT_THAT(place_.corral("run --matches matched/matches.csv").out,
              AllOf(HasSubstr("matched/matches.csv: "), Not(HasSubstr("overlap"))));
}

TEST_F(TablesAlone, SaysWhatIsWrongWithTheCall) {
  EXPECT_THAT(place_.corral("run").err, HasSubstr("expected two meshes, or --matches"));
  EXPECT_EQ(place_.corral("run one.ply").status, 2);
  EXPECT_THAT(place_.corral("run --matches x.csv --dense").err, HasSubstr("--dense: needs two meshes"));
  place_.put("tables/b3r/pairs.csv", "pair,source,target,truth,matches\np,a.ply,,,m.csv\n");
  EXPECT_THAT(evaluate("tables", "-o run").err, HasSubstr("expected both, or a table of matches"));
}

}  // namespace
}  // namespace corral
