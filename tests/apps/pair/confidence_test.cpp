// SPDX-License-Identifier: MIT
#include "apps/pair/confidence_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernel/random.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

using ::testing::HasSubstr;

/// Poses of ten groups: right with a probability that rises with signal 0 and falls with signal 1; the others are noise, and
/// the last is constant.
std::vector<JudgedPose> some_poses(int count, std::uint64_t seed) {
  RandomStream random(seed);
  std::vector<JudgedPose> poses;
  for (int i = 0; i < count; ++i) {
    JudgedPose pose;
    for (double& signal : pose.signals) signal = random.normal();
    pose.signals.back() = 3;
    pose.is_right = random.uniform() < 1 / (1 + std::exp(-(1 + 3 * pose.signals[0] - pose.signals[1])));
    pose.group = std::to_string(i % 10);
    poses.push_back(pose);
  }
  return poses;
}

std::vector<double> probabilities(const ConfidenceModel& model, const std::vector<JudgedPose>& poses) {
  std::vector<double> found;
  for (const JudgedPose& pose : poses) found.push_back(model.probability(pose.signals));
  return found;
}

TEST(Confidence, LearnsWhatSpeaksForAPose) {
  const ConfidenceModel model = fit_confidence(some_poses(2000, 1));
  EXPECT_NEAR(model.slope * model.weight[0] / model.deviation[0], 2.6, 0.4)
      << "3, less what the signal that is not used takes from it";
  EXPECT_EQ(model.weight[1], 0) << "a signal whose rise is bad is not used";
  EXPECT_EQ(model.weight.back(), 0);
  EXPECT_EQ(model.pairs, 2000);
  EXPECT_EQ(model.groups, 10);
  const std::vector<JudgedPose> others = some_poses(2000, 2);
  const Reliability found = reliability(probabilities(model, others), others);
  EXPECT_GT(found.area, 0.9);
  EXPECT_LT(found.calibration_error, 0.04);
  EXPECT_GT(found.kept_right, 0.9 * found.kept);
  ConfidenceSignals weak{}, strong{};
  weak[0] = -2, strong[0] = 2;
  EXPECT_LT(model.probability(weak), 0.1);
  EXPECT_GT(model.probability(strong), 0.9);
  EXPECT_EQ(model.weakest(weak), 0u);
  EXPECT_EQ(model.strongest(strong), 0u);
}

TEST(Confidence, RisesWithEverySignal) {
  const std::vector<JudgedPose> poses = some_poses(400, 3);
  const ConfidenceModel model = fit_confidence(poses);
  for (std::size_t k = 0; k < kSignals; ++k)
    for (const JudgedPose& pose : {poses[0], poses[1], poses[2]}) {
      ConfidenceSignals better = pose.signals;
      better[k] += 1;
      EXPECT_GE(model.probability(better), model.probability(pose.signals));
    }
}

TEST(Confidence, IsTheShareOfRightPosesWhereNothingTellsThemApart) {
  std::vector<JudgedPose> poses = some_poses(200, 4);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    poses[i].signals.fill(1);
    poses[i].is_right = i % 10 < 3;
  }
  EXPECT_NEAR(fit_confidence(poses).probability(poses[0].signals), 0.3, 0.02) << "the same objects are right each time";
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i].group = std::to_string(i / 20);
  EXPECT_NEAR(fit_confidence(poses).probability(poses[0].signals), 0.3, 0.02);
}

TEST(Confidence, TheOrderOfThePosesDoesNotMatter) {
  std::vector<JudgedPose> poses = some_poses(300, 5);
  const ConfidenceModel model = fit_confidence(poses);
  std::reverse(poses.begin(), poses.end());
  const ConfidenceModel again = fit_confidence(poses);
  for (const JudgedPose& pose : poses)
    EXPECT_NEAR(model.probability(pose.signals), again.probability(pose.signals), 1e-6);
}

TEST(Confidence, PosesOfAGroupAreJudgedByTheOthers) {
  std::vector<JudgedPose> poses = some_poses(300, 6);
  const std::vector<double> before = held_out_probabilities(poses);
  for (JudgedPose& pose : poses)
    if (pose.group == "7") pose.is_right = !pose.is_right;
  const std::vector<double> after = held_out_probabilities(poses);
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (poses[i].group == "7") {
      EXPECT_EQ(before[i], after[i]);
    }
}

TEST(Confidence, NeedsRightAndWrongPosesOfSeveralGroups) {
  const auto refusal = [](const std::vector<JudgedPose>& poses) -> std::string {
    try {
      fit_confidence(poses);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  std::vector<JudgedPose> poses = some_poses(100, 7);
  for (JudgedPose& pose : poses) pose.group = "one";
  EXPECT_THAT(refusal(poses), HasSubstr("two at least"));
  poses = some_poses(100, 7);
  for (JudgedPose& pose : poses) pose.is_right = true;
  EXPECT_THAT(refusal(poses), HasSubstr("ten of each"));
}

TEST(Reliability, IsWhatIsCountedByHand) {
  std::vector<JudgedPose> poses(4);
  poses[0].is_right = true;
  const Reliability found = reliability({0.9, 0.9, 0.2, 0.2}, poses);
  EXPECT_NEAR(found.brier, 0.225, 1e-12);
  EXPECT_NEAR(found.calibration_error, 0.3, 1e-12);  // one bin: |0.25 - 0.55|
  EXPECT_NEAR(found.area, 2.5 / 3, 1e-12);
  EXPECT_EQ(found.kept, 2);
  EXPECT_EQ(found.kept_right, 1);
  std::vector<JudgedPose> many(40);
  std::vector<double> p(40, 0.2);
  for (std::size_t i = 20; i < 40; ++i) p[i] = 0.8, many[i].is_right = i % 2 == 0;
  EXPECT_NEAR(reliability(p, many).calibration_error, (0.2 + 0.3) / 2, 1e-12) << "two bins";
}

TEST(ConfidenceFile, ReadsBackWhatItWrites) {
  const ConfidenceModel model = fit_confidence(some_poses(200, 8));
  const std::string text = confidence_text({model, model});
  const ConfidenceModels read = parse_confidence("c.toml", text);
  EXPECT_EQ(read.surfaces.weight, model.weight);
  EXPECT_EQ(read.table.mean, model.mean);
  EXPECT_EQ(read.table.high, model.high);
  EXPECT_EQ(read.surfaces.slope, model.slope);
  EXPECT_EQ(read.surfaces.right, model.right);
  EXPECT_THAT(testing::io_error_of([&] { parse_confidence("c.toml", "[surfaces]\npairs = 1\n"); }), HasSubstr("mean"));
  EXPECT_THAT(testing::io_error_of([&] { parse_confidence("c.toml", text.substr(0, text.find("[table]"))); }),
              HasSubstr("[table]"));
}

// The models that the program carries were fitted to real poses, and use more than one signal.
TEST(ConfidenceFile, TheProgramCarriesOne) {
  for (const ConfidenceModel* model : {&built_in_confidence().surfaces, &built_in_confidence().table}) {
    EXPECT_GE(model->right, 10);
    EXPECT_GE(model->pairs - model->right, 10);
    EXPECT_GE(std::count_if(model->weight.begin(), model->weight.end(), [](double b) { return b > 0; }), 2);
    EXPECT_GT(model->slope, 0);
  }
}

}  // namespace
}  // namespace corral
