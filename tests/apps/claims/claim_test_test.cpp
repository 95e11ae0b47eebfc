// SPDX-License-Identifier: MIT
// The kinds of rules, on hand-made numbers.
#include "apps/claims/claim_test.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "apps/claims/claim_file.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsNan;
using Numbers = std::vector<double>;

/// The rule of a claim over the methods a, b, c, d.
ClaimPart rule(const std::string& keys) {
  return parse_claims("claims.toml",
                      "methods = [\"a\", \"b\", \"c\", \"d\"]\n[[claim]]\nid = \"X\"\nparts = [{ experiment = \"e\", " +
                          keys + " }]\n")
      .claims.at(0)
      .parts.at(0);
}

RuleOutcome test(const std::string& comparison, const Numbers& numbers, const Scale& scale = {0.01, false, false}) {
  return test_numbers(rule("is = [\"" + comparison + "\"]"), numbers, scale);
}

void expect(const RuleOutcome& outcome, bool holds, double margin) {
  EXPECT_EQ(outcome.holds, holds);
  EXPECT_NEAR(outcome.margin, margin, 1e-12);
}

TEST(ClaimTest, ComparesTwoMethods) {
  expect(test("a > b", {0.7, 0.5, 0, 0}), true, 0.2);
  expect(test("a < b", {0.7, 0.5, 0, 0}), false, -0.2);
  expect(test("a > b", {0.5, 0.5, 0, 0}), false, 0);
  expect(test("a >= b", {0.5, 0.5, 0, 0}), true, 0);
  expect(test("a >= b - tau", {0.49, 0.5, 0, 0}), true, 0);  // exactly tau, whatever the rounding
  expect(test("a > b - tau", {0.49, 0.5, 0, 0}), false, 0);
  expect(test("a >= b + 0.05", {0.54, 0.5, 0, 0}), false, -0.01);
  expect(test("a <= 0.5 * b", {0.2, 0.5, 0, 0}), true, 0.05);
  expect(test("a >= 0.8", {0.75, 0, 0, 0}), false, -0.05);
}

TEST(ClaimTest, ComparesWithSomeOfAllMethods) {
  const Numbers numbers = {0.1, 0.2, 0.6, 0.9};
  expect(test("c > median", numbers), true, 0.2);  // 0.4
  expect(test("d >= others + 0.05", numbers), true, 0.25);
  expect(test("a > others", numbers), false, -0.8);
  expect(test("max <= 0.6", numbers), false, -0.3);
  expect(test("all >= 0.15", numbers), false, -0.05);
  expect(test("all < 1", numbers), true, 0.1);
  expect(test("mean(c,d) > mean(a,b)", numbers), true, 0.6);
  expect(test("mean(a,b) > others", numbers), false, -0.75);
  expect(test_numbers(rule("is = [\"it < 3\"]"), {2}, {}), true, 1);
  expect(test_numbers(rule("is = [\"c > a\", \"c > b\", \"c > d\"]"), numbers, {}), false, -0.3);
}

TEST(ClaimTest, RanksByMoreThanTau) {
  const Numbers numbers = {0.50, 0.51, 0.52, 0.90};  // a is beaten by c and d, but not by b: exactly tau
  EXPECT_THAT(ranks_of(numbers, {0.01, false, false}), ElementsAre(3, 2, 2, 1));
  expect(test("rank(a) <= 3", numbers), true, 0);
  expect(test("rank(a) <= 2", numbers), false, -0.01);
  expect(test("rank(a) < 3", numbers), false, -0.01);
  expect(test("rank(a) >= 3", numbers), true, 0.01);
  expect(test("rank(a) > 3", numbers), false, 0);
  expect(test("rank(d) <= 1", numbers), true, 0.39);
  EXPECT_TRUE(test("rank(d) >= 1", numbers).holds);
  EXPECT_TRUE(test("rank(d) <= 4", numbers).holds);
  EXPECT_FALSE(test("rank(d) >= 5", numbers).holds);
}

TEST(ClaimTest, RanksAgreeWithTheirComparisons) {
  const Numbers numbers = {0.3, 0.305, 0.32, 0.1};
  const std::string names = "abcd";
  for (const bool lower : {false, true}) {
    const Scale scale{0.01, false, lower};
    const std::vector<int> ranks = ranks_of(numbers, scale);
    for (std::size_t i = 0; i < 4; ++i)
      for (int bound = 1; bound <= 4; ++bound) {
        const std::string left = std::string("rank(") + names[i] + ") ";
        EXPECT_EQ(test(left + "<= " + std::to_string(bound), numbers, scale).holds, ranks[i] <= bound);
        EXPECT_EQ(test(left + ">= " + std::to_string(bound), numbers, scale).holds, ranks[i] >= bound);
      }
  }
}

TEST(ClaimTest, TakesTimesByTheirLogarithms) {
  const Scale times{std::log(1.05), true, true};
  const Numbers numbers = {std::log(2.0), std::log(30.0), std::log(2.05), std::log(100.0)};
  expect(test("a <= 4", numbers, times), true, std::log(2.0));
  expect(test("d >= 10 * b", numbers, times), false, std::log(1 / 3.0));
  expect(test("a <= 0.1 * b", numbers, times), true, std::log(1.5));
  EXPECT_TRUE(test("rank(c) <= 1", numbers, times).holds);  // not slower by more than 5 %
  EXPECT_TRUE(test("rank(b) >= 3", numbers, times).holds);
}

TEST(ClaimTest, FindsTheLargestAndSmallest) {
  const Numbers numbers = {0.9, 0.5, 0.505, 0.1};
  expect(test_numbers(rule("largest = [\"a\", \"c\"]"), numbers, {0.01, false, false}), true, 0.005);
  expect(test_numbers(rule("largest = [\"a\", \"b\"]"), numbers, {0.01, false, false}), false, -0.005);
  expect(test_numbers(rule("largest = [\"a\", \"b\"], ties = true"), numbers, {0.01, false, false}), true, 0.005);
  expect(test_numbers(rule("largest = [\"a\", \"b\"], ties = true"), {0.9, 0.5, 0.51, 0.1}, {0.01, false, false}), true,
         0);
  expect(test_numbers(rule("smallest = [\"d\"]"), numbers, {}), true, 0.4);
  expect(test_numbers(rule("smallest = [\"d\", \"c\"]"), numbers, {}), false, -0.005);
  expect(test_numbers(rule("largest = [\"b\", \"c\"], after = 1"), numbers, {}), true, 0.395);
  expect(test_numbers(rule("largest = [\"b\", \"d\"], after = 1"), numbers, {}), false, -0.405);
  expect(test_numbers(rule("largest = [\"a\", \"b\"], after = 1"), numbers, {}), false, -0.395);
}

TEST(ClaimTest, MissingNumbersDecideNothing) {
  const Numbers numbers = {0.9, std::nan(""), 0.5, 0.1};
  for (const char* comparison : {"b > a", "a > others", "max > 0", "a > median", "all > 0", "rank(a) <= 1", "a >= b"}) {
    EXPECT_FALSE(test(comparison, numbers).holds) << comparison;
    EXPECT_THAT(test(comparison, numbers).margin, IsNan()) << comparison;
  }
  EXPECT_TRUE(test("a > c", numbers).holds);  // does not look at it
  EXPECT_THAT(test_numbers(rule("largest = [\"a\"]"), numbers, {}).margin, IsNan());
}

TEST(ClaimTest, CountsLevels) {
  const RuleOutcome yes{true, 0.2}, barely{true, 0.0}, no{false, -0.1};
  expect(test_levels(Quantifier::Every, {yes, barely}), true, 0);
  expect(test_levels(Quantifier::Every, {yes, no, barely}), false, -0.1);
  expect(test_levels(Quantifier::Most, {yes, no, barely}), true, 0);
  expect(test_levels(Quantifier::Most, {yes, no, no}), false, -0.1);
  expect(test_levels(Quantifier::Half, {yes, no}), true, 0.2);
  expect(test_levels(Quantifier::Half, {yes, no, no}), false, -0.1);
  expect(test_levels(Quantifier::One, {no, no, barely}), true, 0);
  EXPECT_EQ(needed_levels(Quantifier::Most, 9), 6);
  EXPECT_EQ(needed_levels(Quantifier::Most, 7), 5);
  EXPECT_EQ(needed_levels(Quantifier::Most, 1), 1);
  EXPECT_THAT(test_levels(Quantifier::One, {yes, {false, std::nan("")}}).margin, IsNan());
}

TEST(ClaimTest, LeadsAreOverTheBestOther) { EXPECT_THAT(leads_of({1, 4, 2}), ElementsAre(-3, 2, -2)); }

TEST(ClaimFile, NamesWhatIsWrong) {
  const auto complaint = [](const std::string& keys) { return testing::io_error_of([&] { rule(keys); }); };
  EXPECT_THAT(complaint("is = [\"a > e\"]"), HasSubstr("found 'e'"));
  EXPECT_THAT(complaint("is = [\"a >> b\"]"), HasSubstr("not a comparison"));
  EXPECT_THAT(complaint("is = [\"a > b +\"]"), HasSubstr("not a comparison"));
  EXPECT_THAT(complaint("is = [\"a > rank(b)\"]"), HasSubstr("not a comparison"));
  EXPECT_THAT(complaint("is = [\"a\"]"), HasSubstr("not a comparison"));
  EXPECT_THAT(complaint("is = [\"a > median(\"]"), HasSubstr("line 4"));
  EXPECT_THAT(complaint("of = \"precison\", is = [\"a > b\"]"), HasSubstr("did you mean 'precision'?"));
  EXPECT_THAT(complaint("take = \"mean\""), HasSubstr("a rule needs"));
  EXPECT_THAT(complaint("tke = \"mean\", is = [\"a > b\"]"), HasSubstr("did you mean 'take'?"));
  EXPECT_THAT(complaint("take = \"correlation\", is = [\"it > 0\"]"), HasSubstr("with"));
  EXPECT_THAT(complaint("with = [\"y\"], take = \"mean\", is = [\"a > b\"]"), HasSubstr("with"));
  EXPECT_THAT(complaint("take = \"count\", is = [\"a > b\"]"), HasSubstr("over"));
  EXPECT_THAT(complaint("take = \"rise\", over = \"pairs\", is = [\"a > b\"]"), HasSubstr("over"));
  EXPECT_THAT(complaint("first = [2, 1], is = [\"a > b\"]"), HasSubstr("first"));
  EXPECT_THAT(complaint("is = [\"a > b\"], note = true"), HasSubstr("parts"));
  EXPECT_THAT(complaint("is = [\"a > nan\"]"), HasSubstr("found 'nan'"));
  EXPECT_THAT(complaint("is = [\"rank(a) > 1e30\"]"), HasSubstr("expected a rank"));
  EXPECT_THAT(complaint("is = [\"rank(a) > b\"]"), HasSubstr("expected a rank"));
  EXPECT_THAT(complaint("after = 4294967297, is = [\"a > b\"]"), HasSubstr("after: out of range"));
  EXPECT_THAT(complaint("after = -1, is = [\"a > b\"]"), HasSubstr("after: out of range"));
}

TEST(ClaimFile, TakesAnyMeasureByItsTitle) {
  EXPECT_TRUE(rule("is = [\"a > b\"]").of.is_measure("f1"));
  EXPECT_TRUE(rule("of = \"success\", is = [\"a > b\"]").of.is_measure("success_5pr"));
  EXPECT_TRUE(rule("of = \"time\", is = [\"a > b\"]").of.is_time());
  EXPECT_TRUE(rule("of = \"inlier ratio\", is = [\"it > 0\"]").of.is_of_pairs());
}

TEST(ClaimFile, AskForNoMethodWhereThereIsOneNumber) {
  for (const std::string kind : {"of = \"inlier ratio\"", "with = [\"y\"], take = \"correlation\""}) {
    EXPECT_NO_THROW(rule(kind + ", is = [\"it > 0.5\"]"));
    for (const std::string test : {"is = [\"b > 0.5\"]", "is = [\"it > mean(a,b)\"]", "is = [\"rank(a) <= 1\"]",
                                   "largest = [\"b\"]", "smallest = [\"b\"]"})
      EXPECT_THAT(testing::io_error_of([&] { rule(kind + ", " + test); }), HasSubstr("expected 'it'")) << kind << test;
  }
  EXPECT_THAT(testing::io_error_of([&] { rule("of = \"value\", take = \"wins\", is = [\"it > 0\"]"); }),
              HasSubstr("expected 'it'"));
}

}  // namespace
}  // namespace corral
