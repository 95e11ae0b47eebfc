// SPDX-License-Identifier: MIT
#include "apps/pair/match_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace corral {
namespace {

using ::testing::HasSubstr;

TEST(StageReport, SaysTheCountsAndTheHints) {
  MatchReport report;
  report.source.points = 12;
  report.target.dropped_no_frame = 5;
  report.matches = 77;
  report.hints = {"do this"};
  const std::string text = stage_report(report);
  for (const char* piece :
       {"source: 12 points", "target: 0 points", "5 without a frame", "77 matches", "\nhint: do this"})
    EXPECT_THAT(text, HasSubstr(piece));
}

TEST(StageReport, HasATableOfTheStages) {
  MatchReport report;
  report.stages = {{"resolution of the source", 1.25, 30}, {"matching", 1234.56, 128.04}};
  EXPECT_THAT(stage_report(report), HasSubstr("\nstage                     time ms  peak memory MB\n"
                                              "resolution of the source      1.2            30.0\n"
                                              "matching                   1234.6           128.0"));
  const Json stages = to_json(report)["stages"];
  ASSERT_EQ(stages.size(), 2U);
  EXPECT_EQ(stages[1].dump(), R"({"stage":"matching","time_ms":1234.56,"peak_memory_mb":128.04})");
}

TEST(StageReport, TellsWhatTheInspectionFound) {
  MatchReport report;
  report.source.faces = 7;
  EXPECT_THAT(stage_report(report), ::testing::Not(HasSubstr("components"))) << "not inspected";
  EXPECT_TRUE(to_json(report)["source"]["topology"].is_null());
  report.source.topology = Topology();
  report.source.topology->components = 3;
  report.source.topology->misoriented_faces = 4;
  EXPECT_THAT(stage_report(report),
              HasSubstr("7 faces, normals towards the origin, 3 components, 4 misoriented faces, pr"));
  EXPECT_EQ(to_json(report)["source"]["topology"]["components"], 3);
}

}  // namespace
}  // namespace corral
