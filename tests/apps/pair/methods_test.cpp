// SPDX-License-Identifier: MIT
#include "apps/pair/methods.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/disk/file.h"
#include "kernel/error.h"
#include "tests/support/program.h"

namespace corral {
namespace {

using ::testing::HasSubstr;
using testing::Workplace;

const std::string kOdd = CORRAL_ODD_PLUGIN, kOld = CORRAL_OLD_PLUGIN, kTaken = CORRAL_TAKEN_PLUGIN,
                  kLengths = CORRAL_LENGTHS_PLUGIN;

TEST(Methods, AreTheGroupersThenWhatIsMadeOfThem) {
  ASSERT_GE(methods().size(), groupers().size() + 2);
  for (std::size_t i = 0; i < groupers().size(); ++i) EXPECT_EQ(methods()[i].name, groupers()[i].name);
  EXPECT_EQ(methods()[groupers().size()].name, "auto");
  EXPECT_EQ(find_method("register").name, "register");
  EXPECT_THROW(find_method("none"), InvalidInput);
}

TEST(Plugins, AnswerLikeAnyOtherMethod) {
  const Workplace place;
  place.put_problem();
  const auto outcome = place.corral("run --matches matches.csv --truth truth.txt --methods gc --plugin " + kLengths +
                                    " --set lengths.tolerance_pr=1.5 --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto found = outcome.json()["methods"][1];
  EXPECT_EQ(found["method"], "lengths");
  EXPECT_GT(found["precision"].get<double>(), 0.95);
  EXPECT_GT(found["recall"].get<double>(), 0.95);
  EXPECT_EQ(outcome.json()["details"]["options"]["lengths"]["tolerance_pr"], 1.5);
  EXPECT_EQ(place.corral("conformance --plugin " + kLengths).status, 0);
}

TEST(Plugins, TakePartInStudiesAndTheirFileCounts) {
  const Workplace place;
  place.put_problem();
  make_folder(place / "set");
  place.put("set/dataset.toml", "name = \"set\"\n");
  place.put("set/pairs.csv", "pair,source,target,truth,matches\none,,,../truth.txt,../matches.csv\n");
  place.put("mine.toml",
            "name = \"mine\"\ndataset = \"set\"\nattribute = \"threshold_pr\"\nlevels = [4]\ngroupers = [\"gc\"]\n");
  const auto outcome = place.corral("evaluate mine.toml --data set -o study --plugin " + kOdd);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(place.text("study/records.csv"), HasSubstr(",odd,"));
  for (const char* command : {"merge study", "verify study --all"}) {
    const auto refused = place.corral(command);
    EXPECT_EQ(refused.status, 3) << command << ": a library that a study names is not loaded for that";
    EXPECT_THAT(refused.err, HasSubstr("give it by --plugin, if you trust it"));
    EXPECT_EQ(place.corral(command + (" --plugin " + kOdd)).status, 0) << command;
  }
}

TEST(Plugins, WhatTheyDoWrongIsTheirFailureAlone) {
  const Workplace place;
  place.put_problem();
  const auto status = [&](const std::string& what) {
    const auto outcome =
        place.corral("run --matches matches.csv --methods gc --plugin " + kOdd + " --set odd.do=" + what + " --json");
    EXPECT_EQ(outcome.json()["methods"][0]["status"], "refined");
    return outcome.json()["methods"][1]["status"].get<std::string>();
  };
  EXPECT_THAT(status("refuse"), HasSubstr("not today"));
  EXPECT_THAT(status("nan"), HasSubstr("row 0 is not finite"));
  EXPECT_THAT(status("shear"), HasSubstr("no rigid transform"));
  EXPECT_THAT(status("first"), HasSubstr("too few rows"));
}

TEST(Plugins, OfAnotherVersionAreRefusedWithBothNumbers) {
  const Workplace place;
  place.put_problem();
  const auto error = [&](const std::string& file) {
    const auto outcome = place.corral("group matches.csv --plugin " + file + " -o group.csv");
    EXPECT_EQ(outcome.status, 3) << file;
    return outcome.err;
  };
  EXPECT_THAT(error(kOld), HasSubstr("is a plug-in of version 99, expected version 1"));
  EXPECT_THAT(error(kTaken), HasSubstr("is named 'gc'"));
  EXPECT_THAT(error("none.so"), HasSubstr("none.so: is not a file"));
  EXPECT_THAT(error("matches.csv"), HasSubstr("cannot be loaded"));
  EXPECT_EQ(place.corral("group matches.csv --plugin " + kOdd + " --set odd.other=1").status, 2);
}

}  // namespace
}  // namespace corral
