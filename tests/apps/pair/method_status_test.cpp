// SPDX-License-Identifier: MIT
#include "apps/pair/method_status.h"

#include <gtest/gtest.h>

namespace corral {
namespace {

TEST(MethodStatus, ReadsBackWhatWasWritten) {
  for (int place = 0; place <= static_cast<int>(MethodState::Failed); ++place) {
    MethodStatus status{static_cast<MethodState>(place)};
    EXPECT_EQ(parse_status(to_text(status)), status) << to_text(status);
    if (status.state < MethodState::TooLarge) continue;
    status.cause = "needs 9 GB: failed: so";
    EXPECT_EQ(parse_status(to_text(status)), status) << to_text(status);
  }
  EXPECT_EQ(to_text(MethodStatus{MethodState::Failed, "no mesh"}), "failed: no mesh");
  EXPECT_EQ(to_text(MethodStatus{MethodState::NotConverged}), "not converged");
}

TEST(MethodStatus, RefusesOtherWords) {
  for (const char* text : {"Refined", "refined: so", "failed", "failed:so", " "})
    EXPECT_FALSE(parse_status(text)) << text;
}

TEST(MethodStatus, IsThatOfThePose) {
  for (const RefineStatus status :
       {RefineStatus::Refined, RefineStatus::TooFewRows, RefineStatus::DegenerateGeometry, RefineStatus::Diverged}) {
    RefinedPose pose;
    pose.status = status;
    pose.converged = true;
    EXPECT_EQ(to_text(status_of(pose)), to_text(status));
  }
  RefinedPose moving;
  moving.status = RefineStatus::Refined;
  moving.target_from_source.emplace();
  EXPECT_EQ(status_of(moving).state, MethodState::NotConverged);
  moving.converged = true;
  EXPECT_EQ(status_of(moving).state, MethodState::Refined);
}

}  // namespace
}  // namespace corral
