// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <regex>

#include "apps/results/study_folder.h"
#include "apps/runtime/stopwatch.h"
#include "apps/study/study.h"
#include "kernel/number_text.h"
#include "tests/support/small_study.h"

namespace corral {
namespace {

using namespace testing;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class Evaluate : public ::testing::Test {
 protected:
  Evaluate() {
    put_small_dataset(place_);
    place_.put("small.toml", kSmallExperiment);
  }
  Outcome evaluate(const std::string& rest) const { return place_.corral("evaluate small.toml --data data " + rest); }
  std::map<std::string, std::string> content(const std::string& run) const { return lasting_files(place_, run); }
  const Workplace place_;
};

TEST_F(Evaluate, WritesARunThatReadsBack) {
  const Outcome outcome = evaluate("-o run --jobs 2");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("6 pairs, 0 failed"));
  EXPECT_THAT(outcome.out, HasSubstr("precision"));
  const StudyFolder run = read_study(place_ / "run");
  EXPECT_EQ(run.experiments.at(0).levels.size(), 3u);
  EXPECT_EQ(run.records.size(), 6u * (7 + 1 + 2));  // seven methods, one of them twice, and the bounds
  ASSERT_EQ(run.pairs.size(), 6u);
  for (const auto& [name, pair] : run.pairs) {
    EXPECT_GT(pair.resolution, 0);
    EXPECT_TRUE(std::filesystem::exists(pair.source));
  }
  for (const StudyRecord& record : run.records) {
    EXPECT_EQ(record.level, to_text(*record.value));
    if (record.method == "oracle") {
      EXPECT_EQ(record.precision, 1);
    }
    if (record.method == "baseline") {
      EXPECT_EQ(record.recall, 1);
    }
    if (record.selection.empty()) continue;
    const PairSelections selections = read_selections(place_ / "run/" + record.selection);
    const Indices& selected = selections.selected.at(record.method);
    EXPECT_EQ(static_cast<int>(selected.size()), *record.selected);
    int correct = 0;
    for (const int row : selected) correct += selections.residual_pr[static_cast<std::size_t>(row)] <= 4;
    EXPECT_EQ(correct, *record.correct);
    const std::string poses = record.selection.str().substr(0, record.selection.str().size() - 4) + ".poses.csv";
    EXPECT_FALSE(read_poses(place_ / "run/" + poses).empty());
  }
  const auto manifest = nlohmann::json::parse(place_.text("run/manifest.json"));
  EXPECT_EQ(manifest["inputs"]["b3r/m1-0.05"]["source"].get<std::string>().size(), 32u);
  EXPECT_EQ(manifest["experiments"][0]["options"]["gc"]["tolerance_pr"], 3);
  EXPECT_EQ(manifest["program"]["libraries"]["Eigen"].get<std::string>().front(), '3');
  EXPECT_THAT(manifest["command_line"].get<std::string>(), StartsWith("corral evaluate small.toml"));
}

// One record is what 'corral run' says of the pair.
TEST_F(Evaluate, AgreesWithRun) {
  ASSERT_EQ(evaluate("-o run").status, 0);
  const auto json =
      place_
          .corral(
              "run data/b3r/m2.ply data/b3r/m2-0.25.ply --truth data/b3r/m2-0.25.txt --json --detector "
              "uniform --set uniform.spacing_pr=2.5 --set shot.radius_pr=8 --resolution source -o ran --explain")
          .json();
  const auto& methods = json["methods"];
  const auto report = nlohmann::json::parse(place_.text("ran/match_report.json"));
  const StudyPair pair = read_study(place_ / "run").pairs.at("b3r/m2-0.25");
  EXPECT_EQ(*pair.source_points, report["source"]["points"]);
  EXPECT_EQ(*pair.source_keypoints, report["source"]["keypoints"]);
  int compared = 0;
  for (const StudyRecord& record : read_study(place_ / "run").records)
    for (const auto& method : methods)
      if (record.pair == "m2-0.25" && method["method"] == record.method.str() && record.method != "ransac") {
        ++compared;
        EXPECT_EQ(*record.precision, method["precision"]);
        EXPECT_EQ(*record.keypoints_in_overlap, json["explanation"]["keypoints_in_overlap"]);
        EXPECT_EQ(*record.refined.rmse_pr, method["rmse_pr"]) << method;
        EXPECT_EQ(*record.refined.mean_error_pr, method["mean_error_pr"]) << method;
      }
  EXPECT_EQ(compared, 6);
}

TEST_F(Evaluate, JobsCacheAndOrderDoNotMatter) {
  ASSERT_EQ(evaluate("-o one --jobs 1 --cache shared").status, 0);
  ASSERT_EQ(evaluate("-o two --jobs 2").status, 0);
  ASSERT_EQ(evaluate("-o cached --jobs 2 --cache shared").status, 0);
  EXPECT_EQ(content("one"), content("two"));
  EXPECT_EQ(content("one"), content("cached"));
}

// Killed at some moments and called again, the run ends as if nothing had been.
TEST_F(Evaluate, GoesOnAfterBeingKilled) {
  Stopwatch watch;
  ASSERT_EQ(evaluate("-o whole").status, 0);
  const double span = watch.lap_ms() / 1000;
  int killed = 0;
  for (int call = 1; call <= 8; ++call) {
    const std::string line = "cd '" + (place_ / "") + "' && timeout -s KILL " + std::to_string(span * call / 16) +
                             " '" CORRAL_PROGRAM "' evaluate small.toml --data data -o cut --jobs 2 >log 2>&1";
    killed += std::system(line.c_str()) != 0;
  }
  EXPECT_GT(killed, 0);
  const Outcome outcome = evaluate("-o cut --jobs 1");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(content("cut"), content("whole"));
}

// A pair that is there is not done again; one whose line or whose selections are damaged is.
TEST_F(Evaluate, WhatIsDoneStaysAndWhatIsDamagedIsDoneAgain) {
  ASSERT_EQ(evaluate("-o run --jobs 1").status, 0);
  const auto before = content("run");
  const std::string journal = place_ / "run/units/1-of-1.1.journal";
  std::vector<std::string> lines = lines_of(text_of(journal));
  ASSERT_EQ(lines.size(), 1 + 6u);
  const std::vector<std::string> whole = lines;
  lines[1] = lines[1].substr(0, 40);
  lines[2] = std::regex_replace(lines[2], std::regex("\"correct\":\\[[0-9]+"), "\"correct\":[999999999");
  lines[3] = hashed("{}");
  lines[4] = hashed(std::regex_replace(lines[4].substr(33), std::regex("\"correct\":\\[[0-9]+\\]"), "\"correct\":[]"));
  lines.back().pop_back();  // the last line was not written to its end
  put_text(journal, joined(lines));
  std::filesystem::remove_all(place_ / "run/cache");
  const std::string times = place_.text("run/records.csv");
  ASSERT_EQ(evaluate("-o run --jobs 1").status, 0);
  EXPECT_EQ(content("run"), before);
  EXPECT_EQ(text_of(journal), joined(lines)) << "a call writes to its own file alone";
  const std::vector<std::string> again = lines_of(place_.text("run/units/1-of-1.2.journal"));
  ASSERT_EQ(again.size(), 1 + 5u);
  for (const std::string& line : again)
    EXPECT_NE(line.substr(33, 50), whole[5].substr(33, 50)) << "the fifth was whole";
  EXPECT_NE(place_.text("run/records.csv"), times);  // five pairs have new times
}

TEST_F(Evaluate, SelectionsThatAreGoneAreMadeAgain) {
  ASSERT_EQ(evaluate("-o run").status, 0);
  const auto before = content("run");
  std::filesystem::remove(place_ / "run/selections/b3r/2.5pr/m1-0.25.csv");
  place_.put("run/selections/b3r/2.5pr/m1-0.25.csv.part-Ab12Cd", "half");
  ASSERT_EQ(evaluate("-o run").status, 0);
  EXPECT_EQ(content("run"), before);
}

TEST_F(Evaluate, APairThatCouldNotBeReadIsDoneWhenItCan) {
  const std::string mesh = place_.text("data/b3r/m1-0.25.ply");
  std::filesystem::remove(place_ / "data/b3r/m1-0.25.ply");
  ASSERT_EQ(evaluate("-o run").status, 4);
  place_.put("data/b3r/m1-0.25.ply", mesh);
  ASSERT_EQ(evaluate("-o run").status, 0);
  ASSERT_EQ(evaluate("-o whole").status, 0);
  EXPECT_EQ(content("run"), content("whole"));
}

// SIGTERM is what a scheduler sends before it kills.
TEST_F(Evaluate, ASignalEndsItInOrder) {
  for (const auto& [signal, status] : {std::pair("INT", 130), std::pair("TERM", 143)}) {
    place_.put("call", "exec '" CORRAL_PROGRAM "' evaluate small.toml --data data -o run --jobs 1 2>log >/dev/null");
    const std::string line = "cd '" + (place_ / "") +
                             "' && python3 -c 'import signal, os; signal.signal(signal.SIGINT, signal.SIG_DFL); "
                             "os.execvp(\"sh\", [\"sh\", \"call\"])' & call=$!; while [ ! -e '" +
                             (place_ / "run/units") + "' ]; do sleep 0.01; done; kill -" + signal +
                             " $call; wait $call";
    const int ended = std::system(line.c_str());
    EXPECT_EQ(WEXITSTATUS(ended), status);
    EXPECT_THAT(place_.text("log"), ::testing::MatchesRegex("corral: stopped with [0-9] of 6 pairs done; the same "
                                                            "command continues\n"));
    EXPECT_FALSE(std::filesystem::exists(place_ / "run/summary.csv"));
    EXPECT_EQ(evaluate("-o run").status, 0);
    std::filesystem::remove_all(place_ / "run");
  }
}

TEST_F(Evaluate, APairThatFailsIsRecordedWithItsCause) {
  std::filesystem::remove(place_ / "data/b3r/m1-0.25.ply");
  place_.put("data/b3r/m2-0.45.ply", "ply\nformat ascii 1.0\n");
  const Outcome outcome = evaluate("-o run");
  EXPECT_EQ(outcome.status, 4);
  EXPECT_THAT(outcome.err, HasSubstr("6 pairs, 2 failed (records.csv says why); the study is in run"));
  int failed = 0;
  for (const StudyRecord& record : read_study(place_ / "run").records) {
    if (record.pair != "m1-0.25") continue;
    ++failed;
    EXPECT_THAT(to_text(record.status),
                AllOf(StartsWith("failed: "), HasSubstr("m1-0.25.ply"), HasSubstr("does not exist")));
    EXPECT_FALSE(record.matches || record.precision || record.selected);
  }
  EXPECT_EQ(failed, 10);
  const CsvTable summary = read_csv(place_ / "run/summary.csv");
  for (const auto& row : summary.rows) {
    const bool has_failure = row[2] == "0.25" || row[2] == "0.45";
    EXPECT_EQ(row[static_cast<std::size_t>(summary.column("failed"))], has_failure ? "1" : "0");
    EXPECT_EQ(row[static_cast<std::size_t>(summary.column("pairs"))], has_failure ? "1" : "2");
  }
  EXPECT_EQ(evaluate("-o run").status, 4);  // it stays so
}

TEST_F(Evaluate, APairWithoutTruthIsGroupedButNotScored) {
  place_.put("data/b3r/pairs.csv", replaced(place_.text("data/b3r/pairs.csv"), "m1-0.05.txt", ""));
  ASSERT_EQ(evaluate("-o run").status, 0);
  for (const StudyRecord& record : read_study(place_ / "run").records)
    if (record.pair == "m1-0.05") {
      EXPECT_TRUE(record.selected);
      EXPECT_FALSE(record.true_matches || record.precision || record.refined.mean_error_pr);
    }
  const CsvTable summary = read_csv(place_ / "run/summary.csv");
  EXPECT_EQ(summary.rows[0][static_cast<std::size_t>(summary.column("excluded"))], "1");
}

TEST_F(Evaluate, APairWhoseTruthDoesNotFitIsNamedAndCounted) {
  const RigidTransform truth = read_transform(place_ / "data/b3r/m1-0.05.txt");
  place_.put("data/b3r/inverse.txt", transform_text(truth.inverse()));
  place_.put("data/b3r/pairs.csv", replaced(place_.text("data/b3r/pairs.csv"), "m1-0.05.txt", "inverse.txt"));
  const Outcome outcome = evaluate("-o run");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, HasSubstr("warning: truth does not fit: pair m1-0.05: "));
  EXPECT_THAT(outcome.err, HasSubstr("the truth fits inverted: "));
  for (const StudyRecord& record : read_study(place_ / "run").records)
    EXPECT_EQ(record.truth, record.pair == "m1-0.05" ? "inverted" : "fits");
  const CsvTable summary = read_csv(place_ / "run/summary.csv");
  EXPECT_EQ(summary.rows[0][static_cast<std::size_t>(summary.column("misfit"))], "1");
  EXPECT_EQ(summary.rows[0][static_cast<std::size_t>(summary.column("excluded"))], "0");
  EXPECT_EQ(evaluate("-o run --json").json()["misfits"].size(), 1U) << "when it is repeated too";
}

TEST_F(Evaluate, ExplainsWherePairsAreLost) {
  const RigidTransform truth = read_transform(place_ / "data/b3r/m1-0.05.txt");
  place_.put("data/b3r/inverse.txt", transform_text(truth.inverse()));
  place_.put("data/b3r/pairs.csv", replaced(place_.text("data/b3r/pairs.csv"), "m1-0.05.txt", "inverse.txt"));
  const Outcome told = evaluate("-o run --explain");
  EXPECT_EQ(told.status, 0) << told.err;
  EXPECT_THAT(told.out,
              HasSubstr("experiment  grouper   pairs  registered  keypoints  matches  grouping   pose  truth"));
  EXPECT_THAT(told.out,
              ::testing::ContainsRegex("small       oracle        6       0.833      0.000    0.000     0.000"));
  const auto json = evaluate("-o run --explain --json").json()["explanation"];
  ASSERT_EQ(json.size(), 3u * (7 + 2));
  for (const auto& row : json) {
    EXPECT_EQ(row["pairs"], 2);
    EXPECT_EQ(row["truth"], row["level"] == "0.05" ? 0.5 : 0);
    double sum = 0;
    for (const char* stage : {"registered", "keypoints", "matches", "grouping", "pose", "truth", "failed"})
      sum += row[stage].get<double>();
    EXPECT_DOUBLE_EQ(sum, 1) << row;
  }
  EXPECT_EQ(place_.corral("merge run --explain --json").json()["explanation"], json);
  EXPECT_FALSE(evaluate("-o run --json").json().contains("explanation"));
  EXPECT_EQ(evaluate("-o part --shard 1/2 --explain").status, 2);
}

TEST_F(Evaluate, AFolderOfAnotherRunIsRefused) {
  ASSERT_EQ(evaluate("-o run").status, 0);
  place_.put("small.toml", std::string(kSmallExperiment) + "\n[options.gc]\ntolerance_pr = 2\n");
  Outcome outcome = evaluate("-o run");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("other experiments"), HasSubstr("another folder")));
  place_.put("small.toml", kSmallExperiment);
  EXPECT_EQ(evaluate("-o run --dense").status, 3);
  EXPECT_EQ(evaluate("-o run").status, 0);
  place_.put("data/b3r/m1-0.05.txt", replaced(place_.text("data/b3r/m1-0.05.txt"), "\n", " \n"));
  outcome = evaluate("-o run");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("a different version of"), HasSubstr("m1-0.05.txt")));
}

TEST_F(Evaluate, AnUnfinishedStudyIsSaidToBe) {
  std::filesystem::create_directories(place_ / "run/units");
  const Outcome outcome = place_.corral("report run -o report");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, HasSubstr("run: is an unfinished study; repeat the command"));
}

TEST_F(Evaluate, TwoCallsDoNotWorkOnOneRun) {
  std::filesystem::create_directories(place_ / "run");
  {
    const FolderLock lock(place_ / "run");
    const Outcome outcome = evaluate("-o run");
    EXPECT_EQ(outcome.status, 3);
    EXPECT_THAT(outcome.err, HasSubstr("another call"));
  }
  EXPECT_EQ(evaluate("-o run").status, 0);
}

TEST_F(Evaluate, DenseFillsItsOwnColumns) {
  ASSERT_EQ(evaluate("-o run --dense").status, 0);
  for (const StudyRecord& record : read_study(place_ / "run").records)
    EXPECT_EQ(record.dense.mean_error_pr.has_value(), record.refined.mean_error_pr.has_value())
        << record.pair << record.method;
}

// The threshold is for scoring alone: the same selections at all of them, and no precision that falls as it rises.
TEST_F(Evaluate, ThresholdsScoreTheSameSelections) {
  place_.put("small.toml",
             replaced(replaced(kSmallExperiment, "noise_pr", "threshold_pr"), "[0.05, 0.25, 0.45]", "[0.5, 1, 2, 8]"));
  ASSERT_EQ(evaluate("-o run").status, 0);
  std::map<std::string, StudyRecord> last;
  int compared = 0;
  for (const StudyRecord& record : read_study(place_ / "run").records) {
    const std::string key = record.pair.str() + record.method + std::to_string(record.repeat);
    const auto found = last.find(key);
    if (found != last.end() && record.method != "oracle") {
      ++compared;
      EXPECT_EQ(found->second.selected, record.selected);
      EXPECT_LE(*found->second.correct, *record.correct);
      EXPECT_LE(*found->second.true_matches, *record.true_matches);
    }
    last[key] = record;
  }
  EXPECT_EQ(compared, 3 * 6 * 9);
  for (const StudyRecord& record : read_study(place_ / "run").records)
    if (record.method == "oracle") {
      EXPECT_EQ(record.selected, record.true_matches);
    }
}

TEST_F(Evaluate, NumbersOfMatchesAreBinnedAsTheyTurnOut) {
  place_.put("small.toml",
             replaced(replaced(replaced(kSmallExperiment, "noise_pr", "matches"), "levels = [0.05, 0.25, 0.45]",
                               "bins = [[10, 100], [100, 1000]]"),
                      "[options.uniform]\nspacing_pr = 2.5", "[vary.uniform]\nspacing_pr = [2.5, 6, 30]"));
  ASSERT_EQ(evaluate("-o run").status, 0);
  std::map<std::string, int> levels;
  for (const StudyRecord& record : read_study(place_ / "run").records) {
    EXPECT_EQ(record.level, *record.matches < 100 ? "[10,100)" : "[100,1000]");
    EXPECT_EQ(record.value, *record.matches);
    levels[record.level] += record.method == "gc";
  }
  EXPECT_EQ(levels["[10,100)"] + levels["[100,1000]"], 12);  // the tables of the largest radius are in no bin
  EXPECT_GT(levels["[10,100)"], 0);
  EXPECT_GT(levels["[100,1000]"], 0);
}

TEST_F(Evaluate, TimesAreTakenAlone) {
  place_.put("time.toml", replaced(replaced(replaced(kSmallExperiment, "noise_pr", "table_size"), "[0.05, 0.25, 0.45]",
                                            "[20, 60, 100000]"),
                                   "small", "mytime"));
  EXPECT_THAT(place_.corral("evaluate time.toml small.toml --data data -o run").err, HasSubstr("taken alone"));
  EXPECT_EQ(place_.corral("evaluate time.toml --data data -o run --jobs 2").status, 2);
  const Outcome outcome = place_.corral("evaluate time.toml --data data -o run");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "the study is in run\n");
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("upper quartile"), Not(HasSubstr("quartiles"))));
  const CsvTable times = read_csv(place_ / "run/time.csv");
  EXPECT_EQ(times.rows.size(), 14u);  // no table has 100000 rows
  const StudyFolder run = read_study(place_ / "run");
  EXPECT_EQ(run.records.size(), 28u);
  for (const StudyRecord& record : run.records) {
    EXPECT_GT(*record.time_ms, 0);
    EXPECT_EQ(to_text(*record.matches), record.level);
  }
}

TEST_F(Evaluate, SaysWhatIsWrongWithTheCall) {
  EXPECT_EQ(evaluate("-o run --jobs 0").status, 2);
  const Outcome unknown = place_.corral("evaluate nose --data data -o run");
  EXPECT_EQ(unknown.status, 3);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean 'noise'?"));
  EXPECT_THAT(place_.corral("evaluate overlap --data data -o run").err, HasSubstr("it has b3r"));
  EXPECT_FALSE(std::filesystem::exists(place_ / "run"));
  EXPECT_THAT(place_.corral("evaluate --help").out, AllOf(HasSubstr("tuning-spectral"), HasSubstr("Examples")));
}

// A real cluttered scene: few right matches among many, which all groupers must live with.
TEST(EvaluateRealData, AClutteredScene) {
  const char* folder = std::getenv("CORRAL_REAL_DATA");
  if (!folder) GTEST_SKIP() << "CORRAL_REAL_DATA does not name the folder of the real data sets";
  const Workplace place;
  const std::string root = std::string(folder) + "/u3or/";
  std::filesystem::create_directories(place / "u3or");
  place.put("u3or/dataset.toml", "name = \"u3or\"\n");
  place.put("u3or/pairs.csv", "pair,source,target,truth,occlusion\nparasaurolophus-rs1," + root +
                                  "models/parasaurolophus_low_normals2.ply," + root + "scenes/rs1_normals.ply," + root +
                                  "gt/parasaurolophus-rs1.xf,67.8\n");
  const Outcome outcome = place.corral("evaluate occlusion --data . -o run");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const StudyFolder run = read_study(place / "run");
  EXPECT_EQ(run.records.size(), 9u);
  for (const StudyRecord& record : run.records) {
    EXPECT_EQ(record.level, "[65,70)");
    EXPECT_GT(*record.true_matches, 0);
    EXPECT_LT(*record.true_matches, *record.matches / 10);
  }
}

}  // namespace
}  // namespace corral
