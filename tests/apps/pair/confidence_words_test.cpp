// SPDX-License-Identifier: MIT
#include "apps/pair/confidence_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kernel/synthetic.h"

namespace corral {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// 40 of 100 matches lie on their targets; a second pose has 9 others.
ConfidenceSignals signals_of_a_table() {
  CorrespondenceSet matches = make_synthetic_problem({}).matches;
  Indices first(100);
  for (int row = 0; row < 100; ++row) first[static_cast<std::size_t>(row)] = row;
  matches = select_rows(matches, first);
  matches.target_points = matches.source_points;
  const Eigen::RowVector3d apart(50 * matches.resolution, 0, 0);
  for (int row = 40; row < 100; ++row) matches.target_points.row(row) += (row < 49 ? 1.0 : row - 40.0) * apart;
  RigidTransform moved;
  moved.translation = apart.transpose();
  return confidence_signals(matches, RigidTransform(), {{RigidTransform(), moved}, {RigidTransform(), moved}, 4},
                            {0.71, 0.21, 1.25, 0.034});
}

TEST(ConfidenceWords, GiveTheNumbersThatTheSignalsWereMadeFrom) {
  const ConfidenceSignals signals = signals_of_a_table();
  std::vector<std::string> words;
  for (std::size_t k = 0; k < kSignals; ++k) words.push_back(signal_words(k, signals[k]));
  EXPECT_EQ(words[0], "40 matches agree with it");
  EXPECT_EQ(words[1], "40 % of the matches agree with it");
  EXPECT_EQ(words[2], "4.1 times as many matches agree with it as with any other pose");
  EXPECT_EQ(words[3], "the matches determine it to within 0.0 pr");
  EXPECT_EQ(words[4], "25 % of the groupers find it");
  EXPECT_EQ(words[5], "71 % of the source lies on the target");
  EXPECT_EQ(words[6], "the surfaces are 0.21 pr apart where they overlap");
  EXPECT_EQ(words[7], "3 % of the points are in front of what the other sensor saw");
  EXPECT_EQ(words[8], "the dense refinement moved it by 1.2 pr");
  EXPECT_EQ(signal_words(0, std::log(2.0)), "1 match agrees with it");
  EXPECT_EQ(signal_words(3, -std::log(100.01)), "too few matches to determine it") << "fewer than four";
}

TEST(ConfidenceWords, SayNothingForAPoseThatNothingSpeaksFor) {
  ConfidenceModel model;
  model.deviation.fill(1), model.weight.fill(1), model.low.fill(-10), model.high.fill(10);
  ConfidenceSignals signals;
  signals.fill(-1);
  signals[5] = -2;
  EXPECT_THAT(confidence_words(model, signals), HasSubstr("do not use it: it is right with a probability of 0.000"));
  EXPECT_THAT(confidence_words(model, signals), HasSubstr("\n  against it: -200 % of the source"));
  EXPECT_THAT(confidence_words(model, signals), Not(HasSubstr("for it:")));
  signals.fill(1);
  EXPECT_THAT(confidence_words(model, signals), HasSubstr("trust it: "));
  EXPECT_THAT(confidence_words(model, signals), HasSubstr("\n  for it: "));
  EXPECT_THAT(confidence_words(model, signals), Not(HasSubstr("against it")));
  EXPECT_THAT(confidence_words(model, signals), Not(HasSubstr("unlike")));
  signals[6] = 11;
  EXPECT_THAT(confidence_words(model, signals), HasSubstr("\n  unlike those pairs: the surfaces are"));
}

}  // namespace
}  // namespace corral
