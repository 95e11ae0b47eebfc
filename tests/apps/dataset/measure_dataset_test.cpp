// SPDX-License-Identifier: MIT
// corral dataset measure on pairs whose overlap, occlusion and clutter are known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/dataset/measure_dataset.h"
#include "io/text/csv_file.h"
#include "tests/support/program.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::Workplace;

/// A flat model of 10 x 10 squares; a scene that holds its left 4 columns of squares, 7 more apart; the truth is off by 1.5 pr.
void put_set(const Workplace& place) {
  write_mesh(place / "model.ply", testing::grid(11, 11));
  Mesh scene = testing::grid(5, 11), rest = testing::grid(8, 11);
  rest.vertices.col(0).array() += 100;
  Points vertices(scene.vertices.rows() + rest.vertices.rows(), 3);
  vertices << scene.vertices, rest.vertices;
  Triangles triangles(scene.triangles.rows() + rest.triangles.rows(), 3);
  triangles << scene.triangles, (rest.triangles.array() + static_cast<int>(scene.vertices.rows())).matrix();
  vertices.col(2).array() += 3;
  write_mesh(place / "scene.ply", {vertices, triangles});
  place.put("up.xf", transform_text({Eigen::Matrix3d::Identity(), {0, 0, 3.6}}));
  place.put("dataset.toml", "name = \"flat\"\nkind = \"recognition\"\nresolution = 0.4\n");
  place.put("pairs.csv",
            "pair,source,target,truth,clutter\nhalf,model.ply,scene.ply,up.xf,\n"
            "whole,model.ply,model.ply,,55\n");
}

TEST(MeasureDataset, FindsOverlapOcclusionAndClutter) {
  const Workplace place;
  put_set(place);
  const Outcome outcome = place.corral("dataset measure . --json -o table.csv");
  EXPECT_EQ(outcome.status, 4) << "a pair has no truth";
  EXPECT_THAT(outcome.err, HasSubstr("1 of 2 pairs could not be measured"));
  const auto json = outcome.json();
  const auto pair = json["pairs"][0];
  EXPECT_NEAR(pair["overlap"], 100 * 55.0 / 121, 1e-9) << "5 x 11 vertices within 0.8";
  EXPECT_NEAR(pair["occlusion"], 60, 1e-9) << "4 of 10 columns of squares are there";
  EXPECT_NEAR(pair["clutter"], 100 * 7.0 / 11, 1e-9);
  EXPECT_TRUE(pair["inlier_ratio"].is_null());
  EXPECT_TRUE(json["pairs"][1]["overlap"].is_null());
  EXPECT_EQ(json["histograms"]["occlusion"]["counts"], nlohmann::json::parse("[0,0,0,0,0,0,1,0,0,0]"));
  const CsvTable table = parse_csv("table.csv", place.text("table.csv"));
  EXPECT_THAT(table.header,
              ElementsAre("pair", "overlap", "occlusion", "clutter", "inlier_ratio", "frame_repeatability"));
  EXPECT_EQ(std::stod(table.rows[0][2]), pair["occlusion"]);
  EXPECT_EQ(table.rows[1][1], "");
}

TEST(MeasureDataset, DrawsHistograms) {
  const Workplace place;
  put_set(place);
  const std::string text = place.corral("dataset measure .").out;
  EXPECT_THAT(text, HasSubstr("occlusion: 1 pairs, 60.0 .. 60.0 %, median 60.0 %\n"));
  EXPECT_THAT(text, HasSubstr("\n   60 %       1  " + std::string(50, '#') + "\n"));
  EXPECT_EQ(text.find("inlier_ratio"), std::string::npos);
  EXPECT_THAT(histogram({0, 9.99, 10, 99, 100, 100.5, -1}), ElementsAre(3, 1, 0, 0, 0, 0, 0, 0, 0, 3));
}

TEST(MeasureDataset, WritesAttributesWhereThereAreNone) {
  const Workplace place;
  put_set(place);
  EXPECT_EQ(place.corral("dataset measure . --write").status, 4);
  const Dataset set = read_dataset(place / "");
  EXPECT_THAT(set.attributes, ElementsAre("clutter", "overlap", "occlusion"));
  EXPECT_THAT(set.pairs[0].attributes, ElementsAre("63.64", "45.45", "60.00"));
  EXPECT_THAT(set.pairs[1].attributes, ElementsAre("55", "", "")) << "what was published stays";
  const std::string once = place.text("pairs.csv");
  EXPECT_EQ(place.corral("dataset measure . --write").status, 4);
  EXPECT_EQ(place.text("pairs.csv"), once);
}

TEST(MeasureDataset, MatchesPairsWhereItIsAsked) {
  const Workplace place;
  place.put_pair();
  place.put("dataset.toml", "name = \"one\"\n");
  place.put("pairs.csv", "pair,source,target,truth\nx,model.ply,copy.ply,truth.txt\n");
  const Outcome one = place.corral("dataset measure . --matches --json --threads 1");
  ASSERT_EQ(one.status, 0) << one.err;
  const auto pair = one.json()["pairs"][0];
  const auto run = place.corral("run model.ply copy.ply --truth truth.txt --methods ss --json").json();
  EXPECT_DOUBLE_EQ(pair["inlier_ratio"], 100 * run["true_matches"].get<double>() / run["matches"].get<double>());
  EXPECT_DOUBLE_EQ(pair["frame_repeatability"], 100 * run["frame_repeatability"].get<double>());
  EXPECT_EQ(place.corral("dataset measure . --matches --json --threads 3").out, one.out);
}

TEST(MeasureDataset, APlaceThatCannotBeWrittenIsSaidFirst) {
  const Workplace place;
  put_set(place);
  const Outcome outcome = place.corral("dataset measure . -o none/table.csv");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err, HasSubstr("none/table.csv"));
}

}  // namespace
}  // namespace corral
