// SPDX-License-Identifier: MIT
// corral run: everything on one pair, and the single commands on what it leaves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "grouping/registry.h"
#include "kernel/evaluation.h"
#include "tests/support/program.h"

namespace corral {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using testing::keys_of;
using testing::lines_in;
using testing::Outcome;
using ::testing::StartsWith;
using testing::Workplace;

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const Grouper& grouper : groupers()) names.push_back(grouper.name);
  return names;
}

TEST(Run, AllMethodsAlignACopy) {
  const Workplace place;
  place.put_pair();
  const Outcome outcome = place.corral("run model.ply copy.ply --truth truth.txt --json");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err, "");
  const auto json = outcome.json();
  EXPECT_THAT(keys_of(json), IsSupersetOf({"source", "target", "resolution", "matches", "true_matches", "methods"}));
  EXPECT_EQ(json["source"], "model.ply");
  EXPECT_EQ(json["target"], "copy.ply");
  EXPECT_GT(json["true_matches"], 10);
  std::vector<std::string> methods;
  for (const auto& method : json["methods"]) {
    methods.push_back(method["method"]);
    EXPECT_THAT(keys_of(method), IsSupersetOf({"f1", "method", "precision", "recall", "rmse_pr", "mean_error_pr",
                                               "rotation_error_deg", "selected", "status", "time_ms", "add_share",
                                               "translation_error_pr", "success_5pr", "success_from_pr", "outcome"}));
    EXPECT_TRUE(method["selected"].is_number_integer());
    if (method["method"] == "ransac") {
      EXPECT_LT(method["rotation_error_deg"], 3);
      EXPECT_EQ(method["status"], "refined");
      EXPECT_EQ(method["outcome"], "found");
      EXPECT_GT(method["initial_mean_error_pr"], 0);
      EXPECT_LT(method["initial_mean_error_pr"], 5);
      EXPECT_LE(method["mean_error_pr"], method["rmse_pr"]);
      EXPECT_LT(method["add_share"], 0.1);
      EXPECT_EQ(method["success_5pr"], true);
    }
  }
  EXPECT_EQ(methods, method_names());
}

TEST(Run, WithoutATruthScoresAndErrorsAreNull) {
  const Workplace place;
  place.put_pair();
  const auto json = place.corral("run model.ply copy.ply --methods gc,ss --json").json();
  EXPECT_TRUE(json["true_matches"].is_null());
  ASSERT_EQ(json["methods"].size(), 2U);
  EXPECT_EQ(json["methods"][0]["method"], "gc") << "in the order asked for";
  for (const auto& method : json["methods"])
    for (const char* key : {"precision", "recall", "f1", "rotation_error_deg", "translation_error_pr", "rmse_pr",
                            "initial_rmse_pr", "add_share", "success_5pr", "outcome"})
      EXPECT_TRUE(method[key].is_null()) << key;
}

TEST(Run, TheTableHasARowPerMethod) {
  const Workplace place;
  place.put_pair();
  const Outcome outcome = place.corral("run model.ply copy.ply --truth truth.txt -v");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, AllOf(StartsWith("source: 2562 points"), HasSubstr("\ntarget: "), HasSubstr("\npair: pr ")));
  EXPECT_THAT(outcome.out,
              AllOf(StartsWith("model.ply -> copy.ply: "), HasSubstr("correct within 4.0 pr"), HasSubstr("precision")));
  EXPECT_EQ(lines_in(outcome.out), 7 + groupers().size()) << "the best pose, and what speaks for it and against it";
  EXPECT_THAT(outcome.out, HasSubstr("\nbest pose: "));
  for (const std::string& name : method_names()) EXPECT_THAT(outcome.out, HasSubstr("\n" + name + " "));
  EXPECT_EQ(lines_in(place.corral("run model.ply copy.ply").out), 5 + groupers().size());
}

TEST(Run, DenseRefinementHasATableOfItsOwn) {
  const Workplace place;
  place.put_pair();
  const auto json =
      place.corral("run model.ply copy.ply --truth truth.txt --methods gc,nnsr --dense --json -o out").json();
  for (const auto& method : json["methods"]) {
    const auto dense = method["dense"];
    EXPECT_EQ(dense["status"], "refined");
    EXPECT_GT(dense["overlap"], 0.99);
    EXPECT_LE(dense["residual_pr"], dense["residual_before_pr"]);
    EXPECT_LT(dense["rotation_error_deg"], 0.5);
    EXPECT_LT(dense["add_share"], 0.01);
    EXPECT_EQ(dense["success_5pr"], true);
    EXPECT_EQ(dense["pose"].size(), 4U);
  }
  write_mesh(place / "flat.ply", testing::grid(20, 20));
  const auto no_pose = place.corral("run flat.ply flat.ply --methods gc --dense --json").json()["methods"][0];
  EXPECT_TRUE(no_pose.contains("dense") && no_pose["dense"].is_null());
  EXPECT_THAT(place.text("out/dense.csv"), StartsWith("method,overlap_before,overlap,"));
  EXPECT_EQ(lines_in(place.text("out/dense.csv")), 3U);
  const Outcome table = place.corral("run model.ply copy.ply --methods gc --dense");
  EXPECT_THAT(table.out, HasSubstr("\ndense refinement, points to planes:\ngrouper  overlap before"));
  EXPECT_EQ(lines_in(table.out), 10U);
  ASSERT_EQ(place.corral("run model.ply copy.ply --methods gc -o out").status, 0);
  EXPECT_FALSE(std::filesystem::exists(place / "out/dense.csv")) << "left by an earlier run";
}

TEST(Run, OracleAndFloorBoundTheMethods) {
  const Workplace place;
  place.put_pair();
  const auto json = place.corral("run model.ply copy.ply --truth truth.txt --json").json();
  ASSERT_EQ(json["bounds"].size(), 2U);
  const auto oracle = json["bounds"][0], baseline = json["bounds"][1];
  EXPECT_EQ(oracle["method"], "oracle");
  EXPECT_EQ(oracle["selected"], json["true_matches"]);
  EXPECT_EQ(oracle["precision"], 1);
  EXPECT_EQ(oracle["recall"], 1);
  EXPECT_TRUE(oracle["time_ms"].is_null());
  EXPECT_EQ(oracle["status"], "refined");
  EXPECT_EQ(baseline["method"], "baseline");
  EXPECT_EQ(baseline["selected"], json["matches"]);
  EXPECT_EQ(baseline["recall"], 1);
  EXPECT_LT(oracle["rotation_error_deg"], 3);
  EXPECT_TRUE(place.corral("run model.ply copy.ply --json").json()["bounds"].is_null());
}

TEST(Run, ExplainsWhereThePairWasWonOrLost) {
  const Workplace place;
  place.put_pair();
  const auto json =
      place.corral("run model.ply copy.ply --truth truth.txt --methods gc,ransac --explain --json").json();
  const auto explanation = json["explanation"];
  EXPECT_EQ(explanation["success_pr"], 5);
  EXPECT_EQ(explanation["cause"], "found");
  EXPECT_EQ(explanation["keypoints_in_overlap"], json["matches"]) << "a copy overlaps wholly";
  ASSERT_EQ(explanation["methods"].size(), 2U);
  EXPECT_EQ(explanation["methods"][1]["method"], "ransac");
  EXPECT_EQ(explanation["methods"][1]["cause"], "found");
  const std::string text = explanation["methods"][1]["text"];
  const Outcome printed = place.corral("run model.ply copy.ply --truth truth.txt --methods gc,ransac --explain");
  EXPECT_THAT(printed.out, AllOf(HasSubstr("\n\npair: can be registered: "), HasSubstr("\nransac: " + text + ".\n")));
  EXPECT_FALSE(place.corral("run model.ply copy.ply --truth truth.txt --json").json().contains("explanation"));
  const Outcome refused = place.corral("run model.ply copy.ply --explain");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("--explain: needs --truth"));
}

// A truth that holds nowhere is the cause of everything, whatever the methods do.
TEST(Run, ExplainsThatATruthFitsNowhere) {
  const Workplace place;
  place.put_pair();
  place.put("far.txt", "1 0 0 1000\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  const auto json = place.corral("run model.ply copy.ply --truth far.txt --methods gc --explain --json").json();
  EXPECT_EQ(json["explanation"]["cause"], "truth does not fit");
  EXPECT_EQ(json["explanation"]["keypoints_in_overlap"], 0);
  EXPECT_EQ(json["explanation"]["methods"][0]["cause"], "truth does not fit");
  EXPECT_EQ(json["methods"][0]["outcome"], "lost");
}

TEST(Run, TheFolderAgreesWithTheSingleCommands) {
  const Workplace place;
  place.put_pair();
  ASSERT_EQ(place.corral("run model.ply copy.ply --truth truth.txt -o out/deep").status, 0);
  ASSERT_EQ(place.corral("match model.ply copy.ply -o matches.csv").status, 0);
  EXPECT_EQ(place.text("out/deep/matches.csv"), place.text("matches.csv"));
  const auto run = nlohmann::json::parse(place.text("out/deep/run.json"));
  EXPECT_EQ(nlohmann::json::parse(place.text("out/deep/match_report.json"))["matches"], run["matches"]);
  for (const auto& method : run["methods"]) {
    const std::string name = method["method"], group = "out/deep/group_" + name + ".csv",
                      pose = "out/deep/pose_" + name + ".txt";
    SCOPED_TRACE(name);
    EXPECT_EQ(place.corral("group out/deep/matches.csv -m " + name).out, place.text(group));
    const Outcome refined =
        place.corral("refine out/deep/matches.csv " + group + " -o pose.txt --truth truth.txt --json");
    EXPECT_EQ(place.text("pose.txt"), place.text(pose)) << "both absent if there is no pose";
    std::filesystem::remove(place / "pose.txt");
    auto alone = refined.json(), inside = nlohmann::json::parse(place.text("out/deep/refine_" + name + ".json"));
    for (const char* key :
         {"rmse_pr", "mean_error_pr", "success_from_pr", "add_share", "success_add", "add_s_share", "success_add_s"})
      for (const std::string prefix : {"", "initial_"}) {  // over the right matches there, over the overlap here
        alone.erase(prefix + key);
        inside.erase(prefix + key);
      }
    EXPECT_EQ(alone, inside);
    const auto score = place
                           .corral("score out/deep/matches.csv " + group +
                                   " --truth truth.txt --source model.ply --target copy.ply --json")
                           .json();
    for (const char* key :
         {"precision", "recall", "f1", "selected", "initial_rotation_error_deg", "initial_translation_error_pr",
          "initial_rmse_pr", "initial_mean_error_pr", "initial_add_share", "initial_success_5pr"})
      EXPECT_EQ(score[key], method[key]) << key;
    EXPECT_EQ(score["true_matches"], run["true_matches"]);
  }
}

TEST(Run, TheSameCommandTwiceGivesTheSameBytes) {
  const Workplace place;
  place.put_pair();
  for (const char* folder : {"one", "two"})
    ASSERT_EQ(place.corral("run model.ply copy.ply --truth truth.txt -o " + std::string(folder)).status, 0);
  std::vector<std::string> files = {"matches.csv"};
  for (const std::string& name : method_names())
    files.insert(files.end(), {"group_" + name + ".csv", "refine_" + name + ".json"});
  for (const std::string& file : files) {
    EXPECT_EQ(place.text("one/" + file), place.text("two/" + file)) << file;
    EXPECT_NE(place.text("one/" + file), "") << file;
  }
  const auto without_times = [&](const std::string& folder) {
    auto json = nlohmann::json::parse(place.text(folder + "/run.json"));
    for (auto& method : json["methods"]) method.erase("time_ms");
    return json;
  };
  EXPECT_EQ(without_times("one"), without_times("two"));
}

TEST(Run, MethodsCsvHoldsTheNumbersOfTheJson) {
  const Workplace place;
  place.put_pair();
  const Outcome outcome = place.corral("run model.ply copy.ply --truth truth.txt --methods ransac,hough -o out --json");
  ASSERT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out, place.text("out/run.json"));
  std::istringstream csv(place.text("out/methods.csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_THAT(line, StartsWith("method,selected,precision,recall,f1,time_ms,rotation_error_deg,translation_error_pr,"
                               "rmse_pr,mean_error_pr,add_share,"));
  const std::vector<std::string> columns = {
      "selected", "precision",     "recall",   "f1", "time_ms", "rotation_error_deg", "translation_error_pr",
      "rmse_pr",  "mean_error_pr", "add_share"};
  const auto methods = outcome.json()["methods"];
  for (const auto& method : methods) {
    std::getline(csv, line);
    std::istringstream fields(line);
    std::string field;
    std::getline(fields, field, ',');
    EXPECT_EQ(field, method["method"]);
    for (const std::string& column : columns) {
      std::getline(fields, field, ',');
      EXPECT_EQ(field.empty(), method[column].is_null()) << column;
      if (!field.empty() && method[column].is_number()) {
        EXPECT_EQ(std::stod(field), method[column].get<double>()) << column;
      }
    }
  }
}

TEST(Run, AnEmptyTableGivesEmptyGroupsAndNoPose) {
  const Workplace place;
  write_mesh(place / "flat.ply", testing::grid(20, 20));
  place.put("truth.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  const Outcome outcome = place.corral("run flat.ply flat.ply --truth truth.txt -o out --json");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, HasSubstr("hint: no keypoint on the source"));
  EXPECT_EQ(outcome.json()["matches"], 0);
  EXPECT_EQ(outcome.json()["true_matches"], 0);
  const auto methods = outcome.json()["methods"];
  for (const auto& method : methods) {
    EXPECT_EQ(method["selected"], 0);
    EXPECT_EQ(method["status"], "too few rows");
    EXPECT_TRUE(method["precision"].is_null() && method["recall"].is_null() && method["rmse_pr"].is_null());
  }
  EXPECT_EQ(place.text("out/group_gc.csv"), "row,selected,score\n");
  EXPECT_FALSE(std::filesystem::exists(place / "out/pose_gc.txt"));
}

// What an earlier run left must not be taken for an answer of this one.
TEST(Run, NoPoseOfAnEarlierRunIsLeft) {
  const Workplace place;
  place.put_pair();
  write_mesh(place / "flat.ply", testing::grid(20, 20));
  ASSERT_EQ(place.corral("run model.ply copy.ply --methods gc -o out").status, 0);
  ASSERT_TRUE(std::filesystem::exists(place / "out/pose_gc.txt"));
  ASSERT_EQ(place.corral("run flat.ply flat.ply --methods gc -o out").status, 0);
  EXPECT_FALSE(std::filesystem::exists(place / "out/pose_gc.txt"));
}

TEST(Run, TheResolutionRuleReachesTheTable) {
  const Workplace place;
  place.put_pair();
  for (const char* rule : {"source", "target", "mean", "0.0625"}) {
    const auto report =
        place.corral("match model.ply copy.ply --json -o matches.csv --resolution " + std::string(rule)).json();
    const double source = report["source"]["resolution"], target = report["target"]["resolution"];
    const std::string name(rule);
    EXPECT_EQ(report["resolution"], name == "source"   ? source
                                    : name == "target" ? target
                                    : name == "mean"   ? (source + target) / 2
                                                       : 0.0625);
    EXPECT_EQ(read_matches(place / "matches.csv").resolution, report["resolution"]);
  }
}

}  // namespace
}  // namespace corral
