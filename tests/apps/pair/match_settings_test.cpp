// SPDX-License-Identifier: MIT
#include "apps/pair/match_settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "grouping/registry.h"

namespace corral {
namespace {

using ::testing::ElementsAre;

TEST(MatchSettings, JsonHoldsAllThatResultsDependOn) {
  MatchSettings settings;
  std::vector<std::string> keys;
  const Json json = to_json(settings);
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  EXPECT_THAT(keys, ElementsAre("resolution_rule", "detector", "descriptor", "options", "sensor", "frames", "normals",
                                "matcher", "mutual"));
  EXPECT_EQ(json["options"]["harris"]["radius_pr"], 3) << "defaults stand there too";
  settings.threads = 7;
  EXPECT_EQ(to_json(settings), json);
  settings.options["harris"]["radius_pr"] = "3.0";
  EXPECT_EQ(to_json(settings), json) << "the same value written otherwise";
  settings.options["harris"]["radius_pr"] = "4";
  EXPECT_NE(to_json(settings), json);
  settings.detector = "harris-mesh";
  EXPECT_EQ(to_json(settings)["options"]["harris-mesh"]["neighborhood"], "adaptive");
}

TEST(MatchSettings, TheLengthOfTheKeypointsIsTheDetectorsFirst) {
  MatchSettings settings;
  EXPECT_EQ(keypoint_length(settings).name, "radius_pr");
  settings.detector = "uniform";
  settings.options["uniform"]["spacing_pr"] = "6";
  EXPECT_EQ(keypoint_length(settings).name, "spacing_pr");
  EXPECT_EQ(keypoint_length(settings).value, "6");
}

TEST(MatchSettings, NamesAreUniqueOverAllTables) {
  std::set<std::string> names;
  const auto add = [&](const auto& table) {
    for (const auto& entry : table) EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
  };
  add(groupers());
  add(detectors());
  add(descriptors());
  EXPECT_GE(names.size(), 11u);
}

}  // namespace
}  // namespace corral
