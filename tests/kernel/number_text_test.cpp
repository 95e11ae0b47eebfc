// SPDX-License-Identifier: MIT
#include "kernel/number_text.h"

#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <cstring>
#include <limits>

#include "kernel/random.h"

namespace corral {
namespace {

using Limits = std::numeric_limits<double>;

std::uint64_t bits_of(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

double value_of(std::uint64_t bits) {
  double value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

void expect_round_trip(double value) {
  const auto back = parse_double(to_text(value));
  ASSERT_TRUE(back.has_value()) << to_text(value);
  EXPECT_EQ(bits_of(*back), bits_of(value)) << to_text(value);
}

TEST(NumberText, EveryBitPatternComesBack) {
  RandomStream random(1);
  for (int trial = 0; trial < 100000; ++trial) {
    const double value = value_of((random.below(1ULL << 32) << 32) | random.below(1ULL << 32));
    if (std::isnan(value)) {
      EXPECT_TRUE(std::isnan(*parse_double(to_text(value))));
    } else {
      expect_round_trip(value);
    }
  }
}

TEST(NumberText, LimitsComeBack) {
  for (const double value : {0.0, Limits::min(), Limits::max(), Limits::denorm_min(), Limits::epsilon(), 1.0, 0.1, 1e22,
                             1e23, 4.9406564584124654e-324, 2.2250738585072011e-308, 9007199254740993.0, HUGE_VAL}) {
    expect_round_trip(value);
    expect_round_trip(-value);
  }
  for (std::uint64_t bits = 1; bits < 2000; ++bits) expect_round_trip(value_of(bits));
}

TEST(NumberText, IsShortest) {
  EXPECT_EQ(to_text(0.1), "0.1");
  EXPECT_EQ(to_text(-2.5), "-2.5");
  EXPECT_EQ(to_text(3), "3");
  EXPECT_EQ(to_text(0), "0");
  EXPECT_EQ(to_text(1.0 / 3), "0.3333333333333333");
  EXPECT_EQ(to_text(100000), "100000");
  EXPECT_EQ(to_text(-2000000), "-2000000");
  EXPECT_EQ(to_text(-0.0), "-0");
  EXPECT_EQ(to_text(1e7), "1e+07");
  EXPECT_EQ(to_text(1e-5), "1e-05");
  EXPECT_EQ(to_text(std::nan("")), "nan");
  EXPECT_EQ(to_text(HUGE_VAL), "inf");
  EXPECT_EQ(to_text(-HUGE_VAL), "-inf");
}

TEST(ParseDouble, WholeNumbersAndSigns) {
  EXPECT_EQ(parse_double("+1"), 1.0);
  EXPECT_EQ(parse_double("-1.5e3"), -1500.0);
  EXPECT_EQ(parse_double("1E-2"), 0.01);
  EXPECT_EQ(parse_double(".5"), 0.5);
  EXPECT_EQ(parse_double("5."), 5.0);
  EXPECT_EQ(parse_double("007"), 7.0);
  EXPECT_TRUE(std::signbit(*parse_double("-0")));
  EXPECT_TRUE(std::isnan(*parse_double("nan")));
  EXPECT_EQ(parse_double("inf"), HUGE_VAL);
  EXPECT_EQ(parse_double("-inf"), -HUGE_VAL);
  EXPECT_EQ(parse_double("+inf"), HUGE_VAL);
}

TEST(ParseDouble, AnythingElseIsAbsent) {
  for (const char* text : {"",    " ",  " 1", "1 ",  "1x", "x",    "1,5", "1.2.3", "+",   "-",     "++1", "+-1", "-+1",
                           "--1", "e5", "1e", "1e+", ".",  "0x10", "1\n", "\t1",   "1d0", "1_000", "na",  "infi"})
    EXPECT_FALSE(parse_double(text).has_value()) << "'" << text << "'";
  EXPECT_FALSE(parse_double(std::string_view("1\0", 2)).has_value());
  EXPECT_FALSE(parse_double(std::string_view("\0", 1)).has_value());
}

TEST(ParseDouble, ExponentsThatDoNotFitAreAbsent) {
  for (const char* text : {"1e309", "-1e309", "1e99999", "1e999999999999999999999", "2e308"})
    EXPECT_FALSE(parse_double(text).has_value()) << text;
  EXPECT_EQ(parse_double("1.7976931348623157e308"), Limits::max());
  EXPECT_EQ(parse_double("5e-324"), Limits::denorm_min());
  EXPECT_EQ(parse_double("0e999999"), 0.0);
}

TEST(ParseDouble, MagnitudesBelowTheSmallestAreZero) {
  for (const std::string& text : {std::string("1e-400"), "0." + std::string(400, '0') + "1"})
    for (const char* sign : {"", "+", "-"}) {
      const auto value = parse_double(sign + text);
      ASSERT_TRUE(value.has_value()) << sign + text;
      EXPECT_EQ(*value, 0);
    }
}

TEST(ParseDouble, LooksOnlyAtItsView) {
  const std::string line = "12.5 7";
  EXPECT_EQ(parse_double(std::string_view(line).substr(0, 4)), 12.5);
  EXPECT_EQ(parse_double(std::string_view(line).substr(0, 2)), 12.0);
}

TEST(ParseDouble, LocaleDoesNotMatter) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE"})
    if (std::setlocale(LC_ALL, name) != nullptr) break;
  EXPECT_EQ(parse_double("1.5"), 1.5);
  EXPECT_FALSE(parse_double("1,5").has_value());
  EXPECT_EQ(to_text(1.5), "1.5");
  std::setlocale(LC_ALL, before.c_str());
}

TEST(ParseInt, WholeRange) {
  EXPECT_EQ(parse_int("0"), 0);
  EXPECT_EQ(parse_int("+42"), 42);
  EXPECT_EQ(parse_int("-42"), -42);
  EXPECT_EQ(parse_int("9223372036854775807"), std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(parse_int("-9223372036854775808"), std::numeric_limits<std::int64_t>::min());
  for (const char* text : {"9223372036854775808", "-9223372036854775809", "", "+", "-", "+-1", "++1", " 1", "1 ", "1.0",
                           "1e3", "0x1", "nan"})
    EXPECT_FALSE(parse_int(text).has_value()) << text;
}

TEST(ParseUnsigned, WholeRange) {
  EXPECT_EQ(parse_unsigned("0"), 0u);
  EXPECT_EQ(parse_unsigned("+42"), 42u);
  EXPECT_EQ(parse_unsigned("18446744073709551615"), std::numeric_limits<std::uint64_t>::max());
  for (const char* text : {"18446744073709551616", "-1", "-0", "", "+", "+-1", " 1", "1 ", "1.0", "1x"})
    EXPECT_FALSE(parse_unsigned(text).has_value()) << text;
}

}  // namespace
}  // namespace corral
