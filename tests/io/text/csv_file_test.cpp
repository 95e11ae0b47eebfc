// SPDX-License-Identifier: MIT
#include "io/text/csv_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kernel/error.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string complaint_of(const std::string& text) {
  try {
    parse_csv("x.csv", text);
  } catch (const IoError& error) {
    return error.what();
  }
  return "";
}

TEST(CsvFile, ReadsBackWhatItWrote) {
  const CsvTable table{{"a", "b c", "d"},
                       {{"1", "", "x,y"}, {"", "", ""}, {"say \"so\"", " spaced ", "#no comment"}, {"#", "\"", ","}}};
  const CsvTable read = parse_csv("x.csv", csv_text(table));
  EXPECT_EQ(read.header, table.header);
  EXPECT_EQ(read.rows, table.rows);
  const CsvTable narrow{{"a"}, {{""}, {"1"}}};
  EXPECT_EQ(parse_csv("x.csv", csv_text(narrow)).rows, narrow.rows) << "an empty cell is a row too";
}

TEST(CsvFile, FindsColumnsAndPassesComments) {
  const CsvTable table = parse_csv("x.csv", "# words\na,b\n1,2\n# more\n3,4\n");
  EXPECT_EQ(table.column("b"), 1);
  EXPECT_EQ(table.column("c"), -1);
  EXPECT_THAT(table.rows, ElementsAre(ElementsAre("1", "2"), ElementsAre("3", "4")));
}

TEST(CsvFile, NamesTheLineOfWhatIsWrong) {
  EXPECT_THAT(complaint_of(""), HasSubstr("empty"));
  EXPECT_THAT(complaint_of("a,a\n"), HasSubstr("twice"));
  EXPECT_THAT(complaint_of("a,,b\n"), HasSubstr("without a name"));
  EXPECT_THAT(complaint_of("a,b\n1,2\n1\n"), AllOf(HasSubstr("x.csv"), HasSubstr("line 3"), HasSubstr("1 cells")));
  EXPECT_THAT(complaint_of("a\n\"open\n"), HasSubstr("a quote without an end"));
  EXPECT_THAT(complaint_of("a\n\"shut\"more\n"), HasSubstr("closing quote"));
  EXPECT_THAT(complaint_of("a\nhalf\"quote\"\n"), HasSubstr("inside a cell"));
  EXPECT_THAT(complaint_of("a,b\n1,2"), HasSubstr("line 2")) << "a last line that the end of the file cuts off";
}

TEST(CsvFile, RefusesALineBreak) { EXPECT_THROW(csv_line({"a\nb"}), InvalidInput); }

}  // namespace
}  // namespace corral
