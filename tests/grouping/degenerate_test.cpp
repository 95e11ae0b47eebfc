// SPDX-License-Identifier: MIT
// Every grouper on tables at the end of all ranges: an answer in good form, always the same, and that of the reference.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/degenerate_tables.h"
#include "tests/support/grouper_variants.h"
#include "tests/support/same_result.h"
#include "tests/support/table_changes.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using testing::degenerate_tables;
using testing::GrouperVariant;

class DegenerateTables : public ::testing::TestWithParam<GrouperVariant> {
 protected:
  GroupingResult group(const CorrespondenceSet& matches) const { return GetParam().group(matches); }
};

void expect_good_form(const GroupingResult& result, int rows) {
  for (std::size_t i = 1; i < result.selected.size(); ++i) EXPECT_LT(result.selected[i - 1], result.selected[i]);
  for (const int row : result.selected) EXPECT_TRUE(row >= 0 && row < rows) << row;
  EXPECT_THAT(result.scores.size(), ::testing::AnyOf(0U, static_cast<std::size_t>(rows)));
  for (const double score : result.scores) EXPECT_TRUE(std::isfinite(score)) << score;
  if (!result.target_from_source) return;
  EXPECT_TRUE(is_rotation(result.target_from_source->rotation, 1e-9));
  EXPECT_TRUE(result.target_from_source->translation.allFinite());
}

TEST_P(DegenerateTables, AnswerIsInGoodForm) {
  for (const auto& [name, matches] : degenerate_tables()) {
    SCOPED_TRACE(name);
    GroupingResult result;
    ASSERT_NO_THROW(result = group(matches));
    expect_good_form(result, matches.size());
  }
}

TEST_P(DegenerateTables, AnswerIsTheSameTwiceAndOnEveryTarget) {
  for (const auto& [name, matches] : degenerate_tables()) {
    SCOPED_TRACE(name);
    testing::expect_same_result(group(matches), group(matches));
    testing::expect_same_on_every_target(GetParam().group, matches);
  }
}

TEST_P(DegenerateTables, AnswerIsThatOfTheReference) {
  for (const auto& [name, matches] : degenerate_tables()) {
    SCOPED_TRACE(name);
    testing::expect_reference(group(matches), GetParam().reference(matches));
  }
}

TEST_P(DegenerateTables, ThreeRowsAThousandTimes) {
  const CorrespondenceSet three = testing::synthetic(3, 0.67, 1).matches;
  Indices rows;
  const bool is_cubic = GetParam().name.rfind("mac", 0) == 0;  // in the rows that are all compatible
  for (int row = 0; row < (is_cubic ? 300 : 3000); ++row) rows.push_back(row % 3);
  const CorrespondenceSet matches = select_rows(three, rows);
  // The dense solver of the reference would work for minutes on 3000 rows. That copies in conflict change nothing is
  // worked out and tested in property_test.cpp.
  const bool first_copies = GetParam().promises.copies == testing::Copies::First;
  testing::expect_reference(group(matches), GetParam().reference(first_copies ? three : matches));
}

INSTANTIATE_TEST_SUITE_P(Variants, DegenerateTables, ::testing::ValuesIn(testing::grouper_variants()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace corral
