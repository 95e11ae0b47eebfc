// SPDX-License-Identifier: MIT
#include "kernel/options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::HasSubstr;
using testing::refusal_of;

enum class Colour { Red, DarkGreen };
constexpr std::array<const char*, 2> choice_names(Colour) { return {"red", "dark_green"}; }

/// One field of every kind.
struct SampleOptions {
  double length_pr = 3;
  int count = 10;
  std::uint64_t seed = 1;
  bool fast = false;
  Colour colour = Colour::Red;
  double share = 0.5;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(OptionField{"length_pr", "pr", "3", "a length", above(0)}, self.length_pr);
    visit(OptionField{"count", "", "", "a number of things", at_least(1)}, self.count);
    visit(OptionField{"seed", "", "", "a seed", at_least(0)}, self.seed);
    visit(OptionField{"fast", "", "false", "a switch"}, self.fast);
    visit(OptionField{"colour", "", "red", "a choice"}, self.colour);
    visit(OptionField{"share", "", "", "a share", within(0, 1)}, self.share);
  }
};

SampleOptions parsed(const OptionOverrides& overrides) { return parse_options<SampleOptions>(overrides, "sample"); }
std::string refusal(const OptionOverrides& overrides) {
  return refusal_of([&] { parsed(overrides); });
}

TEST(Options, NoOverridesGiveTheDefaults) {
  const SampleOptions options = parsed({});
  EXPECT_EQ(options.length_pr, 3);
  EXPECT_EQ(options.count, 10);
  EXPECT_EQ(options.seed, 1U);
  EXPECT_FALSE(options.fast);
  EXPECT_EQ(options.colour, Colour::Red);
  EXPECT_EQ(options.share, 0.5);
}

TEST(Options, EveryKindIsParsed) {
  const SampleOptions options = parsed({{"length_pr", "2.5e1"},
                                        {"count", "+7"},
                                        {"seed", "18446744073709551615"},
                                        {"fast", "true"},
                                        {"colour", "dark_green"},
                                        {"share", "1"}});
  EXPECT_EQ(options.length_pr, 25);
  EXPECT_EQ(options.count, 7);
  EXPECT_EQ(options.seed, std::numeric_limits<std::uint64_t>::max());
  EXPECT_TRUE(options.fast);
  EXPECT_EQ(options.colour, Colour::DarkGreen);
  EXPECT_EQ(options.share, 1);
}

TEST(Options, DescriptionHoldsEveryFieldInOrder) {
  const auto values = describe_options(SampleOptions());
  ASSERT_EQ(values.size(), 6U);
  EXPECT_EQ(values[0].name, "length_pr");
  EXPECT_EQ(values[0].unit, "pr");
  EXPECT_EQ(values[0].value, "3");
  EXPECT_EQ(values[0].paper, "3");
  EXPECT_EQ(values[0].meaning, "a length");
  EXPECT_THAT(values[0].accepted, HasSubstr("above 0"));
  EXPECT_THAT(values[1].accepted, HasSubstr("whole number"));
  EXPECT_EQ(values[3].accepted, "false|true");
  EXPECT_EQ(values[4].accepted, "red|dark_green");
  EXPECT_EQ(values[5].name, "share");
}

TEST(Options, DescriptionReadsBackAsTheSameValues) {
  SampleOptions options;
  options.length_pr = 0.1 + 0.2;  // needs 17 digits
  options.count = std::numeric_limits<int>::max();
  options.seed = 9007199254740993;  // not a double
  options.fast = true;
  options.colour = Colour::DarkGreen;
  options.share = 1.0 / 3;
  OptionOverrides overrides;
  for (const OptionValue& value : describe_options(options)) overrides[value.name] = value.value;
  const SampleOptions again = parsed(overrides);
  EXPECT_EQ(again.length_pr, options.length_pr);
  EXPECT_EQ(again.count, options.count);
  EXPECT_EQ(again.seed, options.seed);
  EXPECT_EQ(again.fast, options.fast);
  EXPECT_EQ(again.colour, options.colour);
  EXPECT_EQ(again.share, options.share);
}

TEST(Options, UnknownNameListsTheKnownOnes) {
  const std::string text = refusal({{"lenght_pr", "3"}});
  EXPECT_THAT(text, HasSubstr("sample"));
  EXPECT_THAT(text, HasSubstr("lenght_pr"));
  for (const char* known : {"length_pr", "count", "seed", "fast", "colour", "share"})
    EXPECT_THAT(text, HasSubstr(known));
}

TEST(Options, TextThatIsNoValueIsRefused) {
  const OptionOverrides bad[] = {
      {{"length_pr", ""}},
      {{"length_pr", "3pr"}},
      {{"length_pr", " 3"}},
      {{"length_pr", "3,5"}},
      {{"count", "2.5"}},
      {{"count", "many"}},
      {{"count", "1e3"}},
      {{"count", "3000000000"}},
      {{"seed", "-1"}},
      {{"seed", "1.0"}},
      {{"seed", "18446744073709551616"}},
      {{"fast", "yes"}},
      {{"fast", "1"}},
      {{"fast", "True"}},
      {{"colour", "blue"}},
      {{"colour", "Red"}},
      {{"colour", "0"}},
      {{"share", "1/2"}},
  };
  for (const auto& overrides : bad) {
    const auto& [name, text] = *overrides.begin();
    EXPECT_THAT(refusal(overrides), HasSubstr("option " + name)) << text;
    EXPECT_THAT(refusal(overrides), HasSubstr("'" + text + "'"));
  }
  EXPECT_THAT(refusal({{"colour", "blue"}}), HasSubstr("red|dark_green"));
}

TEST(Options, ValueOutOfRangeIsRefused) {
  const OptionOverrides bad[] = {
      {{"length_pr", "0"}},    {{"length_pr", "-1"}}, {{"length_pr", "nan"}}, {{"length_pr", "inf"}},
      {{"length_pr", "-inf"}}, {{"count", "0"}},      {{"share", "-1e-300"}}, {{"share", "1.0000000000000002"}},
      {{"share", "nan"}},
  };
  for (const auto& overrides : bad) {
    const auto& [name, text] = *overrides.begin();
    EXPECT_THAT(refusal(overrides), HasSubstr("option " + name)) << text;
  }
  EXPECT_EQ(refusal({{"share", "0"}}), "");
  EXPECT_EQ(refusal({{"share", "1"}}), "");
  EXPECT_EQ(refusal({{"length_pr", "1e-300"}}), "");
  EXPECT_EQ(refusal({{"count", "1"}}), "");
}

TEST(Options, ValidationChecksWhatWasSetInCode) {
  SampleOptions options;
  EXPECT_NO_THROW(validate_options(options, "sample"));
  for (const double bad : {std::nan(""), HUGE_VAL, 0.0, -2.0}) {
    options.length_pr = bad;
    const std::string text = refusal_of([&] { validate_options(options, "sample"); });
    EXPECT_THAT(text, HasSubstr("sample"));
    EXPECT_THAT(text, HasSubstr("length_pr"));
  }
}

TEST(OptionRange, EndsAreOpenOrClosed) {
  EXPECT_FALSE(above(0).contains(0));
  EXPECT_TRUE(at_least(0).contains(0));
  EXPECT_TRUE(within(0, 1).contains(0) && within(0, 1).contains(1));
  EXPECT_FALSE(above_up_to(0, 1).contains(0));
  EXPECT_TRUE(above_up_to(0, 1).contains(1));
  for (const OptionRange& range : {above(0), at_least(0), within(0, 1), above_up_to(0, 1)})
    for (const double never : {std::nan(""), HUGE_VAL, -1.0}) EXPECT_FALSE(range.contains(never));
}

}  // namespace
}  // namespace corral
