// SPDX-License-Identifier: MIT
#include "apps/results/study_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/text/csv_file.h"
#include "kernel/error.h"
#include "kernel/random.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

using ::testing::HasSubstr;
using testing::put_text;
using testing::ScratchFolder;

TEST(StudyRecord, ReadsBackWhatItWrote) {
  const MethodStatus failed{MethodState::Failed, "\"so\", it said"};
  StudyRecord full{"noise",
                   "b3r",
                   "[0,0.5)",
                   "bunny, the",
                   "kitchen",
                   "gc",
                   2,
                   0.25,
                   failed,
                   "fits",
                   10,
                   5,
                   4,
                   3,
                   9,
                   0.75,
                   0.6,
                   2.0 / 3,
                   0.9,
                   0.0625,
                   {1.5, 2.5, 3.5, 4.5, 0.1, 0.7, 0.05},
                   {0.1, 0.2, 0.3, 0.4, 5e-324, 1, 0.2},
                   {},
                   {},
                   1e-9,
                   40,
                   0.9,
                   "s/x.csv"};
  const ScratchFolder folder;
  const std::string text = csv_line(record_columns()) + record_line(full) + record_line({});
  const std::vector<StudyRecord> read = read_records(put_text(folder / "records.csv", text));
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(record_line(read[0]), record_line(full));
  EXPECT_EQ(record_line(read[1]), record_line({}));
  EXPECT_EQ(read[0].refined.add_share, 5e-324);
  EXPECT_FALSE(read[0].dense.mean_error_pr);
}

TEST(StudyRecord, NamesWhatIsWrong) {
  const ScratchFolder folder;
  std::string line = record_line({});
  line.replace(line.find(",0,"), 3, ",-1,");  // the repeat
  const std::string path = put_text(folder / "records.csv", csv_line(record_columns()) + line);
  try {
    read_records(path);
    FAIL();
  } catch (const IoError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr(path), HasSubstr("row 1"), HasSubstr("repeat")));
  }
}

TEST(StudyRecord, RefusesAStatusThatNoMethodHas) {
  const ScratchFolder folder;
  StudyRecord record;
  record.status = {MethodState::Timed};
  std::string line = record_line(record);
  line.replace(line.find("timed"), 5, "fast");
  const std::string path = put_text(folder / "records.csv", csv_line(record_columns()) + line);
  EXPECT_THAT(testing::io_error_of([&] { read_records(path); }), HasSubstr("status is 'fast'"));
}

TEST(StudyRecord, SharesAreUpToOneAndErrorsNotBelowZero) {
  const ScratchFolder folder;
  const auto complaint = [&](const StudyRecord& record) {
    const std::string path = put_text(folder / "records.csv", csv_line(record_columns()) + record_line(record));
    return testing::io_error_of([&] { read_records(path); });
  };
  StudyRecord record;
  record.value = -1e308, record.f1 = 1, record.initial.mean_error_pr = 1e300;
  EXPECT_EQ(complaint(record), "");
  record.f1 = 1e308;
  EXPECT_THAT(complaint(record), HasSubstr("f1 is '1e+308'"));
  record.f1 = 0, record.frame_share = 1.5;
  EXPECT_THAT(complaint(record), HasSubstr("frame_share is '1.5'"));
  record.frame_share = std::nullopt, record.initial.add_share = 1.06;
  EXPECT_EQ(complaint(record), "") << "ADD is a length in diameters: a pose may be farther off than one";
  record.time_ms = -1;
  EXPECT_THAT(complaint(record), HasSubstr("time_ms"));
}

TEST(StudyFolder, IsNotNestedWithoutEnd) {
  const ScratchFolder folder;
  const std::string deep = std::string(100000, '[') + std::string(100000, ']');
  put_text(folder / "manifest.json", "{\"x\": " + deep + "}");
  EXPECT_THAT(testing::io_error_of([&] { read_study(folder / ""); }), HasSubstr("nested"));
}

TEST(Selections, ReadBackWhatWasWritten) {
  const PairSelections selections{{3, 1, 4}, {1, 5, 9}, {0.5, 1e9, 4}, {{"gc", {0, 2}}, {"ss", {}}}};
  const ScratchFolder folder;
  const std::string text = selections_text(selections, {"ss", "gc"});
  const PairSelections read = read_selections(put_text(folder / "x.csv", text));
  EXPECT_EQ(read.source_keypoints, selections.source_keypoints);
  EXPECT_EQ(read.target_keypoints, selections.target_keypoints);
  EXPECT_EQ(read.residual_pr, selections.residual_pr);
  EXPECT_EQ(read.selected, selections.selected);
}

TEST(Poses, ReadBackWhatWasWritten) {
  RandomStream stream(1);
  const StudyPose pose{"gc", "refined", {stream.rotation(), {1, -2, 1.0 / 3}}};
  const ScratchFolder folder;
  const std::vector<StudyPose> read = read_poses(put_text(folder / "x.csv", poses_text({pose, pose})));
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(poses_text(read), poses_text({pose, pose}));
  EXPECT_EQ(read[1].target_from_source.rotation, pose.target_from_source.rotation);
}

TEST(StudyFolder, ReadsItsManifest) {
  const ScratchFolder folder;
  put_text(folder / "records.csv", csv_line(record_columns()) + record_line({}));
  put_text(folder / "manifest.json", R"json({"experiments": [{"name": "noise", "title": "Noise", "figure": "a",
    "dataset": "b3r", "attribute": "noise_pr", "axis": "noise (pr)",
    "levels": [{"label": "0.05", "low": 0.05, "high": 0.05}], "methods": ["ss", "gc"], "foreign_methods": [], "threshold_pr": 4,
    "least_true_matches": 1}],
    "pairs": {"b3r/x": {"source": "a.ply", "target": "b.ply", "truth": "", "resolution": 0.5}}})json");
  const StudyFolder run = read_study(folder / "");
  ASSERT_EQ(run.experiments.size(), 1u);
  EXPECT_EQ(run.experiments[0].levels[0].middle(), 0.05);
  EXPECT_EQ(run.pairs.at("b3r/x").resolution, 0.5);
  EXPECT_EQ(run.records.size(), 1u);
  put_text(folder / "manifest.json", "{}");
  EXPECT_THROW(read_study(folder / ""), IoError);
}

}  // namespace
}  // namespace corral
