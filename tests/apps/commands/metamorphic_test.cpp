// SPDX-License-Identifier: MIT
// The same pair told otherwise, to whole commands: the answer follows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/text/csv_file.h"
#include "kernel/random.h"
#include "tests/support/renumbering.h"
#include "tests/support/small_study.h"

namespace corral {
namespace {

using namespace testing;
using nlohmann::json;
using Selections = std::map<std::string, std::vector<std::pair<int, int>>>;

class Metamorphic : public ::testing::Test {
 protected:
  Metamorphic() {
    place_.put_pair();
    source_ = read_mesh(place_ / "model.ply");
    target_ = read_mesh(place_ / "copy.ply");
    truth_ = read_transform(place_ / "truth.txt");
  }

  /// What `corral run` says, without times and names of files.
  json run(const Mesh& source, const Mesh& target, const RigidTransform& truth) const {
    write_mesh(place_ / "a.ply", source);
    write_mesh(place_ / "b.ply", target);
    place_.put("t.txt", transform_text(truth));
    const Outcome outcome = place_.corral("run a.ply b.ply --truth t.txt --normals mesh --methods all --json -o out");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    json said = outcome.json();
    for (auto& method : said["methods"]) method.erase("time_ms");
    return said;
  }
  json run() const { return run(source_, target_, truth_); }

  /// The selected pairs of vertices, by grouper, behind run().
  Selections selections(const Indices& source_row = {}, const Indices& target_row = {}) const {
    Selections all;
    const CorrespondenceSet matches = read_matches(place_ / "out/matches.csv");
    for (const auto& method :
         place_.text("out/run.json").empty() ? json() : json::parse(place_.text("out/run.json"))["methods"]) {
      const std::string name = method["method"];
      for (const int row : read_group(place_ / ("out/group_" + name + ".csv")).selected) {
        const int a = matches.source_keypoints[static_cast<std::size_t>(row)];
        const int b = matches.target_keypoints[static_cast<std::size_t>(row)];
        all[name].emplace_back(source_row.empty() ? a : source_row[static_cast<std::size_t>(a)],
                               target_row.empty() ? b : target_row[static_cast<std::size_t>(b)]);
      }
      std::sort(all[name].begin(), all[name].end());
    }
    return all;
  }

  const Workplace place_;
  Mesh source_, target_;
  RigidTransform truth_;
};

TEST_F(Metamorphic, TheTruthAsAPoseIsExactlyRight) {
  run();
  const json score =
      place_.corral("score out/matches.csv --pose t.txt --truth t.txt --source a.ply --target b.ply --json").json();
  for (const char* error : {"translation_error_pr", "rmse_pr", "mean_error_pr", "add_share", "add_s_share"})
    EXPECT_EQ(score[std::string("initial_") + error], 0) << error << " of " << score.dump(1);
  EXPECT_LT(score["initial_rotation_error_deg"], 1e-12);  // the rotation of a file is orthonormal to rounding
  EXPECT_EQ(score["recall"], 1);
  for (const char* success : {"5pr", "add", "add_s"})
    EXPECT_EQ(score[std::string("initial_success_") + success], true) << success;
}

// A power of two changes no bit but exponents.
TEST_F(Metamorphic, InAnotherUnitAllNumbersAreTheSame) {
  const json before = run();
  const Selections selected = selections();
  Mesh source = source_, target = target_;
  source.vertices *= 1024;
  target.vertices *= 1024;
  json after = run(source, target, {truth_.rotation, 1024 * truth_.translation});
  EXPECT_EQ(after["resolution"].get<double>(), 1024 * before["resolution"].get<double>());
  EXPECT_EQ(after["matches"], before["matches"]);
  EXPECT_EQ(after["true_matches"], before["true_matches"]);
  EXPECT_EQ(selections(), selected);
  for (std::size_t i = 0; i < before["methods"].size(); ++i)
    for (const auto& [key, value] : before["methods"][i].items()) {
      const json& now = after["methods"][i][key];
      if (value.is_number_float())
        EXPECT_NEAR(now.get<double>(), value.get<double>(), 1e-6 + 1e-6 * value.get<double>()) << key;
      else
        EXPECT_EQ(now, value) << before["methods"][i]["method"] << " " << key;
    }
}

// RANSAC draws rows by their number, and the order of vertices gives the rows theirs; no other grouper may see it.
TEST_F(Metamorphic, TheNumbersOfVerticesDoNotMatter) {
  const json before = run();
  const Selections selected = selections();
  RandomStream random(3);
  const auto shuffled = [&](Eigen::Index count) {
    Indices rows(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<int>(i);
    for (std::size_t i = rows.size(); i > 1; --i) std::swap(rows[i - 1], rows[random.below(i)]);
    return rows;
  };
  const Indices source_rows = shuffled(source_.vertices.rows()), target_rows = shuffled(target_.vertices.rows());
  const json after = run(renumbered(source_, source_rows), renumbered(target_, target_rows), truth_);
  EXPECT_EQ(after["resolution"], before["resolution"]);
  EXPECT_EQ(after["matches"], before["matches"]);
  EXPECT_EQ(after["true_matches"], before["true_matches"]);
  const Selections now = selections(source_rows, target_rows);
  for (const char* method : {"ss", "nnsr", "gc", "hough", "si"})
    EXPECT_EQ(now.at(method), selected.at(method)) << method;
}

// By a right angle, which is exact: the same matches, and poses that follow.
TEST_F(Metamorphic, AMovedTargetMovesThePose) {
  const json before = run();
  const Selections selected = selections();
  const RigidTransform pose = read_transform(place_ / "out/pose_gc.txt");
  RigidTransform turn;
  turn.rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  Mesh target = target_;
  target.vertices = turn.apply(target.vertices);
  const json after = run(source_, target, turn * truth_);
  EXPECT_EQ(after["true_matches"], before["true_matches"]);
  const RigidTransform moved = read_transform(place_ / "out/pose_gc.txt"), expected = turn * pose;
  EXPECT_LT((moved.rotation - expected.rotation).norm(), 1e-3);
  EXPECT_EQ(after["matches"], before["matches"]);
  EXPECT_EQ(selections().at("gc"), selected.at("gc"));
}

}  // namespace
}  // namespace corral
