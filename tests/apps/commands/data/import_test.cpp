// SPDX-License-Identifier: MIT
// corral import matches, and corral match on given features, as a user types them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "io/text/csv_file.h"
#include "kernel/number_text.h"
#include "tests/io/array/npy_encoder.h"
#include "tests/support/program.h"

namespace corral {
namespace {

using namespace corral::testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

/// A problem of 100 matches, 60 of them correct, in the pieces that other programs write.
class ImportTest : public ::testing::Test {
 protected:
  ImportTest() : problem_(place_.put_problem()) {
    for (int row = 0; row < 100; ++row) {
      const std::string source = line(problem_.matches.source_points, row),
                        target = line(problem_.matches.target_points, row);
      six_ += source + " " + target + "\n";
      sources_ += source + "\n";
      targets_ += target + "\n";
      const bool is_correct = std::binary_search(problem_.inliers.begin(), problem_.inliers.end(), row);
      labels_ += is_correct ? "1\n" : "0\n";
      indices_ += std::to_string(row) + " " + std::to_string(row) + "\n";
    }
  }

  static std::string line(const Points& points, int row) {
    return to_text(points(row, 0)) + " " + to_text(points(row, 1)) + " " + to_text(points(row, 2));
  }
  static std::string numbers(const Points& points, const std::string& shape) {
    std::vector<double> all;
    for (int row = 0; row < points.rows(); ++row)
      for (int axis = 0; axis < 3; ++axis) all.push_back(points(row, axis));
    return npy(shape, all);
  }
  std::string pose_array() const {
    std::vector<double> all;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) all.push_back(problem_.truth.rotation(row, column));
      all.push_back(problem_.truth.translation(row));
    }
    return npy("(3, 4)", all);
  }
  std::string transposed(const Points& points) const {
    std::string text;
    for (int axis = 0; axis < 3; ++axis)
      for (int row = 0; row < points.rows(); ++row)
        text += to_text(points(row, axis)) + (row + 1 < points.rows() ? "," : "\n");
    return text;
  }
  void put(const std::string& name, const std::string& text) const {
    fs::create_directories(fs::path(place_ / name).parent_path());
    place_.put(name, text);
  }

  /// A folder as a set: its pairs have the points and the truth of the problem.
  void expect_set(const std::string& folder, const std::string& more, const std::vector<std::string>& names) {
    const Outcome outcome = place_.corral("import matches " + folder + " -o set" + more);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("100 matches, 60 correct within 4 pr (60.00 %)"));
    const CsvTable pairs = read_csv(place_ / "set/pairs.csv");
    ASSERT_GE(pairs.column("matches"), 0);
    std::vector<std::string> found;
    for (const auto& row : pairs.rows) {
      found.push_back(row[0]);
      const CorrespondenceSet matches = read_matches(place_ / ("set/" + row[std::size_t(pairs.column("matches"))]));
      EXPECT_EQ(matches.source_points, problem_.matches.source_points);
      EXPECT_EQ(matches.target_points, problem_.matches.target_points);
      EXPECT_TRUE(read_transform(place_ / ("set/" + row[3])).rotation.isApprox(problem_.truth.rotation, 1e-9));
      EXPECT_EQ(row[std::size_t(pairs.column("inlier_ratio"))], "60.00");
      EXPECT_EQ(row[std::size_t(pairs.column("rows"))], "100");
    }
    EXPECT_EQ(found, names);
  }

  Workplace place_;
  SyntheticProblem problem_;
  std::string six_, sources_, targets_, labels_, indices_;
};

TEST_F(ImportTest, ATableWithTruthAndLabels) {
  put("corr.txt", six_);
  put("label.txt", labels_);
  const Outcome outcome = place_.corral(
      "import matches corr.txt --resolution 1 --truth truth.txt --labels label.txt --truth-output gt.txt -o out.csv");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("100 matches, 60 correct within 4 pr (60.00 %), 60 labelled correct (100 of 100 "
                                     "labels agree)"));
  EXPECT_EQ(read_matches(place_ / "out.csv").source_points, problem_.matches.source_points);
  EXPECT_EQ(place_.text("gt.txt"), place_.text("truth.txt"));
  const Outcome inverse =
      place_.corral("import matches corr.txt --resolution 1 --truth truth.txt --truth-inverse -o out.csv");
  EXPECT_THAT(inverse.err, HasSubstr("fits worse than its inverse, by which 60"));
}

TEST_F(ImportTest, TheResolutionIsGivenOrMeasuredOrAskedFor) {
  put("corr.txt", six_);
  const Outcome unknown = place_.corral("import matches corr.txt -o out.csv");
  EXPECT_EQ(unknown.status, 3);
  EXPECT_THAT(unknown.err, HasSubstr("corr.txt: the resolution is not known"));
  EXPECT_FALSE(fs::exists(place_ / "out.csv"));
  put("a.xyz", "0 0 0\n2 0 0\n4 0 0\n");
  put("b.xyz", "0 0 0\n3 0 0\n6 0 0\n");
  ASSERT_EQ(place_.corral("import matches corr.txt --source a.xyz --target b.xyz -o out.csv").status, 0);
  EXPECT_EQ(read_matches(place_ / "out.csv").resolution, 2.5);
  ASSERT_EQ(place_.corral("import matches corr.txt --resolution 0.5 -o out.csv").status, 0);
  EXPECT_EQ(read_matches(place_ / "out.csv").resolution, 0.5);
  EXPECT_EQ(place_.corral("import matches corr.txt --resolution much -o out.csv").status, 2);
}

TEST_F(ImportTest, IndicesOfCloudsThatLackAPointAreRefused) {
  put("a.xyz", "nan 0 0\n" + sources_);
  put("b.xyz", targets_);
  put("corr.txt", indices_);
  const Outcome outcome = place_.corral("import matches corr.txt --source a.xyz --target b.xyz -o out.csv");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, HasSubstr("the indices of the matches count other points"));
}

TEST_F(ImportTest, MacFolders) {
  put("mac/room/cloud_bin_0+cloud_bin_4@corr.txt", six_);
  put("mac/room/cloud_bin_0+cloud_bin_4@label.txt", labels_);
  put("mac/room/cloud_bin_0+cloud_bin_4@GTmat.txt", place_.text("truth.txt"));
  put("mac/room/cloud_bin_0+cloud_bin_4@corr_ind.txt", indices_);
  put("mac/7/fpfh@corr.txt", six_);
  put("mac/7/fpfh@gtlabel.txt", labels_);
  put("mac/7/fpfh@gtmat.txt", place_.text("truth.txt"));
  put("mac/room/cloud_bin_0+cloud_bin_4@corr_fcgf.txt", six_);
  put("mac/room/cloud_bin_0+cloud_bin_4@GTmat_fcgf.txt", place_.text("truth.txt"));
  expect_set("mac", " --resolution 1", {"7-fpfh", "room-cloud_bin_0+cloud_bin_4", "room-cloud_bin_0+cloud_bin_4_fcgf"});
}

TEST_F(ImportTest, MacIndicesBesideClouds) {
  put("mac/demo/corr.txt", indices_);
  put("mac/demo/source.xyz", sources_);
  put("mac/demo/target.xyz", targets_);
  put("mac/demo/GTmat.txt", place_.text("truth.txt"));
  put("mac/python/corr.txt", "0 0\n");  // of a cloud that is not there: the coordinates are read instead
  put("mac/python/corr_data.txt", six_);
  put("mac/python/label.txt", labels_);
  put("mac/python/GTmat.txt", place_.text("truth.txt"));
  expect_set("mac", " --resolution 1", {"demo", "python"});
  const CsvTable pairs = read_csv(place_ / "set/pairs.csv");
  EXPECT_EQ(pairs.rows[0][1], fs::canonical(place_ / "mac/demo/source.xyz").string());
}

TEST_F(ImportTest, TurboRegAndTeaserFolders) {
  put("t/000_fpfh_kpts_src.txt", sources_);
  put("t/000_fpfh_kpts_dst.txt", targets_);
  put("t/000_trans.txt", place_.text("truth.txt"));
  put("t/000_pts_src.xyz", sources_);
  put("t/000_pts_dst.xyz", targets_);
  put("t/case_1/v1.csv", transposed(problem_.matches.source_points));
  put("t/case_1/v2.csv", transposed(problem_.matches.target_points));
  std::string rotation, translation;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      rotation += to_text(problem_.truth.rotation(row, column)) + (column < 2 ? "," : "\n");
    translation += to_text(problem_.truth.translation(row)) + "\n";
  }
  put("t/case_1/R_gt.csv", rotation);
  put("t/case_1/t_gt.csv", translation);
  expect_set("t", " --resolution 1", {"000_fpfh", "case_1"});
  EXPECT_THAT(read_csv(place_ / "set/pairs.csv").rows[0][1], HasSubstr("000_pts_src.xyz"));
}

TEST_F(ImportTest, ArchivesForEachPair) {
  put("n/0.npz", npz({{"src_keypts", numbers(problem_.matches.source_points, "(1, 100, 3)")},
                      {"tgt_keypts", numbers(problem_.matches.target_points, "(1, 100, 3)")},
                      {"gt_trans", pose_array()}}));
  expect_set("n", " --resolution 1", {"0"});
}

TEST_F(ImportTest, TcfFolders) {
  put("c/s2_s1_top3.match", six_.substr(0, six_.size() - 1));
  put("c/s2-s1.pose", place_.text("truth.txt"));
  put("c/s1_v0.1.xyz", targets_);
  put("c/s2_v0.1.xyz", sources_);
  expect_set("c", " --resolution 1", {"s2_s1"});
  EXPECT_THAT(read_csv(place_ / "set/pairs.csv").rows[0][2], HasSubstr("s1_v0.1.xyz"));
}

TEST_F(ImportTest, OwnTables) {
  put("o/one.matches.csv", place_.text("matches.csv"));
  put("o/one.xf", place_.text("truth.txt"));
  expect_set("o", "", {"one"});
}

TEST_F(ImportTest, FragmentsOf3DMatchWithFeatures) {
  std::vector<double> features;
  for (int row = 0; row < 100; ++row) features.insert(features.end(), {double(row), double(row * row)});
  const std::string described = npy("(100, 2)", features);
  put("m/fragments/room/cloud_bin_1_fcgf.npz",
      npz({{"xyz", numbers(problem_.matches.source_points, "(100, 3)")}, {"feature", described}}));
  put("m/fragments/room/cloud_bin_0_fcgf.npz",
      npz({{"xyz", numbers(problem_.matches.target_points, "(100, 3)")}, {"feature", described}}));
  put("m/gt_result/room-evaluation/gt.log", "0 1 60\n" + place_.text("truth.txt"));
  std::string information = "0 1 60\n";
  for (int row = 0; row < 6; ++row) information += "77 0 0 0 0 0\n";
  put("m/gt_result/room-evaluation/gt.info", information);
  expect_set("m", " --resolution 1", {"room-cloud_bin_1+cloud_bin_0"});
  const CsvTable pairs = read_csv(place_ / "set/pairs.csv");
  EXPECT_EQ(pairs.rows[0][std::size_t(pairs.column("overlap_points"))], "77");
  EXPECT_EQ(pairs.rows[0][std::size_t(pairs.column("fragments_apart"))], "1");
}

TEST_F(ImportTest, KittiScansWithTheirPoses) {
  put("k/icp/8_0_11.npy", pose_array());
  put("k/sequences/08/velodyne/000000.bin", raw<float>({0, 0, 0, 0, 1, 0, 0, 0}));
  put("k/sequences/08/velodyne/000011.bin", raw<float>({0, 0, 0, 0, 2, 0, 0, 0}));
  const Outcome outcome = place_.corral("import matches k -o set");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const CsvTable pairs = read_csv(place_ / "set/pairs.csv");
  ASSERT_EQ(pairs.rows.size(), 1u);
  EXPECT_THAT(pairs.rows[0][1], HasSubstr("000000.bin"));
  EXPECT_THAT(pairs.rows[0][2], HasSubstr("000011.bin"));
  EXPECT_TRUE(read_transform(place_ / ("set/" + pairs.rows[0][3])).rotation.isApprox(problem_.truth.rotation, 1e-9));
}

TEST_F(ImportTest, KittiScansOfAListOfPairs) {
  put("k/test_0_10.txt",
      "seq i seq_db j mot1\n8 0 8 11 0 -1 0 5.5 1 0 0 -2 0 0 1 0.25 0 0 0 1\n8 0 8 12 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 "
      "1\n");
  for (const char* scan : {"000000", "000011"})  // 12 is not there
    put("k/sequences/08/velodyne/" + std::string(scan) + ".bin", raw<float>({0, 0, 0, 0, 1, 0, 0, 0}));
  const Outcome outcome = place_.corral("import matches k -o set");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const CsvTable pairs = read_csv(place_ / "set/pairs.csv");
  ASSERT_EQ(pairs.rows.size(), 1u);
  EXPECT_EQ(pairs.rows[0][0], "8_0_11");
  EXPECT_THAT(pairs.rows[0][1], HasSubstr("000000.bin"));
  EXPECT_THAT(pairs.rows[0][2], HasSubstr("000011.bin"));
  EXPECT_EQ(pairs.rows[0][std::size_t(pairs.column("list"))], "test_0_10");
  EXPECT_EQ(read_transform(place_ / ("set/" + pairs.rows[0][3])).translation, Eigen::Vector3d(5.5, -2, 0.25));
}

TEST_F(ImportTest, AFolderOfNoneOrOfSeveralLayoutsIsRefused) {
  put("x/a.txt", "nothing");
  EXPECT_THAT(place_.corral("import matches x -o set").err, HasSubstr("no pairs of a known layout"));
  put("x/corr.txt", six_);
  put("x/a_b.match", six_);
  EXPECT_THAT(place_.corral("import matches x -o set").err, HasSubstr("--layout with one of mac (1), tcf (1)"));
  EXPECT_FALSE(fs::exists(place_ / "set"));
  EXPECT_EQ(place_.corral("import matches x -o set --layout tcf --resolution 1").status, 0);
  EXPECT_EQ(place_.corral("import matches x -o set --truth truth.txt").status, 2);
}

TEST_F(ImportTest, GivenFeaturesAreMatchedExactly) {
  const auto table = [](std::uint64_t seed, int rows, std::vector<std::vector<double>>& features) {
    std::string text;
    for (int row = 0; row < rows; ++row) {
      features.emplace_back();
      text += std::to_string(row) + "," + std::to_string(seed) + ",0";
      for (int i = 0; i < 37; ++i) {
        seed = seed * 6364136223846793005ull + 1442695040888963407ull;
        features.back().push_back(double(seed >> 40) / 16777216.0);
        text += "," + to_text(features.back().back());
      }
      text += "\n";
    }
    return text;
  };
  std::vector<std::vector<double>> source, target;
  put("f.csv", table(1, 60, source));
  put("g.csv", table(2, 80, target));
  const Outcome outcome =
      place_.corral("match --source-features f.csv --target-features g.csv --resolution 0.5 -o out.csv");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const CorrespondenceSet matches = read_matches(place_ / "out.csv");
  EXPECT_EQ(matches.resolution, 0.5);
  ASSERT_EQ(matches.size(), 60);
  for (int row = 0; row < 60; ++row) {
    int nearest = -1;
    double least = 1e300;
    for (int other = 0; other < 80; ++other) {
      double squared = 0;
      for (std::size_t i = 0; i < 37; ++i)
        squared += std::pow(source[std::size_t(row)][i] - target[std::size_t(other)][i], 2);
      if (squared < least) least = squared, nearest = other;
    }
    EXPECT_EQ(matches.target_points(row, 0), nearest);
    EXPECT_NEAR(matches.feature_distance(row), std::sqrt(least), 1e-12);
  }
  EXPECT_EQ(place_.corral("match --source-features f.csv --target-features g.csv -o out.csv").status, 2);
  EXPECT_EQ(place_.corral("match --source-features f.csv --resolution 1 -o out.csv").status, 2);
  EXPECT_EQ(place_.corral("match -o out.csv").status, 2);
  put("h.csv", "0,0,0,1\n");
  const Outcome other =
      place_.corral("match --source-features f.csv --target-features h.csv --resolution 1 -o out.csv");
  EXPECT_EQ(other.status, 3);
  EXPECT_THAT(other.err, HasSubstr("length of the target features"));
}

TEST_F(ImportTest, PublishedTablesHaveTheirKnownCounts) {
  const char* data = std::getenv("CORRAL_REAL_DATA");
  if (!data) GTEST_SKIP() << "CORRAL_REAL_DATA is not set";
  const std::string folder = std::string(data) + "/field/clouds/eth-tls/";
  const std::vector<std::array<std::string, 3>> known = {{"s2", "s2_s1", "2236 matches, 205 correct within 0.3"},
                                                         {"s3", "s3_s1", "1895 matches, 247 correct within 0.3"}};
  for (const auto& [source, sides, counts] : known) {
    const Outcome outcome = place_.corral("import matches " + folder + sides + "_top3.match --truth " + folder +
                                          source + "-s1.pose --source " + folder + source + "_v0.1_sor.pcd --target " +
                                          folder + "s1_v0.1_sor.pcd --correct-within 0.3 -o out.csv");
    EXPECT_EQ(outcome.status, 0);
    EXPECT_THAT(outcome.err, HasSubstr(counts));
  }
  const Outcome set = place_.corral("import matches " + folder + " --correct-within 0.3 -o eth");
  EXPECT_EQ(set.status, 0);
  for (const auto& one : known) EXPECT_THAT(set.err, HasSubstr(one[1] + ": " + one[2]));
}

}  // namespace
}  // namespace corral
