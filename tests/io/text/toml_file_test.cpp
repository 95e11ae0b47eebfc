// SPDX-License-Identifier: MIT
#include "io/text/toml_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kernel/error.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

template <class Call>
std::string complaint_of(Call call) {
  try {
    call();
  } catch (const IoError& error) {
    return error.what();
  }
  return "";
}

TEST(TomlFile, ReadsEveryKindOfValue) {
  const TomlTable table = TomlTable::parse("x.toml", R"(
name = "b3r"
size = 3
share = 0.5
on = true
words = ["a", "b"]
levels = [1, 0.5]
bins = [[65, 70], [70, 75.5]]
[inner]
key = "value"
[[item]]
n = 1
[[item]]
n = 2
)");
  EXPECT_EQ(table.text("name"), "b3r");
  EXPECT_EQ(table.integer("size"), 3);
  EXPECT_EQ(table.number("size"), 3.0);
  EXPECT_EQ(table.number("share"), 0.5);
  EXPECT_EQ(table.flag("on"), true);
  EXPECT_THAT(table.texts("words"), ElementsAre("a", "b"));
  EXPECT_THAT(table.numbers("levels"), ElementsAre(1, 0.5));
  EXPECT_THAT(table.number_lists("bins"), ElementsAre(ElementsAre(65, 70), ElementsAre(70, 75.5)));
  EXPECT_EQ(table.table("inner")->text("key"), "value");
  ASSERT_EQ(table.tables("item").size(), 2u);
  EXPECT_EQ(table.tables("item")[1].integer("n"), 2);
  EXPECT_EQ(table.scalar_text("size"), "3");
  EXPECT_EQ(table.scalar_text("share"), "0.5");
  EXPECT_EQ(table.scalar_text("on"), "true");
  EXPECT_EQ(table.scalar_text("name"), "b3r");
}

TEST(TomlFile, WhatIsNotThereIsAbsent) {
  const TomlTable table = TomlTable::parse("x.toml", "");
  EXPECT_FALSE(table.text("name") || table.number("name") || table.integer("name") || table.flag("name") ||
               table.table("name") || table.scalar_text("name"));
  EXPECT_THAT(table.texts("name"), IsEmpty());
  EXPECT_THAT(table.numbers("name"), IsEmpty());
  EXPECT_THAT(table.tables("name"), IsEmpty());
}

TEST(TomlFile, NamesTheLineOfWhatIsWrong) {
  const TomlTable table = TomlTable::parse("x.toml", "a = 1\nb = \"text\"\nc = [1, \"two\"]\nd = inf\n");
  EXPECT_THAT(complaint_of([&] { table.text("a"); }), AllOf(HasSubstr("x.toml"), HasSubstr("line 1")));
  EXPECT_THAT(complaint_of([&] { table.number("b"); }), HasSubstr("line 2"));
  EXPECT_THAT(complaint_of([&] { table.numbers("c"); }), HasSubstr("line 3"));
  EXPECT_THAT(complaint_of([&] { table.number("d"); }), HasSubstr("finite"));
  EXPECT_THAT(complaint_of([&] { table.integer("b"); }), HasSubstr("whole number"));
  EXPECT_THAT(complaint_of([&] { table.flag("b"); }), HasSubstr("true or false"));
  EXPECT_THAT(complaint_of([&] { table.table("b"); }), HasSubstr("[b]"));
  EXPECT_THAT(complaint_of([] { TomlTable::parse("x.toml", "a = 1\nb = \n"); }),
              AllOf(HasSubstr("x.toml"), HasSubstr("line 2")));
}

TEST(TomlFile, AnUnknownKeyIsAnErrorWithASuggestion) {
  const TomlTable table = TomlTable::parse("x.toml", "name = 1\ntreshold_pr = 2\n");
  EXPECT_THAT(complaint_of([&] {
                table.only({"name", "threshold_pr"});
              }),
              AllOf(HasSubstr("line 2"), HasSubstr("treshold_pr"), HasSubstr("did you mean 'threshold_pr'")));
  EXPECT_EQ(complaint_of([&] { table.only({"name", "treshold_pr"}); }), "");
}

TEST(TomlFile, TextSurvivesAnyByteOfUtf8) {
  const std::string text = "a \"quote\", a \\ and a line\nbreak, \t \x7f, \xc3\xa9";
  EXPECT_EQ(TomlTable::parse("x.toml", "key = " + toml_text(text) + "\n").text("key"), text);
}

TEST(NearestName, IsNearOrAbsent) {
  EXPECT_EQ(nearest_name("ransacc", {"ss", "ransac", "gc"}), "ransac");
  EXPECT_EQ(nearest_name("tolerence_pr", {"bins", "tolerance_pr"}), "tolerance_pr");
  EXPECT_EQ(nearest_name("completely", {"ss", "gc"}), "");
}

}  // namespace
}  // namespace corral
