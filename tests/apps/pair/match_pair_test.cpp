// SPDX-License-Identifier: MIT
#include "apps/pair/match_pair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "kernel/error.h"
#include "kernel/number_text.h"
#include "kernel/surface/search/resolution.h"
#include "tests/support/execution.h"
#include "tests/support/meshes.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::refusal_of;
using ::testing::StartsWith;

Mesh enlarged(Mesh mesh, double factor) {
  mesh.vertices *= factor;
  return mesh;
}

MatchSettings settings_of(const std::string& resolution, double keypoint_radius_pr = 3, double support_radius_pr = 15) {
  MatchSettings settings;
  settings.resolution = resolution;
  settings.options = {{"harris", {{"radius_pr", to_text(keypoint_radius_pr)}}},
                      {"shot", {{"radius_pr", to_text(support_radius_pr)}}}};
  return settings;
}

MatchReport report_of(const Mesh& source, const Mesh& target, const MatchSettings& settings) {
  return match_pair(source, target, settings).report;
}

TEST(MatchPair, TheRuleGivesTheResolution) {
  const Mesh source = testing::icosphere(2), target = enlarged(source, 2);
  const double pr = point_resolution(source.vertices);
  const std::vector<std::pair<std::string, double>> rules = {
      {"source", pr}, {"target", 2 * pr}, {"mean", 1.5 * pr}, {"0.125", 0.125}, {"1e-1", 0.1}};
  for (const auto& [rule, expected] : rules) {
    const MatchedPair pair = match_pair(source, target, settings_of(rule, 3, 15));
    EXPECT_DOUBLE_EQ(pair.report.resolution, expected) << rule;
    EXPECT_EQ(pair.matches.resolution, pair.report.resolution) << rule;
    ASSERT_EQ(pair.report.lengths.size(), 2u);
    EXPECT_EQ(pair.report.lengths[0].name, "harris.radius_pr");
    EXPECT_EQ(pair.report.lengths[0].pr, 3);
    EXPECT_EQ(pair.report.lengths[1].name, "shot.radius_pr");
    EXPECT_EQ(pair.report.lengths[1].usual_pr, 15);
    EXPECT_DOUBLE_EQ(pair.report.source.resolution, pr) << "its own, whatever the rule";
    EXPECT_DOUBLE_EQ(pair.report.target.resolution, 2 * pr);
  }
  EXPECT_EQ(MatchSettings().resolution, "mean");
}

TEST(MatchPair, OtherRulesAreRefused) {
  for (const char* rule : {"", "Mean", "median", "0", "-1", "nan", "inf", "1mm", " 1"}) {
    const std::string refused = refusal_of([&] { settings_of(rule).validate(); });
    EXPECT_THAT(refused, AllOf(HasSubstr("'" + std::string(rule) + "'"),
                               HasSubstr("mean|source|target or a length above zero")));
    EXPECT_EQ(refusal_of([&] { match_pair(testing::icosphere(1), testing::icosphere(1), settings_of(rule, 3, 15)); }),
              refused);
  }
}

TEST(MatchPair, AMeshMatchesItself) {
  const Mesh mesh = testing::bumpy_sphere(4, 1);
  const MatchedPair pair = match_pair(mesh, mesh, {});
  ASSERT_GT(pair.matches.size(), 10);
  EXPECT_EQ(pair.matches.source_keypoints, pair.matches.target_keypoints);
  EXPECT_EQ(pair.matches.source_points, pair.matches.target_points);
  EXPECT_EQ(pair.matches.feature_distance, Eigen::VectorXd::Zero(pair.matches.size()));
  EXPECT_GT(pair.matches.second_feature_distance.minCoeff(), 0);
  EXPECT_EQ(pair.matches.source_centroid.value(), vertex_centroid(mesh));
  EXPECT_NO_THROW(pair.matches.validate());
}

TEST(MatchPair, ThreadsAndRegistersDoNotMatter) {
  const Mesh source = testing::bumpy_sphere(4, 1), target = testing::bumpy_sphere(4, 2);
  MatchSettings settings;
  settings.threads = 1;
  const MatchedPair expected = match_pair(source, target, settings);
  ASSERT_GT(expected.matches.size(), 10);
  const auto expect_same = [&] {
    const MatchedPair found = match_pair(source, target, settings);
    EXPECT_EQ(found.report.resolution, expected.report.resolution);
    EXPECT_EQ(found.matches.source_keypoints, expected.matches.source_keypoints);
    EXPECT_EQ(found.matches.target_keypoints, expected.matches.target_keypoints);
    EXPECT_TRUE(found.matches.source_frames == expected.matches.source_frames);
    EXPECT_TRUE(found.matches.target_frames == expected.matches.target_frames);
    EXPECT_TRUE(found.matches.feature_distance == expected.matches.feature_distance);
    EXPECT_TRUE(found.matches.second_feature_distance == expected.matches.second_feature_distance);
  };
  for (const int threads : {0, 2, 5}) {
    settings.threads = threads;
    expect_same();
    for (const std::int64_t each : testing::available_targets()) {
      const testing::ForcedTarget forced(each);
      expect_same();
    }
  }
}

TEST(MatchPair, WhatAThreadRefusesIsRefused) {
  // 5000 vertices within the radius of each other: found out in the loop that is spread over the threads.
  Mesh crowd{Points(5000, 3), Triangles(0, 3)};
  for (int row = 0; row < 5000; ++row) crowd.vertices.row(row) << row * 1e-9, 0.5 * (row % 2), 0;
  MatchSettings settings = settings_of("1");
  for (const int threads : {1, 2, 5}) {
    settings.threads = threads;
    EXPECT_THAT(refusal_of([&] { match_pair(crowd, crowd, settings); }), HasSubstr("over 500 vertices on average"));
  }
}

TEST(MatchPair, SettingsAreChecked) {
  const auto refused = [](const auto& change) {
    MatchSettings settings;
    change(settings);
    const std::string said = refusal_of([&] { settings.validate(); });
    EXPECT_EQ(refusal_of([&] { match_pair(testing::icosphere(1), testing::icosphere(1), settings); }), said);
    return said;
  };
  EXPECT_THAT(refused([](MatchSettings& s) { s.detector = "sift"; }), HasSubstr("harris|harris-mesh|"));
  EXPECT_THAT(refused([](MatchSettings& s) { s.descriptor = "SHOT"; }), HasSubstr("shot"));
  EXPECT_THAT(refused([](MatchSettings& s) { s.sensor = {1, 2}; }), HasSubstr("three finite coordinates"));
  EXPECT_THAT(refused([](MatchSettings& s) { s.sensor = {0, HUGE_VAL, 0}; }), HasSubstr("three finite coordinates"));
  EXPECT_THAT(refused([](MatchSettings& s) { s.threads = -1; }), HasSubstr("--threads is -1"));
  const auto set = [&](const std::string& name, const std::string& option, const std::string& value) {
    return refused([&](MatchSettings& s) { s.options[name][option] = value; });
  };
  EXPECT_THAT(set("harris", "radius_pr", "0"), HasSubstr("radius_pr is 0"));
  EXPECT_THAT(set("shot", "radius_pr", "inf"), HasSubstr("radius_pr is inf"));
  EXPECT_THAT(set("shot", "form", "pcl"), HasSubstr("additive|product|pcl-bug"));
  EXPECT_THAT(set("harris-mesh", "rings", "3"), HasSubstr("'harris-mesh', which is not in use"));
}

TEST(MatchPair, TheReportAddsUp) {
  const MatchedPair pair = match_pair(testing::bumpy_sphere(4, 1), testing::bumpy_sphere(4, 2), {});
  const MatchReport& report = pair.report;
  for (const SurfaceReport& side : {report.source, report.target}) {
    EXPECT_EQ(side.points, 2562);
    EXPECT_EQ(side.faces, 5120);
    EXPECT_EQ(side.keypoints, side.candidates);
    EXPECT_EQ(side.descriptors,
              side.keypoints - side.dropped_small_support - side.dropped_no_frame - side.dropped_no_histogram);
    EXPECT_FALSE(side.topology.has_value()) << "not asked for";
  }
  EXPECT_EQ(report.matches, report.source.descriptors);
  EXPECT_EQ(report.matches, pair.matches.size());
  EXPECT_THAT(report.hints, IsEmpty());
}

TEST(MatchPair, AnnouncesItsStages) {
  std::vector<std::string> stages;
  const MatchReport report = match_pair(testing::icosphere(2), testing::icosphere(2), {},
                                        {[&](const std::string& stage) { stages.push_back(stage); }})
                                 .report;
  EXPECT_EQ(stages.size(), static_cast<std::size_t>(match_stages({})));
  MatchSettings inspecting;
  inspecting.inspect = true;
  int announced = 0;
  match_pair(testing::icosphere(2), testing::icosphere(2), inspecting, {[&](const std::string&) { ++announced; }});
  EXPECT_EQ(announced, match_stages(inspecting));
  EXPECT_EQ(stages.front(), "normals and resolution of the source");
  EXPECT_EQ(stages.back(), "matching");
  ASSERT_EQ(report.stages.size(), stages.size());
  double memory = 0;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    EXPECT_EQ(report.stages[i].stage, stages[i]);
    EXPECT_GT(report.stages[i].time_ms, 0);
    EXPECT_GE(report.stages[i].peak_memory_mb, memory) << "a peak does not shrink";
    memory = report.stages[i].peak_memory_mb;
  }
  EXPECT_GT(memory, 1);
}

TEST(MatchPair, AFlatGridHasNoKeypointAndSaysSo) {
  const Mesh bumpy = testing::bumpy_sphere(4, 1), flat = testing::grid(20, 20);
  const MatchedPair pair = match_pair(flat, bumpy, settings_of("target", 3, 15));
  EXPECT_EQ(pair.matches.size(), 0);
  ASSERT_EQ(pair.report.hints.size(), 1U);
  EXPECT_THAT(pair.report.hints[0], StartsWith("no keypoint on the source"));
  EXPECT_THAT(report_of(flat, flat, {}).hints,
              ElementsAre(AllOf(HasSubstr("source"), HasSubstr("a flat surface has none")),
                          HasSubstr("no keypoint on the target")));
}

TEST(MatchPair, ARadiusTooSmallIsNamedWithABetterOne) {
  const Mesh bumpy = testing::bumpy_sphere(4, 1);
  for (const std::string& hint : report_of(bumpy, bumpy, settings_of("mean", 0.25, 15)).hints)
    EXPECT_THAT(hint, AllOf(HasSubstr("harris.radius_pr is 0.25 pr of this side"), HasSubstr("use about 3 pr")));
  EXPECT_EQ(report_of(bumpy, bumpy, settings_of("mean", 0.25, 15)).hints.size(), 2U);
  const MatchReport small_support = report_of(bumpy, bumpy, settings_of("mean", 3, 1));
  EXPECT_GT(small_support.source.candidates, 0);
  EXPECT_EQ(small_support.source.dropped_small_support, small_support.source.candidates);
  EXPECT_THAT(small_support.hints, ElementsAre(AllOf(HasSubstr("no keypoint of the source could be described"),
                                                     HasSubstr("shot.radius_pr is"), HasSubstr("use about 15 pr")),
                                               HasSubstr("target")));
}

TEST(MatchPair, RefusesWhatIsNoSurface) {
  const Mesh good = testing::icosphere(1);
  Mesh bad = good;
  bad.vertices(7, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal_of([&] { match_pair(bad, good, {}); }), AllOf(HasSubstr("source"), HasSubstr("vertex 7")));
  EXPECT_THAT(refusal_of([&] { match_pair(good, bad, {}); }), AllOf(HasSubstr("target"), HasSubstr("vertex 7")));
  bad = good;
  bad.triangles(3, 0) = 42;
  EXPECT_THAT(refusal_of([&] { match_pair(good, bad, {}); }), AllOf(HasSubstr("target"), HasSubstr("face 3")));
  EXPECT_NE(refusal_of([&] { match_pair(Mesh(), good, {}); }), "");
}

TEST(MatchPair, MetresAndMillimetresHaveNoMean) {
  const Mesh metres = testing::bumpy_sphere(3, 1);
  Mesh millimetres = metres;
  millimetres.vertices *= 1000;
  EXPECT_THROW(match_pair(metres, millimetres, {}), InvalidInput);
  EXPECT_NO_THROW(match_pair(metres, millimetres, settings_of("source")));
}

}  // namespace
}  // namespace corral
