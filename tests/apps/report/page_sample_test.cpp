// SPDX-License-Identifier: MIT
#include "apps/report/page_sample.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "apps/results/measures.h"
#include "tests/support/simulated_run.h"

namespace corral {
namespace {

using Key = std::tuple<std::string, std::string, std::string>;

Key key_of(const StudyRecord& record) { return {record.experiment, record.level, record.pair}; }

/// 3,000 pairs and their times; of every level three pairs failed, the last ones.
const std::vector<StudyFolder>& study() {
  static const std::vector<StudyFolder> runs = [] {
    constexpr int kPairs = 58;
    StudyFolder run = testing::simulated_study(1, kPairs);
    for (StudyRecord& record : run.records)
      for (const char* number : {"55", "56", "57"})
        if (record.pair.str().rfind(std::string("pair") + number, 0) == 0)
          record.status = {MethodState::Failed, "no keypoints"};
    return std::vector<StudyFolder>{run};
  }();
  return runs;
}

std::set<Key> pairs_of(const PageRecords& sample) {
  std::set<Key> pairs;
  for (const StudyRecord* record : sample.at(0)) pairs.insert(key_of(*record));
  return pairs;
}

TEST(PageSample, IsAllOfASmallStudy) {
  const std::size_t all = study()[0].records.size();
  ASSERT_GT(all, 20'000u);
  const PageRecords sample = sample_records(study(), {}, all);
  ASSERT_EQ(sample.at(0).size(), all);
  for (std::size_t i = 0; i < all; ++i) EXPECT_EQ(sample[0][i], &study()[0].records[i]);
  EXPECT_LT(sample_records(study(), {}, all - 1).at(0).size(), all);
}

TEST(PageSample, HoldsPairsWithAllTheirGroupersInOrder) {
  constexpr std::size_t kMost = 4000;
  const PageRecords sample = sample_records(study(), {}, kMost);
  EXPECT_LE(sample.at(0).size(), kMost);
  EXPECT_GT(sample.at(0).size(), kMost - 22);  // a pair has 7 records, one of times 21
  EXPECT_TRUE(std::is_sorted(sample[0].begin(), sample[0].end()));
  const std::set<Key> pairs = pairs_of(sample);
  std::size_t whole = 0;
  for (const StudyRecord& record : study()[0].records) whole += pairs.count(key_of(record));
  EXPECT_EQ(whole, sample[0].size());
  EXPECT_EQ(sample, sample_records(study(), {}, kMost));
}

// 4000 records are 9 or 10 pairs for each of 54 levels and the times: the three that failed, and others from everywhere.
TEST(PageSample, HoldsOfEveryLevelWhatFailedAndADrawOfTheOthers) {
  std::map<std::pair<std::string, std::string>, std::pair<int, int>> counts;  // failed, others
  double places = 0, others = 0;
  const PageRecords sample = sample_records(study(), {}, 4000);
  for (const StudyRecord* record : sample.at(0)) {
    if (record->method != "gc" || record->experiment == "time") continue;
    auto& [failed, sound] = counts[{record->experiment, record->level}];
    const bool is_failed = record->status.state == MethodState::Failed;
    ++(is_failed ? failed : sound);
    if (is_failed) continue;
    places += std::stoi(record->pair.str().substr(4));
    ++others;
  }
  std::size_t levels = 0;
  for (const ExperimentInfo& info : study()[0].experiments) levels += info.name == "time" ? 0 : info.levels.size();
  EXPECT_EQ(counts.size(), levels);
  int least = 1000, most = 0;
  for (const auto& [level, count] : counts) {
    EXPECT_EQ(count.first, 3) << level.first << " " << level.second;
    least = std::min(least, count.second);
    most = std::max(most, count.second);
  }
  EXPECT_GE(least, 5);
  EXPECT_LE(most - least, 1);
  EXPECT_NEAR(places / others, 27, 3.5) << "of 0 .. 54, as far from the first as from the last";
}

TEST(PageSample, BeginsWithTheScenesAndThenTakesPairsOfNoFit) {
  std::vector<StudyFolder> runs = study();
  std::vector<SceneChoice> scenes = choose_scenes(runs, 5);
  ASSERT_EQ(scenes.size(), 5u);
  std::set<std::string> wanted, found;
  for (const SceneChoice& scene : scenes) wanted.insert(scene.selection);
  const PageRecords few = sample_records(runs, scenes, 35);
  ASSERT_EQ(few.at(0).size(), 35u);
  for (const StudyRecord* record : few[0]) found.insert(record->selection);
  EXPECT_EQ(found, wanted);

  for (StudyRecord& record : runs[0].records) {
    record.status = {MethodState::Refined};
    if (record.pair.str().rfind("pair30", 0) == 0) record.truth = "inverted";
  }
  int misfits = 0;
  const PageRecords sample = sample_records(runs, {}, 1000);
  for (const StudyRecord* record : sample.at(0)) misfits += record->truth == "inverted";
  EXPECT_GT(misfits, 300) << "one of 58 pairs, but half of those that are taken first";
}

}  // namespace
}  // namespace corral
