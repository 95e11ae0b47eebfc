// SPDX-License-Identifier: MIT
#include "io/matches/feature_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kernel/error.h"
#include "tests/io/array/npy_encoder.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

using namespace corral::testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class FeatureFileTest : public ::testing::Test {
 protected:
  std::string put(const std::string& name, const std::string& text) {
    put_text(folder_ / name, text);
    return folder_ / name;
  }
  static std::string complaint(const FeatureFiles& files) {
    try {
      read_features(files);
    } catch (const IoError& error) {
      return error.what();
    }
    return "nothing";
  }
  static void expect_two(const FeaturePoints& found) {
    EXPECT_EQ(found.points.row(1), Eigen::RowVector3d(4, 5, 6));
    EXPECT_EQ(found.features.col(0), Eigen::Vector2d(0.25, 0.5));
    EXPECT_EQ(found.features.col(1), Eigen::Vector2d(0.75, 1));
  }
  ScratchFolder folder_;
};

TEST_F(FeatureFileTest, PlacesAndFeaturesInOneFileInTwoAndInAnArchive) {
  expect_two(read_features({put("one.csv", "1,2,3,0.25,0.5\n4,5,6,0.75,1\n")}));
  expect_two(read_features({put("f.txt", "0.25 0.5\n0.75 1\n"), put("k.txt", "1 2 3\n4 5 6\n")}));
  expect_two(read_features({put("a.npy", npy("(2, 5)", {1, 2, 3, 0.25, 0.5, 4, 5, 6, 0.75, 1}))}));
  const std::string points = npy("(2, 3)", {1, 2, 3, 4, 5, 6}), features = npy("(2, 2)", {0.25, 0.5, 0.75, 1});
  expect_two(read_features({put("a.npz", npz({{"xyz", points}, {"feature", features}, {"points", points}}))}));
  expect_two(read_features({put("b.npz", npz({{"mine", features}})) + ":mine", put("k.npy", points)}));
}

TEST_F(FeatureFileTest, KeypointsMayBeVertices) {
  Points vertices(3, 3);
  vertices << 4, 5, 6, 0, 0, 0, 1, 2, 3;
  const FeatureFiles files{put("f.npz", npz({{"data", npy("(2, 2)", {0.25, 0.5, 0.75, 1})}})), put("k.txt", "2\n0\n"),
                           &vertices};
  expect_two(read_features(files));
  EXPECT_THAT(read_features(files).vertices, ElementsAre(2, 0));
  EXPECT_THAT(complaint({files.features, files.keypoints}), HasSubstr("the surface beside it"));
  EXPECT_THAT(complaint({files.features, put("k.txt", "2\n3\n"), &vertices}),
              HasSubstr("line 2: a keypoint is not a vertex"));
}

TEST_F(FeatureFileTest, KeypointsWithANanAreLeftOutAndCounted) {
  const FeaturePoints found =
      read_features({put("one.csv", "1,2,3,0.25,0.5\n1,1,1,nan,0\nnan,1,1,0,0\n4,5,6,0.75,1\n")});
  expect_two(found);
  EXPECT_EQ(found.points.rows(), 2);
  EXPECT_THAT(found.notes, ElementsAre(HasSubstr("2 of 4 keypoints left out")));
}

TEST_F(FeatureFileTest, WhatDoesNotFitIsRefused) {
  EXPECT_THAT(complaint({put("f.txt", "1 2 3\n")}), HasSubstr("x y z and a feature"));
  EXPECT_THAT(complaint({put("f.txt", "1 2\n3 4\n"), put("k.txt", "1 2 3\n")}), HasSubstr("one for each of the 1"));
  EXPECT_THAT(complaint({put("f.txt", "1 2\n3 inf\n"), put("k.txt", "1 2 3\n1 2 3\n")}), HasSubstr("line 2"));
  EXPECT_THAT(complaint({put("a.npz", npz({{"mine", npy("(1,)", {1})}}))}), HasSubstr("the arrays mine"));
}

}  // namespace
}  // namespace corral
