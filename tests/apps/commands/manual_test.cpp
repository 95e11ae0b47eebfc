// SPDX-License-Identifier: MIT
#include "apps/commands/manual.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/program.h"

namespace corral {
namespace {

using ::testing::HasSubstr;
using testing::Workplace;

/// What a shell prints.
std::string printed(const Workplace& place, const std::string& command) {
  const std::string file = place / "printed";
  if (std::system(("cd '" + (place / ".") + "' && " + command + " > '" + file + "' 2>&1").c_str()) != 0)
    return "failed: " + place.text("printed");
  return place.text("printed");
}

TEST(Manual, HasAPageForEveryCommand) {
  const Workplace place;
  ASSERT_EQ(place.corral("manual -o share").status, 0);
  const std::string help = place.corral("--help").out;
  int pages = 0;
  for (const auto& entry : std::filesystem::directory_iterator(place / "share/man/man1")) {
    ++pages;
    EXPECT_EQ(entry.path().extension(), ".1");
  }
  EXPECT_GE(pages, 28);
  const std::string page = place.text("share/man/man1/corral-run.1");
  EXPECT_THAT(page, HasSubstr(".TH \"CORRAL-RUN\" 1"));
  EXPECT_THAT(page, HasSubstr(".SH EXAMPLES"));
  EXPECT_THAT(page, HasSubstr("\\-\\-methods"));
  EXPECT_THAT(place.text("share/man/man1/corral-dataset-make.1"), HasSubstr("corral dataset make"));
  EXPECT_THAT(place.text("share/man/man1/corral.1"), HasSubstr("corral\\-register"));
}

TEST(Manual, PagesAreRoffWithoutComplaint) {
  if (std::system("command -v groff > /dev/null") != 0) GTEST_SKIP() << "groff is not installed";
  const Workplace place;
  ASSERT_EQ(place.corral("manual -o share").status, 0);
  EXPECT_EQ(printed(place, "for page in share/man/man1/*.1; do groff -ww -man -Tutf8 $page 2>&1 > /dev/null; done"),
            "");
  EXPECT_THAT(printed(place, "groff -man -Tascii -P-c share/man/man1/corral-group.1"), HasSubstr("--method"));
}

TEST(Manual, BashCompletesCommandsOptionsAndChoices) {
  const Workplace place;
  ASSERT_EQ(place.corral("manual -o share").status, 0);
  const auto completed = [&](const std::string& words, int count) {
    return printed(place, "bash -c '. share/bash-completion/completions/corral; COMP_WORDS=(" + words +
                              "); COMP_CWORD=" + std::to_string(count) + "; _corral; echo ${COMPREPLY[@]}'");
  };
  EXPECT_EQ(completed("corral reg", 1), "register\n");
  EXPECT_EQ(completed("corral dataset ma", 2), "make\n");
  EXPECT_EQ(completed("corral run --exp", 2), "--explain\n");
  EXPECT_THAT(completed("corral run --select \"\"", 3), HasSubstr("surface"));
}

TEST(Manual, OtherShellsParseTheirs) {
  const Workplace place;
  ASSERT_EQ(place.corral("manual -o share").status, 0);
  if (std::system("command -v zsh > /dev/null") == 0) {
    EXPECT_EQ(printed(place, "zsh -n share/zsh/vendor-completions/_corral"), "");
  }
  if (std::system("command -v fish > /dev/null") == 0) {
    EXPECT_EQ(printed(place, "fish -n share/fish/vendor_completions.d/corral.fish"), "");
  }
  EXPECT_THAT(place.text("share/zsh/vendor-completions/_corral"), HasSubstr("#compdef corral"));
  EXPECT_THAT(place.text("share/fish/vendor_completions.d/corral.fish"), HasSubstr("-l methods"));
}

TEST(Manual, NeedsAFolder) {
  const Workplace place;
  EXPECT_EQ(place.corral("manual").status, 2);
}

}  // namespace
}  // namespace corral
