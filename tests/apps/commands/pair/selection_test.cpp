// SPDX-License-Identifier: MIT
// corral group, refine and score, as a user types them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "grouping/registry.h"
#include "kernel/evaluation.h"
#include "tests/support/program.h"

namespace corral {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using testing::expect_ok;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using testing::keys_of;
using testing::lines_in;
using ::testing::Not;
using testing::Outcome;
using ::testing::StartsWith;
using testing::Workplace;

TEST(Group, SelectsWithEveryMethod) {
  const Workplace place;
  const CorrespondenceSet matches = place.put_problem().matches;
  for (const Grouper& grouper : groupers()) {
    const Outcome printed = place.corral("group matches.csv --method " + grouper.name);
    expect_ok(printed);
    const GroupingResult found = grouper.configure({}).group(matches);
    EXPECT_EQ(printed.out, group_text({100, found.selected, found.scores})) << grouper.name;
    expect_ok(place.corral("group matches.csv -m " + grouper.name + " -o of_" + grouper.name + ".csv"));
    EXPECT_EQ(place.text("of_" + grouper.name + ".csv"), printed.out);
  }
}

TEST(Group, JsonHoldsTheOptionsAndTheMedianTime) {
  const Workplace place;
  place.put_problem();
  const Outcome outcome = place.corral(
      "group matches.csv -m ransac --set ransac.seed=7 --set ransac.iterations=500 --repeat 3 --json -o g.csv");
  expect_ok(outcome);
  const auto json = outcome.json();
  EXPECT_THAT(keys_of(json), ElementsAre("matches", "method", "options", "repeat", "selected", "status", "time_ms",
                                         "working_memory_bytes"));
  EXPECT_EQ(json["method"], "ransac");
  EXPECT_EQ(json["matches"], 100);
  EXPECT_EQ(json["repeat"], 3);
  EXPECT_GT(json["time_ms"], 0);
  EXPECT_EQ(json["options"]["seed"], 7);
  EXPECT_EQ(json["options"]["iterations"], 500);
  EXPECT_EQ(json["options"]["tolerance_pr"], 5);
  EXPECT_EQ(json["selected"], read_group(place / "g.csv").selected.size());
}

TEST(Group, AnotherProgramIsCalled) {
  const Workplace place;
  place.put_problem();
  const Outcome one = place.corral("group matches.csv --external 'mine=cp group.csv {group} {matches}'");
  EXPECT_EQ(one.status, 4);
  EXPECT_THAT(one.err, HasSubstr("corral group: mine: ended with status 1; it said: cp: "));
  const std::string mine = " --external \"mine=sh -c 'cp $(pwd)/group.csv \\\"\\$1\\\"' x {group} {matches}\"";
  const Outcome printed = place.corral("group matches.csv" + mine);
  EXPECT_EQ(printed.status, 0) << printed.err;
  EXPECT_EQ(printed.out, place.text("group.csv"));
  const Outcome several = place.corral("group matches.csv -m ss,gc" + mine + " -o all --json");
  EXPECT_EQ(several.status, 0) << several.err;
  const auto json = several.json();
  EXPECT_EQ(json[2]["method"], "mine");
  EXPECT_EQ(json[2]["selected"], 60);
  EXPECT_GT(json[2]["start_up_ms"], 0);
  EXPECT_EQ(place.text("all/group_mine.csv"), place.text("group.csv"));
  const Outcome run =
      place.corral("run --matches matches.csv --truth truth.txt --methods gc" + mine + " -o run --json");
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.json()["methods"][1]["precision"], 1);
  EXPECT_THAT(run.json()["details"]["options"]["mine"]["command"].get<std::string>(), HasSubstr("{group}"));
  EXPECT_EQ(place.text("run/group_mine.csv"), place.text("group.csv"));
  EXPECT_EQ(place.corral("group matches.csv").status, 2);
  EXPECT_EQ(place.corral("group matches.csv -m gc --external-timeout 0").status, 2);
}

TEST(Group, TooLargeIsAnAnswer) {
  const Workplace place;
  place.put_problem();
  const Outcome outcome = place.corral("group matches.csv -m st --memory-limit 10kB --json -o g.csv");
  EXPECT_EQ(outcome.status, 4);
  EXPECT_THAT(outcome.err,
              HasSubstr("st would use too much memory for 100 matches: needs 0.1 MB, the limit is 0.0 MB"));
  EXPECT_THAT(outcome.json()["status"].get<std::string>(), HasSubstr("too large"));
  EXPECT_TRUE(outcome.json()["selected"].is_null());
  EXPECT_FALSE(std::filesystem::exists(place / "g.csv"));
  EXPECT_EQ(place.corral("group matches.csv -m st --memory-limit 1MB").status, 0);
  EXPECT_EQ(place.corral("group matches.csv -m st --memory-limit much").status, 2);
}

TEST(Group, AMethodSaysWhichColumnIsAbsent) {
  const Workplace place;
  place.put("matches.csv",
            "# corral matches 1\n# resolution 1\nsource_x,source_y,source_z,target_x,target_y,target_z\n1,2,3,4,5,6\n");
  EXPECT_EQ(place.corral("group matches.csv -m gc").status, 0);
  for (const char* method : {"ss", "nnsr", "hough"}) {
    const Outcome outcome = place.corral("group matches.csv -m " + std::string(method));
    EXPECT_EQ(outcome.status, 3);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr(method), HasSubstr("column"), HasSubstr("absent")));
    EXPECT_EQ(lines_in(outcome.err), 1U);
    EXPECT_EQ(outcome.out, "");
  }
}

TEST(Group, FewMatchesAreGroupedWithoutComplaint) {
  const Workplace place;
  for (const int rows : {0, 1, 2}) {
    SyntheticOptions options;
    options.matches = rows;
    place.put("few.csv", matches_text(make_synthetic_problem(options).matches));
    for (const Grouper& grouper : groupers()) {
      expect_ok(place.corral("group few.csv -o group.csv -m " + grouper.name));
      EXPECT_EQ(read_group(place / "group.csv").matches, rows) << grouper.name;
    }
  }
}

TEST(Refine, FindsThePoseAndJudgesIt) {
  const Workplace place;
  const SyntheticProblem problem = place.put_problem();
  const Outcome printed = place.corral("refine matches.csv group.csv");
  EXPECT_EQ(printed.status, 0);
  EXPECT_THAT(printed.err, AllOf(StartsWith("refined, converged after "), Not(HasSubstr("rotation error"))));
  place.put("pose.txt", printed.out);
  const RigidTransform pose = read_transform(place / "pose.txt");
  EXPECT_LT(rotation_error_deg(pose, problem.truth), 0.5);
  const Outcome judged = place.corral("refine matches.csv group.csv --truth truth.txt --json -o again.txt");
  expect_ok(judged);
  EXPECT_EQ(place.text("again.txt"), printed.out);
  const auto json = judged.json();
  EXPECT_THAT(keys_of(json), IsSupersetOf({"status", "target_from_source", "rotation_error_deg", "translation_error_pr",
                                           "rmse_pr", "iterations", "covariance"}));
  EXPECT_EQ(json["status"], "refined");
  EXPECT_EQ(json["rotation_error_deg"], rotation_error_deg(pose, problem.truth));
  EXPECT_EQ(json["translation_error_pr"], translation_error_pr(pose, problem.truth, problem.matches.resolution));
  EXPECT_LT(json["rmse_pr"], 1);
  RigidTransform start;  // the least-squares fit
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) start.rotation(row, column) = json["initial"][row][column];
    start.translation(row) = json["initial"][row][3];
  }
  EXPECT_EQ(json["initial_rotation_error_deg"], rotation_error_deg(start, problem.truth));
  EXPECT_NE(json["initial_rotation_error_deg"], json["rotation_error_deg"]);
  EXPECT_EQ(json["success_5pr"], true);
  EXPECT_TRUE(json["add_share"].is_null()) << "no mesh is seen";
  ASSERT_EQ(json["target_from_source"].size(), 4U);
  EXPECT_EQ(json["target_from_source"][1][3], pose.translation(1));
  EXPECT_EQ(json["target_from_source"][2][0], pose.rotation(2, 0));
  EXPECT_EQ(json["target_from_source"][3], nlohmann::json::parse("[0.0, 0.0, 0.0, 1.0]"));
  EXPECT_EQ(json["covariance"].size(), 6U);
  EXPECT_THAT(place.corral("refine matches.csv group.csv --truth truth.txt -o pose.txt").err,
              AllOf(HasSubstr("rotation error"), HasSubstr("RMSE")));
}

TEST(Refine, TakesALossAndAStart) {
  const Workplace place;
  const SyntheticProblem problem = place.put_problem();
  const auto usual = place.corral("refine matches.csv group.csv --json").json();
  EXPECT_EQ(place.corral("refine matches.csv group.csv --json --loss cauchy --loss-scale-pr 5").json(), usual);
  place.put("start.txt", "0 -1 0 3\n1 0 0 4\n0 0 1 5\n0 0 0 1\n");
  for (const std::string loss : {"none", "huber", "cauchy", "tukey", "geman-mcclure"}) {
    SCOPED_TRACE(loss);
    const std::string command = "refine matches.csv group.csv --json --loss " + loss + " --loss-scale-pr 4";
    const auto json = place.corral(command).json();
    EXPECT_EQ(json["status"], "refined");
    EXPECT_LE(json["final_cost"], json["initial_cost"]);
    EXPECT_GT(json["condition"], 1);
    EXPECT_EQ(json["final_cost"] == usual["final_cost"], false);
    const auto started = place.corral(command + " --start start.txt").json();
    EXPECT_EQ(started["initial"], nlohmann::json::parse("[[0.0,-1.0,0.0,3.0],[1.0,0.0,0.0,4.0],[0.0,0.0,1.0,5.0],"
                                                        "[0.0,0.0,0.0,1.0]]"));
    EXPECT_GT(started["initial_cost"], json["initial_cost"]);
  }
  EXPECT_THAT(place.corral("refine matches.csv group.csv").err, HasSubstr(" pr, cost "));
}

TEST(Refine, WithoutThreeRowsThereIsNoPose) {
  const Workplace place;
  place.put_problem();
  for (const Indices& selected : {Indices{}, Indices{4}, Indices{4, 7}}) {
    place.put("group.csv", group_text({100, selected, {}}));
    const Outcome outcome = place.corral("refine matches.csv group.csv --truth truth.txt --json -o pose.txt");
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.json()["status"], "too few rows");
    for (const char* key : {"target_from_source", "rotation_error_deg", "translation_error_pr", "rmse_pr", "covariance",
                            "condition", "initial_cost", "final_cost"})
      EXPECT_TRUE(outcome.json()[key].is_null()) << key;
    EXPECT_THAT(place.names(), Not(Contains("pose.txt")));
    const Outcome talk = place.corral("refine matches.csv group.csv");
    EXPECT_EQ(talk.status, 0);
    EXPECT_EQ(talk.out, "");
    EXPECT_THAT(talk.err, HasSubstr("no pose: too few rows"));
  }
}

// A script that looks for the file must not find the pose of another selection.
TEST(Refine, AnOlderPoseDoesNotStandInForNone) {
  const Workplace place;
  place.put_problem();
  EXPECT_EQ(place.corral("refine matches.csv group.csv -o pose.txt").status, 0);
  place.put("group.csv", group_text({100, {}, {}}));
  EXPECT_EQ(place.corral("refine matches.csv group.csv -o pose.txt").status, 0);
  EXPECT_THAT(place.names(), Not(Contains("pose.txt")));
}

TEST(Score, CountsAndDivides) {
  const Workplace place;
  const SyntheticProblem problem = place.put_problem();
  const GroupingScore score = score_grouping(label_correct(problem.matches, problem.truth, 4), problem.inliers);
  const Outcome outcome = place.corral("score matches.csv group.csv --truth truth.txt --json");
  expect_ok(outcome);
  const auto json = outcome.json();
  EXPECT_EQ(json["matches"], 100);
  EXPECT_EQ(json["selected"], 60);
  EXPECT_EQ(json["correct"], score.correct);
  EXPECT_EQ(json["true_matches"], score.true_matches);
  EXPECT_EQ(json["precision"], score.precision.value());
  EXPECT_EQ(json["recall"], score.recall.value());
  EXPECT_EQ(json["f1"], score.f1.value());
  EXPECT_EQ(place.corral("score matches.csv group.csv --truth truth.txt --json --threshold-pr 1e9").json()["correct"],
            60);
  const Outcome text = place.corral("score matches.csv group.csv --truth truth.txt --threshold-pr 1e9");
  expect_ok(text);
  EXPECT_THAT(text.out, StartsWith("matches  selected  correct  all correct  precision  recall"));
  EXPECT_THAT(text.out, HasSubstr("\n    100        60       60          100     1.0000  0.6000  0.7500\n"));
}

TEST(Score, JudgesTheFitToTheSelection) {
  const Workplace place;
  const SyntheticProblem problem = place.put_problem();
  const auto json = place.corral("score matches.csv group.csv --truth truth.txt --json").json();
  const RigidTransform fit = fit_rigid_transform(problem.matches, problem.inliers).value();
  EXPECT_NEAR(json["initial_rotation_error_deg"], rotation_error_deg(fit, problem.truth), 1e-9);
  EXPECT_NEAR(json["initial_translation_error_pr"],
              translation_error_pr(fit, problem.truth, problem.matches.resolution), 1e-9);
  for (const char* key : {"initial_rmse_pr", "initial_add_share", "initial_success_5pr", "initial_success_add"})
    EXPECT_TRUE(json[key].is_null()) << key << ": no mesh is seen";
  EXPECT_THAT(place.corral("score matches.csv group.csv --truth truth.txt").out, HasSubstr("\nfit: rot err deg  "));
  place.put("two.csv", group_text({100, {3, 4}, {}}));
  EXPECT_TRUE(place.corral("score matches.csv two.csv --truth truth.txt --json")
                  .json()["initial_rotation_error_deg"]
                  .is_null());
}

TEST(Score, TakesBothMeshesOrNone) {
  const Workplace place;
  place.put_problem();
  for (const char* one : {"--source", "--target"}) {
    const Outcome outcome =
        place.corral("score matches.csv group.csv --truth truth.txt " + std::string(one) + " model.ply");
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, HasSubstr("expected both meshes or none"));
  }
}

TEST(Score, AnUndefinedRatioIsNull) {
  const Workplace place;
  place.put_problem();
  place.put("group.csv", group_text({100, {}, {}}));
  const auto nothing_selected = place.corral("score matches.csv group.csv --truth truth.txt --json").json();
  EXPECT_TRUE(nothing_selected["precision"].is_null());
  EXPECT_EQ(nothing_selected["recall"], 0);
  const auto nothing_right =
      place.corral("score matches.csv group.csv --truth truth.txt --json --threshold-pr 1e-9").json();
  EXPECT_TRUE(nothing_right["recall"].is_null());
  EXPECT_TRUE(nothing_right["f1"].is_null());
  EXPECT_THAT(place.corral("score matches.csv group.csv --truth truth.txt").out, HasSubstr(" - "));
}

}  // namespace
}  // namespace corral
