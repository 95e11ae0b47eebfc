// SPDX-License-Identifier: MIT
#include "apps/pair/register_pair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "apps/pair/match_pair.h"
#include "apps/runtime/workers.h"
#include "kernel/evaluation.h"
#include "kernel/random.h"
#include "kernel/surface/mesh/perturbation.h"
#include "kernel/synthetic.h"
#include "tests/support/program.h"

namespace corral {
namespace {

using ::testing::Contains;
using ::testing::Not;
using testing::Workplace;

RigidTransform motion() {
  RigidTransform pose;
  pose.rotation = RandomStream(3).rotation();
  pose.translation = {3, -2, 1};
  return pose;
}

SyntheticProblem table(double share) {
  SyntheticOptions options;
  options.matches = 300;
  options.inlier_ratio = share;
  options.noise_pr = 0.5;
  return make_synthetic_problem(options);
}

TEST(RegisterPair, FindsThePoseOfATable) {
  const SyntheticProblem problem = table(0.2);
  const Registration found = register_pair(problem.matches, std::nullopt);
  ASSERT_FALSE(found.poses.empty());
  const ProposedPose& best = found.poses.front();
  EXPECT_LT(rotation_error_deg(best.target_from_source, problem.truth), 1);
  EXPECT_GE(best.support, 60);
  ASSERT_TRUE(found.signals);
  for (const double signal : *found.signals) EXPECT_TRUE(std::isfinite(signal));
  EXPECT_EQ((*found.signals)[4], 1) << "all groupers agree";
  for (std::size_t i = 1; i < found.poses.size(); ++i) EXPECT_GE(found.poses[i - 1].score, found.poses[i].score);
}

TEST(RegisterPair, SignalsOfARightPoseAreAboveThoseOfChance) {
  const ConfidenceSignals right = register_pair(table(0.2).matches, std::nullopt).signals.value();
  const ConfidenceSignals wrong = register_pair(table(0).matches, std::nullopt).signals.value();
  for (std::size_t i = 0; i < 5; ++i) EXPECT_GT(right[i], wrong[i]) << kSignalNames[i];
  for (std::size_t i = 5; i < kSignals; ++i) EXPECT_EQ(right[i], 0) << kSignalNames[i] << " needs surfaces";
}

TEST(RegisterPair, AGrouperThatLacksAColumnIsLeftOut) {
  SyntheticProblem problem = table(0.3);
  problem.matches.source_frames.clear();
  problem.matches.target_frames.clear();
  const Registration found = register_pair(problem.matches, std::nullopt);
  EXPECT_THAT(found.methods, Not(Contains("hough")));
  EXPECT_THAT(found.methods, Contains("mac"));
  EXPECT_LT(rotation_error_deg(found.poses.at(0).target_from_source, problem.truth), 1);
}

TEST(RegisterPair, HasNoPoseWithoutMatches) {
  for (const int rows : {0, 1, 2}) {
    SyntheticOptions options;
    options.matches = rows;
    const Registration found = register_pair(make_synthetic_problem(options).matches, std::nullopt);
    EXPECT_TRUE(found.poses.empty());
    EXPECT_FALSE(found.signals);
  }
}

/// A bumpy surface and its moved, noisy copy.
class RegisterSurfaces : public ::testing::Test {
 protected:
  RegisterSurfaces() : source_(testing::bumpy_sphere(4, 1)) {
    target_ = move_mesh(source_, motion());
    RandomStream random(4);
    for (Eigen::Index i = 0; i < target_.vertices.size(); ++i) target_.vertices(i) += 0.002 * random.normal();
    matches_ = match_pair(source_, target_, {}).matches;
  }
  Mesh source_, target_;
  CorrespondenceSet matches_;
};

TEST_F(RegisterSurfaces, TheSurfacesChooseAndRefineThePose) {
  const Registration found = register_pair(matches_, RegisteredSurfaces{source_, target_, {}, {}});
  ASSERT_FALSE(found.poses.empty());
  const ProposedPose& best = found.poses.front();
  EXPECT_LT(point_error(best.target_from_source, motion(), source_.vertices, matches_.resolution)->mean_pr, 0.3);
  EXPECT_GT(best.surfaces.overlap, 0.99);
  EXPECT_GT(best.score, 0.8);
  std::set<double> scores;
  for (const ProposedPose& pose : found.poses) scores.insert(pose.score);
  EXPECT_EQ(*scores.rbegin(), best.score);
}

TEST_F(RegisterSurfaces, IsTheSameForAnyNumberOfThreads) {
  const Registration one = register_pair(matches_, RegisteredSurfaces{source_, target_, {}, {}});
  const Registration two = register_pair(matches_, RegisteredSurfaces{source_, target_, {}, {}}, workers(2));
  ASSERT_EQ(one.poses.size(), two.poses.size());
  for (std::size_t i = 0; i < one.poses.size(); ++i) {
    EXPECT_EQ(one.poses[i].target_from_source.rotation, two.poses[i].target_from_source.rotation);
    EXPECT_EQ(one.poses[i].target_from_source.translation, two.poses[i].target_from_source.translation);
    EXPECT_EQ(one.poses[i].score, two.poses[i].score);
  }
  EXPECT_EQ(one.signals, two.signals);
}

TEST(Register, IsOneCommandForTwoScans) {
  const Workplace place;
  place.put_pair();
  const auto outcome = place.corral(
      "register model.ply copy.ply -o pose.txt --apply moved.ply --picture both.png --truth truth.txt --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["errors"]["registers"], true);
  EXPECT_TRUE(outcome.json()["signals"]["overlap"].is_number());
  const RigidTransform pose = read_transform(place / "pose.txt");
  EXPECT_LT(rotation_error_deg(pose, read_transform(place / "truth.txt")), 1);
  const Mesh moved = read_mesh(place / "moved.ply"), model = read_mesh(place / "model.ply");
  EXPECT_LT((moved.vertices - pose.apply(model.vertices)).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_EQ(place.text("both.png").substr(1, 3), "PNG");
  EXPECT_THAT(place.corral("register model.ply copy.ply").out, ::testing::HasSubstr("coverage"));
}

TEST(Register, WritesNothingThatIsLessProbableThanAskedFor) {
  const Workplace place;
  place.put_problem();
  const double probability = place.corral("register --matches matches.csv --json").json()["confidence"]["probability"];
  ASSERT_GT(probability, 0.5);
  ASSERT_LT(probability, 1);
  const std::string call = "register --matches matches.csv -o pose.txt --least-confidence ";
  const auto refused = place.corral(call + to_text((1 + probability) / 2));
  EXPECT_EQ(refused.status, 4);
  EXPECT_THAT(refused.err, ::testing::HasSubstr("no file was written"));
  EXPECT_FALSE(std::filesystem::exists(place / "pose.txt"));
  const auto written = place.corral(call + to_text(probability / 2));
  EXPECT_EQ(written.status, 0);
  EXPECT_TRUE(std::filesystem::exists(place / "pose.txt"));
  EXPECT_EQ(written.err.find("note"), std::string::npos);
}

TEST(Register, ADoubtfulPoseIsWrittenWithAWord) {
  const Workplace place;
  SyntheticOptions options;
  options.matches = 40, options.inlier_ratio = 0;
  place.put("chance.csv", matches_text(make_synthetic_problem(options).matches));
  const auto outcome = place.corral("register --matches chance.csv -o pose.txt");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, ::testing::HasSubstr("do not use it"));
  EXPECT_THAT(outcome.err, ::testing::HasSubstr("note: the files were written, but the pose is not to be used"));
}

TEST(Register, ATableWillDoAndWhatIsWrongIsSaid) {
  const Workplace place;
  place.put_problem();
  EXPECT_EQ(place.corral("register --matches matches.csv -o pose.txt").status, 0);
  EXPECT_LT(rotation_error_deg(read_transform(place / "pose.txt"), read_transform(place / "truth.txt")), 1);
  EXPECT_EQ(place.corral("register").status, 2);
  EXPECT_EQ(place.corral("register a.ply").status, 2);
  EXPECT_EQ(place.corral("register --matches matches.csv --apply moved.ply").status, 2);
  EXPECT_EQ(place.corral("register --matches matches.csv -o matches.csv").status, 2);
  place.put("two.csv",
            "# corral matches 1\n# resolution "
            "1\nsource_x,source_y,source_z,target_x,target_y,target_z\n1,2,3,4,5,6\n1,2,4,5,6,7\n");
  const auto none = place.corral("register --matches two.csv -o none.txt");
  EXPECT_EQ(none.status, 4);
  EXPECT_THAT(none.out, ::testing::HasSubstr("no pose"));
  EXPECT_FALSE(std::filesystem::exists(place / "none.txt"));
}

}  // namespace
}  // namespace corral
