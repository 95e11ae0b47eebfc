// SPDX-License-Identifier: MIT
// corral reproduce on a few pairs, as a user calls it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/small_study.h"

namespace corral {
namespace {

using namespace testing;
using ::testing::HasSubstr;

constexpr char kReadings[] = R"toml(
[[point]]
name = "gc"
question = "Which cluster?"
[[point.reading]]
name = "star"
text = "Seed"
from = "text"
evidence = "-"
[[point.reading]]
name = "clique"
text = "All"
from = "library"
evidence = "-"
options.gc.cluster = "clique"
[[point]]
name = "radius"
question = "Which keypoints?"
[[point.reading]]
name = "three"
text = "3 pr"
from = "text"
evidence = "-"
[[point.reading]]
name = "two"
text = "2 pr"
from = "neither"
evidence = "-"
options.harris.radius_pr = 2
)toml";

constexpr char kClaims[] = R"toml(
methods = ["gc", "nnsr", "ransac"]
tau = 0.01
time_tau = 0.05
least_pairs = 1
slips = []
[[claim]]
id = "A"
text = "GC keeps what RANSAC keeps"
parts = [{ experiment = "noise", of = "recall", take = "mean", is = ["gc >= ransac - 0.05"] }]
[[claim]]
id = "B"
text = "No selection is precise"
parts = [{ experiment = "noise", of = "precision", take = "mean", is = ["max < 0"] }]
[[claim]]
id = "T"
text = "Time"
parts = [{ experiment = "time", of = "time", is = ["gc < ransac"] }]
)toml";

class Reproduce : public ::testing::Test {
 protected:
  Reproduce() {
    put_small_dataset(place_);
    place_.put("readings.toml", kReadings);
    place_.put("claims.toml", kClaims);
  }
  Outcome reproduce(const std::string& rest) const {
    return place_.corral("reproduce noise --data data --readings readings.toml --claims claims.toml " + rest);
  }
  std::string answer(const std::string& folder) const {
    std::string all;
    for (const char* file : {"matrix.csv", "reproduction.json", "reproduction.txt", "as-run.toml"})
      all += place_.text(folder + "/" + file);
    return all;
  }
  const Workplace place_;
};

TEST_F(Reproduce, SaysWhatEachReadingDoes) {
  const Outcome outcome = reproduce("-o run --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  ASSERT_EQ(json["statements"].size(), 3u);
  EXPECT_EQ(json["statements"][1]["class"], "never");
  EXPECT_EQ(json["statements"][2]["class"], "undecided");
  EXPECT_EQ(json["statements"][0]["readings"].size(), 3u);  // text, clique, two
  EXPECT_NE(json["statements"][0]["readings"]["text"]["margin"],
            json["statements"][0]["readings"]["gc=clique"]["margin"]);
  EXPECT_NE(json["statements"][0]["readings"]["text"]["margin"],
            json["statements"][0]["readings"]["radius=two"]["margin"]);
  for (const char* pairs : {"chosen", "held_out", "all"})
    EXPECT_GE(json["most_of_any"][pairs], std::max(json["text"][pairs], json["found"][pairs])) << pairs;
  EXPECT_THAT(place_.text("run/reproduction.txt"), HasSubstr("\nmost of any "));
  EXPECT_THAT(place_.text("run/matrix.csv"), HasSubstr("statement,class,text,gc=clique,radius=two,found"));
  EXPECT_TRUE(std::filesystem::exists(place_ / "run/studies/text/b3r/units"));
  EXPECT_TRUE(std::filesystem::exists(place_ / "run/studies/radius-two/b3r/units"));
}

TEST_F(Reproduce, GivesTheSameBytesForAnyJobsAndAgain) {
  ASSERT_EQ(reproduce("-o one --jobs 1").status, 0);
  ASSERT_EQ(reproduce("-o two --jobs 2").status, 0);
  EXPECT_EQ(answer("one"), answer("two"));
  const std::string before = answer("one");
  const auto journals = [&] {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry :
         std::filesystem::directory_iterator(place_ / "one/studies/text/b3r/units"))
      ++count;
    return count;
  };
  const std::size_t calls = journals();
  const Outcome again = reproduce("-o one --jobs 2");
  EXPECT_EQ(answer("one"), before);
  EXPECT_EQ(journals(), calls);  // nothing was left to do
}

TEST_F(Reproduce, RefusesWhatItDoesNotKnow) {
  EXPECT_EQ(place_.corral("reproduce nois --data data -o run").status, 2);
  EXPECT_EQ(place_.corral("reproduce noise noise --data data -o run").status, 2);
  EXPECT_EQ(reproduce("-o run --jobs 0").status, 2);
  place_.put("readings.toml", "[[point]]\nname = \"x\"\n");
  const Outcome bad = reproduce("-o run");
  EXPECT_EQ(bad.status, 3);
  EXPECT_THAT(bad.err, HasSubstr("readings.toml"));
}

TEST_F(Reproduce, NamesAMissingDataSetBeforeItRunsTheOthers) {
  const Outcome outcome =
      place_.corral("reproduce noise overlap --data data --readings readings.toml --claims claims.toml -o run");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, HasSubstr("which the experiment overlap uses"));
  EXPECT_FALSE(std::filesystem::exists(place_ / "run"));
}

}  // namespace
}  // namespace corral
