// SPDX-License-Identifier: MIT
#include "apps/reproduce/readings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "apps/claims/claim_file.h"
#include "apps/pair/match_settings.h"
#include "apps/pair/option_names.h"
#include "apps/reproduce/matched_set.h"
#include "apps/study/experiment_options.h"
#include "grouping/registry.h"
#include "kernel/error.h"

namespace corral {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr char kTwoPoints[] = R"toml(
[[point]]
name = "ratio"
question = "Which?"
[[point.reading]]
name = "lowe"
text = "One"
from = "text"
evidence = "a"
[[point.reading]]
name = "literal"
text = "The other"
from = "later code"
evidence = "b"
options.nnsr.ratio = "literal"
options.si.otsu = "covis"
[[point]]
name = "normals"
question = "Where to?"
[[point.reading]]
name = "mesh"
text = "Faces"
from = "text"
evidence = "c"
[[point.reading]]
name = "origin"
text = "Origin"
from = "library"
evidence = "d"
matching.normals = "origin"
means.over = "matches"
means.least_true_matches = 3
experiments = ["noise"]
)toml";

std::string with(const std::string& what, const std::string& instead) {
  std::string text = kTwoPoints;
  return text.replace(text.find(what), what.size(), instead);
}

TEST(Readings, BuiltInOnesCanAllBeRun) {
  const std::vector<OpenPoint> points = built_in_readings();
  EXPECT_GE(points.size(), 15u);
  for (const OpenPoint& point : points) {
    ASSERT_GE(point.readings.size(), 2u) << point.name;
    const Reading& first = point.readings.front();
    EXPECT_TRUE(first.options.empty() && first.matching.empty() && first.pairs == PairForm::AsStored &&
                first.least_true_matches == 1 && !first.averaging.pooled && !first.averaging.half_sum)
        << point.name << ": the first reading is what experiments do";
    for (const Reading& reading : point.readings) {
      for (const std::string& name : reading.experiments) EXPECT_NO_THROW(read_experiment(name)) << reading.name;
      Experiment experiment = read_experiment("noise");
      for (const auto& [key, value] : reading.matching)
        if (key != "resolution") set_choice(experiment.matching, key, value);
      EXPECT_NO_THROW(override_options(experiment, reading.options)) << point.name << " " << reading.name;
    }
  }
}

TEST(Readings, SetTheirOptionsTogether) {
  const std::vector<OpenPoint> points = parse_readings("mine.toml", kTwoPoints);
  const ReadingSettings settings = settings_of(points, {1, 1});
  EXPECT_EQ(settings.options.at("nnsr").at("ratio"), "literal");
  EXPECT_EQ(settings.options.at("si").at("otsu"), "covis");
  EXPECT_EQ(settings.matching.at("normals"), "origin");
  EXPECT_TRUE(settings.averaging.pooled);
  EXPECT_EQ(settings.least_true_matches, 3);
  EXPECT_TRUE(settings_of(points, {0, 0}).options.empty());
  EXPECT_EQ(to_text(points, {0, 0}), "text");
  EXPECT_EQ(to_text(points, {1, 1}), "ratio=literal normals=origin");
  EXPECT_EQ(departures({1, 0}), 1);
}

TEST(Readings, ChangeTheMatchesOfTheirExperimentsAlone) {
  const std::vector<OpenPoint> points = parse_readings("mine.toml", kTwoPoints);
  EXPECT_FALSE(changes_matches(points[0].readings[1]));
  EXPECT_TRUE(changes_matches(points[1].readings[1]));
  EXPECT_THAT(matching_part(points, {1, 1}, "noise"), ElementsAre(0, 1));
  EXPECT_THAT(matching_part(points, {1, 1}, "density"), ElementsAre(0, 0));
}

TEST(Readings, GiveAGrouperAllVariantsThatTheyCombineTo) {
  const std::vector<OpenPoint> points = built_in_readings();
  EXPECT_EQ(grouper_variants(points, "ransac").size(), 1u);
  EXPECT_EQ(grouper_variants(points, "st").size(), 4u);
  const std::vector<OptionOverrides> of_si = grouper_variants(points, "si");
  EXPECT_EQ(of_si.size(), 3u * 3 * 2);
  EXPECT_TRUE(of_si.front().empty());
  EXPECT_EQ(std::set<OptionOverrides>(of_si.begin(), of_si.end()).size(), of_si.size());
}

TEST(Readings, ErrorsNameThePlace) {
  const auto parse = [](const std::string& text) { return [text] { parse_readings("mine.toml", text); }; };
  EXPECT_THAT(parse(with("ratio = \"literal\"", "ration = \"literal\"")),
              ThrowsMessage<IoError>(AllOf(HasSubstr("mine.toml"), HasSubstr("ration"))));
  EXPECT_THAT(parse(with("options.si", "options.sii")), ThrowsMessage<IoError>(HasSubstr("sii")));
  EXPECT_THAT(parse(with("from = \"library\"", "from = \"hearsay\"")), ThrowsMessage<IoError>(HasSubstr("later code")));
  EXPECT_THAT(parse(with("name = \"normals\"", "name = \"ratio\"")), ThrowsMessage<IoError>(HasSubstr("twice")));
  EXPECT_THAT(parse(with("over = \"matches\"", "over = \"levels\"")),
              ThrowsMessage<IoError>(HasSubstr("pairs | matches")));
  EXPECT_THAT(parse(""), ThrowsMessage<IoError>(HasSubstr("[[point]]")));
}

}  // namespace
}  // namespace corral
