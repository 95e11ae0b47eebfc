// SPDX-License-Identifier: MIT
// The program as a user types it: help, groupers, info, perturb and match.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "grouping/registry.h"
#include "kernel/surface/search/resolution.h"
#include "tests/support/program.h"

namespace corral {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using testing::expect_ok;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using testing::keys_of;
using testing::lines_in;
using testing::Outcome;
using ::testing::StartsWith;
using testing::Workplace;

TEST(Help, ListsTheCommandsAndTheExitStatuses) {
  const Outcome help = Workplace().corral("--help");
  expect_ok(help);
  for (const char* command : {"run", "info", "match", "group", "refine", "score", "groupers", "perturb", "triangulate"})
    EXPECT_THAT(help.out, HasSubstr("\n  " + std::string(command) + " "));
  EXPECT_THAT(help.out, HasSubstr("Exit status: 0 done, 2 wrong usage, 3 bad input, 4"));
}

TEST(Help, EveryCommandHasAnExample) {
  const Workplace place;
  for (const char* command :
       {"run", "info", "match", "group", "refine", "score", "groupers", "perturb", "triangulate"}) {
    const Outcome help = place.corral(std::string(command) + " --help");
    expect_ok(help);
    EXPECT_THAT(help.out, AllOf(HasSubstr("Example"), HasSubstr("\n  corral " + std::string(command) + " ")))
        << command;
  }
}

TEST(Groupers, ListsEveryMethodInThreeForms) {
  const Workplace place;
  const Outcome text = place.corral("groupers"), markdown = place.corral("groupers --markdown"),
                json = place.corral("groupers --json");
  for (const Outcome& outcome : {text, markdown, json}) expect_ok(outcome);
  const auto list = json.json();
  ASSERT_EQ(list.size(), groupers().size());
  EXPECT_EQ(lines_in(markdown.out), groupers().size() + 2);
  for (std::size_t i = 0; i < groupers().size(); ++i) {
    const Grouper& grouper = groupers()[i];
    EXPECT_THAT(text.out, HasSubstr(grouper.name + "  " + grouper.title + ": "));
    EXPECT_THAT(markdown.out, HasSubstr("| `" + grouper.name + "` | " + grouper.title + " |"));
    EXPECT_EQ(list[i]["method"], grouper.name);
    EXPECT_THAT(keys_of(list[i]), ElementsAre("citation", "method", "options", "principle", "title"));
    EXPECT_EQ(list[i]["options"].size(), grouper.options.size());
    for (const auto& option : list[i]["options"])
      EXPECT_THAT(keys_of(option), ElementsAre("accepted", "default", "meaning", "name", "paper", "unit"));
  }
}

TEST(Groupers, ThePaperValueIsNullWhereItHasNone) {
  const auto list = Workplace().corral("groupers --json").json();
  ASSERT_EQ(list[2]["method"], "ransac");
  EXPECT_EQ(list[2]["options"][0]["paper"], 10000);
  EXPECT_EQ(list[2]["options"][2]["name"], "seed");
  EXPECT_TRUE(list[2]["options"][2]["paper"].is_null());
}

TEST(Perturb, TheTruthFitsTheCopy) {
  const Workplace place;
  write_mesh(place / "model.ply", testing::bumpy_sphere(3, 2));
  expect_ok(place.corral("perturb model.ply -o exact.ply --truth truth.txt"));
  expect_ok(place.corral("perturb model.ply -o noisy.ply --truth same_truth.txt --noise-pr 0.5"));
  const Mesh model = read_mesh(place / "model.ply"), exact = read_mesh(place / "exact.ply"),
             noisy = read_mesh(place / "noisy.ply");
  const Points moved = read_transform(place / "truth.txt").apply(model.vertices);
  EXPECT_LT((moved - exact.vertices).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(exact.triangles, model.triangles);
  EXPECT_EQ(place.text("truth.txt"), place.text("same_truth.txt")) << "the motion does not depend on the noise";
  const double deviation = (noisy.vertices - moved).norm() / std::sqrt(static_cast<double>(moved.size()));
  EXPECT_NEAR(deviation / point_resolution(model.vertices), 0.5, 0.03);
  EXPECT_GT((moved - model.vertices).rowwise().norm().maxCoeff(), 0.5) << "it does move";
}

TEST(Perturb, TheSeedDecides) {
  const Workplace place;
  write_mesh(place / "model.ply", testing::icosphere(2));
  for (const char* run : {"--seed 1 -o a.ply", "--seed 1 -o b.ply", "--seed 2 -o c.ply"})
    expect_ok(place.corral("perturb model.ply --noise-pr 0.1 " + std::string(run)));
  EXPECT_EQ(place.text("a.ply"), place.text("b.ply"));
  EXPECT_NE(place.text("a.ply"), place.text("c.ply"));
}

TEST(Match, MakesATableAndAReport) {
  const Workplace place;
  place.put_pair();
  const Outcome printed = place.corral("match model.ply copy.ply");
  expect_ok(printed);
  expect_ok(place.corral("match model.ply copy.ply -o matches.csv"));
  EXPECT_EQ(printed.out, place.text("matches.csv"));
  const Outcome reported = place.corral("match model.ply copy.ply -o again.csv --json -v");
  EXPECT_EQ(reported.status, 0);
  EXPECT_THAT(reported.err,
              AllOf(HasSubstr("source: 2562 points"), HasSubstr("target: "), HasSubstr(" matches\nstage ")));
  EXPECT_EQ(place.text("again.csv"), place.text("matches.csv"));
  const CorrespondenceSet matches = read_matches(place / "matches.csv");
  const auto report = reported.json();
  EXPECT_THAT(keys_of(report), IsSupersetOf({"resolution", "source", "target", "matches", "hints"}));
  EXPECT_EQ(report["matches"], matches.size());
  EXPECT_EQ(report["resolution"], matches.resolution);
  EXPECT_EQ(report["source"]["descriptors"], matches.size());
  EXPECT_GT(matches.size(), 10);
  const Mesh model = read_mesh(place / "model.ply");
  EXPECT_EQ(matches.source_centroid.value(), vertex_centroid(model));
  EXPECT_EQ(matches.source_points.row(0), model.vertices.row(matches.source_keypoints[0]));
}

TEST(Match, AFlatSurfaceGivesAnEmptyTableAndAHint) {
  const Workplace place;
  write_mesh(place / "flat.ply", testing::grid(20, 20));
  const Outcome outcome = place.corral("match flat.ply flat.ply");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("hint: no keypoint on the source"), HasSubstr("a flat surface has none")));
  place.put("matches.csv", outcome.out);
  EXPECT_EQ(read_matches(place / "matches.csv").size(), 0);
}

}  // namespace
}  // namespace corral
