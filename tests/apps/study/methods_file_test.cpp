// SPDX-License-Identifier: MIT
#include "apps/study/methods_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kernel/error.h"

namespace corral {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string refusal(const std::string& text) {
  try {
    parse_methods("methods.toml", text);
  } catch (const IoError& error) {
    return error.what();
  }
  return "accepted";
}

Dataset dataset() {
  Dataset set;
  set.folder = "data/3dmatch", set.name = "3dmatch", set.attributes = {"scene", "source_fragment"};
  set.pairs = {{"kitchen-4+0", "", "", "t.txt", {"kitchen", "4"}, "m.csv"}};
  return set;
}

TEST(MethodsFile, NamesFilesBesideItself) {
  const auto methods = parse_methods("others/methods.toml", R"toml(
[[method]]
name = "MAC++"
title = "MAC++ (as released)"
labels = "mac/{pair}.txt"
time_ms = 40

[[method]]
name = "learned"
poses = "learned/{scene}.log:{source_fragment},0"
times = "learned/{dataset}.csv"
)toml");
  ASSERT_EQ(methods.size(), 2u);
  EXPECT_EQ(methods[0].title, "MAC++ (as released)");
  EXPECT_EQ(methods[1].title, "learned");
  const Dataset set = dataset();
  const ForeignAnswer mac = answer_to(methods[0], set, set.pairs[0]);
  EXPECT_EQ(mac.labels, "others/mac/kitchen-4+0.txt");
  EXPECT_EQ(mac.pose, "");
  EXPECT_EQ(mac.time_ms, 40);
  const ForeignAnswer learned = answer_to(methods[1], set, set.pairs[0]);
  EXPECT_EQ(learned.pose, "others/learned/kitchen.log:4,0");
  EXPECT_EQ(learned.times, "others/learned/3dmatch.csv");
}

TEST(MethodsFile, AnUnknownColumnIsNamed) {
  const auto methods = parse_methods("methods.toml", "[[method]]\nname = \"a\"\nlabels = \"{sceen}/{pair}.txt\"\n");
  const Dataset set = dataset();
  try {
    answer_to(methods[0], set, set.pairs[0]);
    FAIL();
  } catch (const IoError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("{sceen}"), HasSubstr("data/3dmatch/pairs.csv")));
  }
}

TEST(MethodsFile, EveryErrorIsNamedWithItsLine) {
  EXPECT_THAT(refusal(""), HasSubstr("no methods, expected [[method]]"));
  EXPECT_THAT(refusal("[[method]]\nlabels = \"a\"\n"), HasSubstr("expected name ="));
  EXPECT_THAT(refusal("[[method]]\nname = \"a b\"\nlabels = \"a\"\n"),
              AllOf(HasSubstr("line 2"), HasSubstr("letters")));
  for (const char* taken : {"gc", "oracle", "baseline"})
    EXPECT_THAT(refusal("[[method]]\nname = \"" + std::string(taken) + "\"\nlabels = \"a\"\n"),
                HasSubstr("none that is in every study"));
  EXPECT_THAT(refusal("[[method]]\nname = \"a\"\n"), HasSubstr("expected labels"));
  EXPECT_THAT(refusal("[[method]]\nname = \"a\"\nlabel = \"a\"\n"), HasSubstr("did you mean"));
  EXPECT_THAT(refusal("[[method]]\nname = \"a\"\nlabels = \"a\"\ntime_ms = -1\n"), HasSubstr("at least zero"));
  EXPECT_THAT(refusal("[[method]]\nname = \"a\"\nlabels = \"a\"\ntime_ms = 1\ntimes = \"t.csv\"\n"),
              HasSubstr("not both"));
  EXPECT_THAT(refusal("[[method]]\nname = \"a\"\nlabels = \"a\"\n[[method]]\nname = \"a\"\nlabels = \"b\"\n"),
              HasSubstr("a occurs twice"));
}

}  // namespace
}  // namespace corral
