// SPDX-License-Identifier: MIT
#include "apps/scoreboard/board.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/scoreboard/site.h"
#include "kernel/error.h"

namespace corral {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A study of one level whose methods register these of four pairs, which have 1, 2, 3 and 40 correct ones of 100 matches.
StudyFolder study(const std::map<std::string, std::vector<bool>>& methods, const std::string& dataset = "set") {
  StudyFolder run;
  run.folder = "run";
  ExperimentInfo info;
  info.name = "board", info.title = "Board", info.dataset = dataset, info.attribute = "inlier_ratio";
  info.levels = {{"[0,100]", 0, 100}};
  for (const auto& [method, registers] : methods) info.methods.push_back(method);
  run.experiments = {info};
  const std::vector<int> correct = {1, 2, 3, 40};
  for (std::size_t pair = 0; pair < correct.size(); ++pair) {
    std::map<std::string, std::vector<bool>> all = methods;
    all["oracle"] = {true, true, true, true};
    for (const auto& [method, registers] : all) {
      StudyRecord record;
      record.experiment = "board", record.dataset = dataset, record.level = "[0,100]", record.method = method;
      record.pair = "p" + std::to_string(pair);
      record.value = correct[pair];
      record.status = {MethodState::Refined, ""};
      record.truth = std::string("fits");
      record.matches = 100, record.true_matches = correct[pair], record.selected = 10, record.correct = 1;
      record.precision = 0.1, record.recall = 0.1, record.f1 = 0.1;
      record.refined.rotation_error_deg = 0, record.refined.mean_error_pr = registers[pair] ? 1 : 50;
      record.time_ms = method.size();
      run.records.push_back(record);
    }
  }
  return run;
}

TEST(Board, RanksBySuccessAndEqualsShareARank) {
  const std::vector<StudyFolder> runs = {study(
      {{"gc", {true, true, false, true}}, {"ss", {false, false, false, true}}, {"st", {true, false, true, true}}})};
  const std::vector<Board> boards = make_boards(tables_of(runs));
  ASSERT_EQ(boards.size(), 1U);
  EXPECT_EQ(boards[0].tables, 4);
  EXPECT_EQ(boards[0].row_of("gc")->rank, 1);
  EXPECT_EQ(boards[0].row_of("st")->rank, 1);
  EXPECT_EQ(boards[0].row_of("ss")->rank, 3) << "after two that share the first";
  EXPECT_EQ(boards[0].rows.front().method, "oracle");
  EXPECT_EQ(boards[0].rows.front().rank, 0);
  const BoardRow& gc = *boards[0].row_of("gc");
  EXPECT_EQ(gc.all.success, 0.75);
  EXPECT_NEAR(gc.all.low, 0.3006, 1e-4);
  EXPECT_EQ(gc.by_share[1]->success, 1) << "1 to 2 %";
  EXPECT_EQ(gc.by_share[2]->success, 0.5) << "2 to 5 %";
  EXPECT_FALSE(gc.by_share[0]);
  EXPECT_EQ(gc.by_share[5]->pairs, 1);
  EXPECT_EQ(gc.median_ms, 2);
}

TEST(Board, StudiesOfTheSamePairsShareIt) {
  const std::vector<StudyFolder> runs = {study({{"gc", {true, true, true, true}}}),
                                         study({{"mine", {true, true, false, true}}})};
  const std::vector<Board> boards = make_boards(tables_of(runs));
  ASSERT_EQ(boards.size(), 1U);
  EXPECT_EQ(boards[0].rows.size(), 3U);
  std::vector<StudyFolder> other = {runs[0], runs[1]};
  other[1].records.resize(2);
  EXPECT_THROW(make_boards(tables_of(other)), IoError);
  const std::vector<StudyFolder> twice = {runs[0], runs[0]};
  EXPECT_THROW(make_boards(tables_of(twice)), IoError);
}

TEST(Board, NamesAreNoMarkup) {
  const std::string hostile = "<script>alert(1)</script>\"'&";
  const std::vector<StudyFolder> runs = {study({{"gc", {true, true, true, true}}}, hostile)};
  FactsByMethod facts;
  facts["gc"].title = facts["gc"].url = facts["gc"].needs = hostile;
  for (const FileContent& file : scoreboard_site(make_boards(tables_of(runs)), facts, "site")) {
    EXPECT_EQ(file.path.find_first_of("<>\"'&"), std::string::npos) << file.path;
    if (file.path == "site/scores.json") continue;
    EXPECT_THAT(file.content, Not(HasSubstr("<script>alert"))) << file.path;
  }
}

TEST(Board, AWeakSpotIsNamed) {
  const std::vector<StudyFolder> runs = {study({{"gc", {true, true, true, true}}, {"ss", {true, false, false, true}}})};
  std::map<std::string, std::string> pages;
  for (const FileContent& file : scoreboard_site(make_boards(tables_of(runs)), {}, "site"))
    pages[file.path] = file.content;
  EXPECT_THAT(pages["site/method-ss.html"],
              HasSubstr("On tables with 2 to 5 % correct matches it registers 0.00, gc 1.00 (2 tables)."));
  EXPECT_THAT(pages["site/method-gc.html"], HasSubstr("No method is ahead of it"));
}

}  // namespace
}  // namespace corral
