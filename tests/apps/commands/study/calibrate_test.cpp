// SPDX-License-Identifier: MIT
// corral calibrate and what register says with it, as a user types them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/program.h"

namespace corral {
namespace {

using ::testing::HasSubstr;
using testing::Workplace;

/// Tables of eight objects: in every second there is no correct match.
void put_tables(const Workplace& place, int count) {
  std::filesystem::create_directories(place / "tables");
  place.put("tables/dataset.toml", "name = \"tables\"\n");
  std::string pairs = "pair,source,target,truth,matches,object\n";
  for (int number = 0; number < count; ++number) {
    SyntheticOptions options;
    options.matches = 60;
    options.inlier_ratio = number % 2 == 0 ? 0.4 : 0;
    options.seed = static_cast<std::uint64_t>(number + 1);
    const SyntheticProblem made = make_synthetic_problem(options);
    const std::string name = "p" + std::to_string(number);
    place.put("tables/" + name + ".csv", matches_text(made.matches));
    place.put("tables/" + name + ".txt", transform_text(made.truth));
    pairs += name + ",,," + name + ".txt," + name + ".csv,object" + std::to_string(number / 2 % 8) + "\n";
  }
  place.put("tables/pairs.csv", pairs);
}

TEST(Calibrate, LearnsFromTablesWhichPosesToTrust) {
  const Workplace place;
  put_tables(place, 32);
  const auto outcome = place.corral("calibrate tables --test tables -o confidence.toml --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = outcome.json();
  EXPECT_EQ(json[0]["set"], "held out");
  EXPECT_EQ(json[0]["pairs"], 32);
  EXPECT_EQ(json[0]["right"], 16);
  EXPECT_GT(json[0]["area"], 0.95);
  EXPECT_EQ(json[1]["set"], "tables");
  const std::string call = "register --confidence confidence.toml --matches tables/";
  EXPECT_THAT(place.corral(call + "p0.csv").out, HasSubstr("trust it: it is right"));
  EXPECT_THAT(place.corral(call + "p1.csv").out, HasSubstr("do not use it: it is right"));
  const auto in_json = place.corral(call + "p1.csv --json").json()["confidence"];
  EXPECT_LT(in_json["probability"], 0.5);
  EXPECT_EQ(in_json["verdict"], "do not use it");
  const std::string first = place.text("confidence.toml");
  ASSERT_EQ(place.corral("calibrate tables -o again.toml --threads 1").status, 0);
  EXPECT_EQ(place.text("again.toml"), first) << "whatever the threads";
}

TEST(Calibrate, OfAStudyTakesItsPairsAsItMatchedThem) {
  const Workplace place;
  put_tables(place, 32);
  place.put("e.toml", "name = \"e\"\ndataset = \"tables\"\nattribute = \"threshold_pr\"\nlevels = [4, 5]\n");
  const auto made = place.corral("evaluate e.toml --data tables -o study");
  ASSERT_EQ(made.status, 0) << made.err;
  const auto of_set = place.corral("calibrate tables -o of-set.toml --json"),
             of_study = place.corral("calibrate study -o of-study.toml --json");
  ASSERT_EQ(of_study.status, 0) << of_study.err;
  EXPECT_EQ(of_study.json(), of_set.json());
  EXPECT_EQ(place.text("of-study.toml"), place.text("of-set.toml"));
}

TEST(Calibrate, SaysWhatIsMissing) {
  const Workplace place;
  put_tables(place, 4);
  const auto few = place.corral("calibrate tables -o confidence.toml");
  EXPECT_EQ(few.status, 3);
  EXPECT_THAT(few.err, HasSubstr("ten of each at least"));
  EXPECT_FALSE(std::filesystem::exists(place / "confidence.toml"));
  EXPECT_EQ(place.corral("calibrate none").status, 3);
  place.put("bad.toml", "[table]\n");
  EXPECT_EQ(place.corral("register --matches tables/p0.csv --confidence bad.toml").status, 3);
}

}  // namespace
}  // namespace corral
