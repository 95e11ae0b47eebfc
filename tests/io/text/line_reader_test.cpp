// SPDX-License-Identifier: MIT
#include "io/text/line_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/io/scratch.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::io_error_of;
using ::testing::IsEmpty;

const std::string kPath = "some.txt";

/// Every line with its number, "number:line".
std::vector<std::string> lines_of(const std::string& text, char comment = '\0') {
  LineReader reader(kPath, text, comment);
  std::vector<std::string> lines;
  while (reader.next()) lines.push_back(std::to_string(reader.line_number()) + ":" + std::string(reader.line()));
  return lines;
}

std::string number_error(const std::string& text) {
  LineReader reader(kPath, "\nx\n");
  reader.next();
  return io_error_of([&] { reader.finite_number(text); });
}

std::string integer_error(const std::string& text, std::int64_t low, std::int64_t high) {
  LineReader reader(kPath, "x\n");
  reader.next();
  return io_error_of([&] { reader.integer(text, low, high, "a corner"); });
}

TEST(LineReader, SkipsBlankLinesAndCountsThem) {
  EXPECT_THAT(lines_of(""), IsEmpty());
  EXPECT_THAT(lines_of("\n \t\n\r\n"), IsEmpty());
  EXPECT_THAT(lines_of("a\n\n  b  c \r\n\nd\n"), ElementsAre("1:a", "3:b  c", "5:d"));
}

TEST(LineReader, SkipsCommentsOnlyIfAsked) {
  EXPECT_THAT(lines_of("# x\na\n  # y\nb # z\n", '#'), ElementsAre("2:a", "4:b # z"));
  EXPECT_THAT(lines_of("# x\na\n"), ElementsAre("1:# x", "2:a"));
}

TEST(LineReader, ALineWithoutItsEndIsCutShort) {
  EXPECT_THAT(io_error_of([] { lines_of("a\nb"); }), HasSubstr("some.txt, line 2: the file ends within this line"));
  EXPECT_THAT(io_error_of([] { lines_of("a\n# b", '#'); }), HasSubstr("line 2"));
  EXPECT_THAT(lines_of("a\n   "), ElementsAre("1:a")) << "white space alone is no line";
}

TEST(LineReader, ALineEndsAtLfCrLfOrCr) {
  EXPECT_THAT(lines_of("a\r\rb\rc\r"), ElementsAre("1:a", "3:b", "4:c"));
  EXPECT_THAT(lines_of("a\n\nb\rc\r\nd\n"), ElementsAre("1:a", "3:b", "4:c", "5:d"));
  EXPECT_THAT(lines_of("a\r\nb\rc\r\n\r\nd\r\n"), ElementsAre("1:a", "2:b", "3:c", "5:d"));
  EXPECT_THAT(io_error_of([] { lines_of("a\rb"); }), HasSubstr("some.txt, line 2: the file ends within this line"));
  LineReader reader(kPath, "a\rb\r\n\1");
  for (int line = 0; line < 2; ++line) ASSERT_TRUE(reader.next());
  EXPECT_EQ(reader.rest(), "\n\1") << "where lines end in CR, LF is data";
}

TEST(LineReader, TheLastLineMayLackItsEndIfAllowed) {
  LineReader reader(kPath, "a\nb");
  reader.allow_open_end();
  ASSERT_TRUE(reader.next());
  EXPECT_FALSE(reader.lacks_end());
  ASSERT_TRUE(reader.next());
  EXPECT_EQ(reader.line(), "b");
  EXPECT_TRUE(reader.lacks_end());
  EXPECT_FALSE(reader.next());
}

TEST(LineReader, CommentsBehindAndContinuationsIfAllowed) {
  LineReader reader(kPath, "a # x \\\nb \\\n  c\\ # y\n d # z\n# all \\\ne\\\n", '#');
  reader.allow_comments_behind();
  reader.allow_continuations();
  std::vector<std::string> lines;
  while (reader.next()) {
    lines.emplace_back();
    for (std::string_view field = reader.take(); !field.empty(); field = reader.take()) lines.back() += field;
    lines.back() += std::to_string(reader.line_number());
  }
  EXPECT_THAT(lines, ElementsAre("a1", "bcd4", "e\\6"));
}

TEST(LineReader, TakesOneFieldAfterTheOther) {
  LineReader reader(kPath, " a\t bc  \nd\n");
  reader.next();
  EXPECT_EQ(reader.take(), "a");
  EXPECT_EQ(reader.untaken(), "\t bc");
  EXPECT_EQ(reader.take(), "bc");
  EXPECT_EQ(reader.take(), "");
  reader.next();
  EXPECT_EQ(reader.take(), "d");
}

TEST(LineReader, CoordinatesMayBeMissingButNotInfinite) {
  LineReader reader(kPath, "x\n");
  reader.next();
  EXPECT_TRUE(std::isnan(reader.coordinate("nan")));
  EXPECT_THAT(io_error_of([&] { reader.coordinate("-inf"); }), HasSubstr("found '-inf', expected a finite number"));
}

TEST(LineReader, NeedSaysWhatWasToFollow) {
  LineReader reader(kPath, "a\n");
  reader.need("an a");
  EXPECT_EQ(io_error_of([&] { reader.need("vertex 1 of 4"); }),
            "some.txt, line 2: the file ends here, expected vertex 1 of 4");
}

TEST(LineReader, SplitsAtWhiteSpaceOrAtEachSeparator) {
  LineReader reader(kPath, " a\t b  ,c ,, d,\n");
  reader.next();
  EXPECT_THAT(reader.fields(), ElementsAre("a", "b", ",c", ",,", "d,"));
  EXPECT_THAT(reader.fields(','), ElementsAre("a\t b", "c", "", "d", ""));
}

TEST(LineReader, RestIsWhatFollowsTheLine) {
  const std::string text("a\r\n\0\x01\n", 6);
  LineReader reader(kPath, text);
  reader.next();
  EXPECT_EQ(reader.rest(), std::string("\0\x01\n", 3));
}

TEST(LineReader, NumbersAreWholeFieldsAndFinite) {
  LineReader reader(kPath, "x\n");
  reader.next();
  EXPECT_EQ(reader.finite_number("-1.5e2"), -150);
  EXPECT_EQ(reader.finite_number("+2"), 2);
  EXPECT_EQ(reader.finite_number("5e-324"), 5e-324);
  for (const char* bad : {"", "1.5x", "1,5", "0x10", "--1", "1 2", "e5", "1e999", "-1e999"})
    EXPECT_THAT(number_error(bad), HasSubstr("some.txt, line 2: found '" + std::string(bad) + "', expected a number"));
  for (const char* bad : {"nan", "NaN", "-nan", "inf", "-inf", "Infinity"})
    EXPECT_THAT(number_error(bad), HasSubstr("found '" + std::string(bad) + "', expected a finite number"));
}

TEST(LineReader, IntegersAreWholeAndInRange) {
  LineReader reader(kPath, "x\n");
  reader.next();
  EXPECT_EQ(reader.integer("-3", -3, 3, "a corner"), -3);
  EXPECT_EQ(reader.integer("+3", -3, 3, "a corner"), 3);
  for (const char* bad : {"", "4", "-4", "1.0", "1e0", "99999999999999999999", "0x1", "nan"})
    EXPECT_EQ(integer_error(bad, -3, 3),
              "some.txt, line 1: a corner is '" + std::string(bad) + "', expected a whole number in -3 .. 3");
}

TEST(LineReader, TextInUtf16IsNamed) {
  for (const char* text : {"\xFF\xFE"
                           "1",
                           "\xFE\xFF"})
    EXPECT_THAT(testing::complaint(kPath, [&] { LineReader(kPath, text); }),
                HasSubstr("found text in UTF-16, expected ASCII or UTF-8"))
        << text;
  EXPECT_FALSE(is_utf16("\xFE"));
}

TEST(LineReader, QuotesAreShortAndPrintable) {
  EXPECT_EQ(corral::quoted(""), "''");
  EXPECT_EQ(corral::quoted(std::string("a\x1b[2J\0\xff", 7)),
            "'a?[2J?"
            "?'");
  EXPECT_EQ(corral::quoted(std::string(40, 'x')), "'" + std::string(40, 'x') + "'");
  EXPECT_EQ(corral::quoted(std::string(41, 'x')), "'" + std::string(40, 'x') + "...'");
}

}  // namespace
}  // namespace corral
