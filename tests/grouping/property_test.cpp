// SPDX-License-Identifier: MIT
// What the definitions promise, on a thousand small random tables each: the selection of the reference, and the same
// selection whatever the unit, the pose, the order of the rows and the registers of the machine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numeric>

#include "tests/support/grouper_variants.h"
#include "tests/support/random_tables.h"
#include "tests/support/row_order.h"
#include "tests/support/same_result.h"
#include "tests/support/table_changes.h"

namespace corral {
namespace {

using testing::by_old_name;
using testing::Copies;
using testing::grouper_variants;
using testing::GrouperVariant;
using testing::on_a_grid;
using testing::Promises;
using testing::Turns;
using testing::variants_where;
using testing::with_moved_source;
using testing::with_moved_target;

constexpr int kCases = 1000;

class GrouperProperty : public ::testing::TestWithParam<GrouperVariant> {
 protected:
  GroupingResult group(const CorrespondenceSet& matches) const { return GetParam().group(matches); }
  reference::Selection reference(const CorrespondenceSet& matches) const { return GetParam().reference(matches); }

  void expect_same_answer(const CorrespondenceSet& changed, const CorrespondenceSet& matches) const {
    const GroupingResult found = group(changed), expected = group(matches);
    EXPECT_EQ(found.selected, expected.selected);
    EXPECT_EQ(found.scores, expected.scores);
  }
};

/// Calls check(table, random) for as many cases that are not `left_out`, up to the first that fails.
template <class LeftOut, class Check>
void for_each_case_but(LeftOut left_out, Check check) {
  int kept = 0;
  for (int number = 0; kept < kCases && !::testing::Test::HasFailure(); ++number) {
    SCOPED_TRACE("case " + std::to_string(number));
    ASSERT_LT(number, 10 * kCases) << "too many cases are left out";
    RandomStream random = testing::stream_of_case(number);
    const CorrespondenceSet matches = testing::random_table(random);
    if (left_out(matches)) continue;
    ++kept;
    check(matches, random);
  }
}

template <class Check>
void for_each_case(Check check) {
  for_each_case_but([](const CorrespondenceSet&) { return false; }, check);
}

/// Maps axes to axes.
Eigen::Matrix3d axis_turn(RandomStream& random, Turns turns) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
  const int first = static_cast<int>(random.below(3));
  const int step = turns == Turns::AxesInCycle ? 1 : 1 + static_cast<int>(random.below(2));
  for (int axis = 0; axis < 3; ++axis) turn(axis, (first + step * axis) % 3) = 1;
  if (turns == Turns::AxesInCycle) return turn;
  for (int axis = 0; axis < 2; ++axis)
    if (random.below(2) == 1) turn.row(axis) *= -1;
  turn.row(2) *= turn.determinant();
  return turn;
}

/// Exact on tables on the grid.
RigidTransform motion_on_the_grid(RandomStream& random, const Promises& promises, Turns turns) {
  RigidTransform motion;
  motion.rotation = axis_turn(random, turns);
  for (double& shift : motion.translation) shift = std::floor(random.uniform(-0x1p30, 0x1p30)) * 0x1p-20;
  if (promises.knows_origin) motion.translation.setZero();
  return motion;
}

RigidTransform any_motion(RandomStream& random, const Promises& promises) {
  RigidTransform motion;
  motion.rotation = random.rotation();
  if (!promises.knows_origin) motion.translation = random.uniform(0, 1000) * random.direction();
  return motion;
}

TEST_P(GrouperProperty, AnswerIsThatOfTheReference) {
  int selecting = 0;
  for_each_case([&](const CorrespondenceSet& matches, RandomStream&) {
    const reference::Selection expected = reference(matches);
    testing::expect_reference(group(matches), expected);
    selecting += !expected.rows.empty();
  });
  EXPECT_GT(selecting, kCases / 10) << "hardly anything was compared";
}

TEST_P(GrouperProperty, UnitOfLengthDoesNotMatter) {
  for_each_case([&](const CorrespondenceSet& matches, RandomStream& random) {
    const double factor = std::ldexp(1.0, static_cast<int>(random.below(81)) - 40);  // exact in floating point
    expect_same_answer(testing::scaled(matches, factor), matches);
  });
}

TEST_P(GrouperProperty, MotionOfTheSourceDoesNotMatter) {
  for_each_case([&](const CorrespondenceSet& matches, RandomStream& random) {
    const CorrespondenceSet exact = on_a_grid(matches);
    expect_same_answer(with_moved_source(exact, motion_on_the_grid(random, GetParam().promises, Turns::Any)), exact);
    expect_same_answer(with_moved_source(matches, any_motion(random, GetParam().promises)), matches);
  });
}

TEST_P(GrouperProperty, ExactMotionOfTheTargetDoesNotMatter) {
  const Promises& promises = GetParam().promises;
  const auto tie_of_cells = [&](const CorrespondenceSet& matches) {
    return promises.turns != Turns::Any && reference(matches).tied;
  };
  for_each_case_but(tie_of_cells, [&](const CorrespondenceSet& matches, RandomStream& random) {
    const CorrespondenceSet exact = on_a_grid(matches);
    expect_same_answer(with_moved_target(exact, motion_on_the_grid(random, promises, promises.turns)), exact);
  });
}

TEST_P(GrouperProperty, TargetDoesNotMatter) {
  for_each_case([&](const CorrespondenceSet& matches, RandomStream&) {
    testing::expect_same_on_every_target(GetParam().group, matches);
  });
}

/// Properties that not every variant has.
class GrouperWithoutAxes : public GrouperProperty {};
class GrouperWithoutRowNumbers : public GrouperProperty {};
class SymmetricGrouper : public GrouperProperty {};
class GrouperOfCopies : public GrouperProperty {};

TEST_P(GrouperWithoutAxes, AnyMotionOfTheTargetDoesNotMatter) {
  for_each_case([&](const CorrespondenceSet& matches, RandomStream& random) {
    expect_same_answer(with_moved_target(matches, any_motion(random, GetParam().promises)), matches);
  });
}

/// Not for RANSAC: no residual of a fitted pose sits on its limit.
TEST_P(GrouperWithoutRowNumbers, LimitsBelongToTheSideThatTheReferenceSays) {
  for (int number = 0; number < kCases && !HasFailure(); ++number) {
    SCOPED_TRACE("case " + std::to_string(number));
    RandomStream random = testing::stream_of_case(number);
    const CorrespondenceSet matches = testing::table_on_the_limits(random);
    testing::expect_reference(group(matches), reference(matches));
  }
}

TEST_P(GrouperWithoutRowNumbers, OrderOfTheRowsDoesNotMatter) {
  const auto tie = [&](const CorrespondenceSet& matches) { return reference(matches).tied; };
  for_each_case_but(tie, [&](const CorrespondenceSet& matches, RandomStream& random) {
    const Indices old_row = testing::shuffled_rows(matches.size(), random.below(1u << 31));
    EXPECT_EQ(by_old_name(group(select_rows(matches, old_row)).selected, old_row), group(matches).selected);
  });
}

TEST_P(SymmetricGrouper, SidesMayBeSwapped) {
  for_each_case([&](const CorrespondenceSet& matches, RandomStream&) {
    expect_same_answer(testing::with_sides_swapped(matches), matches);
  });
}

TEST_P(GrouperOfCopies, EveryRowTwiceSelectsTheSame) {
  for_each_case([&](const CorrespondenceSet& matches, RandomStream&) {
    Indices twice(static_cast<std::size_t>(2 * matches.size()));
    std::iota(twice.begin(), twice.begin() + matches.size(), 0);
    std::iota(twice.begin() + matches.size(), twice.end(), 0);
    Indices expected = group(matches).selected;
    if (GetParam().promises.copies == Copies::Both)
      for (const int row : Indices(expected)) expected.push_back(row + matches.size());
    EXPECT_EQ(group(select_rows(matches, twice)).selected, expected);
  });
}

std::string name_of(const ::testing::TestParamInfo<GrouperVariant>& test) { return test.param.name; }

INSTANTIATE_TEST_SUITE_P(Variants, GrouperProperty, ::testing::ValuesIn(grouper_variants()), name_of);
INSTANTIATE_TEST_SUITE_P(Variants, GrouperWithoutAxes,
                         ::testing::ValuesIn(variants_where([](const Promises& p) { return p.turns == Turns::Any; })),
                         name_of);
// Not for RANSAC, which draws its triples by the numbers of rows: in another order it tries others.
INSTANTIATE_TEST_SUITE_P(Variants, GrouperWithoutRowNumbers,
                         ::testing::ValuesIn(variants_where([](const Promises& p) { return !p.numbers_rows; })),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Variants, SymmetricGrouper,
                         ::testing::ValuesIn(variants_where([](const Promises& p) { return p.symmetric; })), name_of);
INSTANTIATE_TEST_SUITE_P(Variants, GrouperOfCopies, ::testing::ValuesIn(variants_where([](const Promises& p) {
                           return p.copies != Copies::Unlike;
                         })),
                         name_of);

}  // namespace
}  // namespace corral
