// SPDX-License-Identifier: MIT
#include "apps/picture/pair_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "kernel/random.h"
#include "tests/support/meshes.h"

namespace corral {
namespace {

/// Pixels in which one of green, red, blue or orange outweighs the others well.
struct Hues {
  int green = 0, red = 0, blue = 0, orange = 0;
};

/// Of the part of a picture below its title.
Hues hues_of(const Image& image, int top = 60) {
  Hues hues;
  for (int y = top; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Color color = image.at(x, y);
      hues.green += color[1] > color[0] + 40 && color[1] > color[2] + 15;
      hues.red += color[0] > color[1] + 60 && color[0] > color[2] + 60 && color[1] < 150;
      hues.blue += color[2] > color[0] + 50 && color[2] > color[1] + 15;
      hues.orange += color[0] > color[2] + 60 && color[1] > 0.55F * color[0];
    }
  return hues;
}

/// A bumpy ball and its moved copy, with right matches between every 40th vertex and then as many wrong ones.
PairScene ball_scene() {
  PairScene scene;
  const Mesh ball = testing::bumpy_sphere(3, 5);
  scene.source = painted_surface(ball);
  scene.truth = RigidTransform{RandomStream(3).rotation(), {5, -2, 1}};
  scene.target = moved(scene.source, *scene.truth);
  Indices rows;
  for (int row = 0; row < ball.vertices.rows(); row += 40) rows.push_back(row);
  const auto count = static_cast<Eigen::Index>(rows.size());
  scene.source_points.resize(2 * count, 3);
  scene.target_points.resize(2 * count, 3);
  for (Eigen::Index i = 0; i < 2 * count; ++i) {
    const int from = rows[static_cast<std::size_t>(i % count)];
    const int to = i < count ? from : rows[static_cast<std::size_t>((i + 5) % count)];
    scene.source_points.row(i) = scene.source.mesh.vertices.row(from);
    scene.target_points.row(i) = scene.target.mesh.vertices.row(to);
    scene.correct.push_back(i < count);
  }
  return scene;
}

Indices range(int first, int last) {
  Indices rows(static_cast<std::size_t>(last - first));
  std::iota(rows.begin(), rows.end(), first);
  return rows;
}

TEST(MatchPictures, RightIsGreenWrongIsRedMissedIsFaint) {
  PairScene scene = ball_scene();
  const int half = static_cast<int>(scene.correct.size()) / 2;
  const std::vector<Image> pictures = match_pictures(
      scene, {{"right", range(0, half)}, {"wrong", range(half, 2 * half)}, {"none", {}}, {"all", range(0, 2 * half)}},
      600);
  ASSERT_EQ(pictures.size(), 4U);
  const Hues right = hues_of(pictures[0]), wrong = hues_of(pictures[1]), none = hues_of(pictures[2]),
             all = hues_of(pictures[3]);
  EXPECT_GT(right.green, 500);
  EXPECT_EQ(right.red, 0);
  EXPECT_GT(wrong.red, 500);
  EXPECT_EQ(wrong.green, 0);
  EXPECT_EQ(none.green + none.red, 0);
  EXPECT_GT(all.green, 300);
  EXPECT_GT(all.red, 300);
  EXPECT_NE(pictures[2].bytes, pictures[1].bytes);
  // What is missed is there, but faint: the picture with all selected has none of it.
  const auto bluish = [](const Image& image) {
    int count = 0;
    for (int y = 60; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        count += image.at(x, y)[2] > image.at(x, y)[0] + 15 && image.at(x, y)[2] > image.at(x, y)[1] + 10;
    return count;
  };
  EXPECT_GT(bluish(pictures[2]), 200);
  EXPECT_EQ(bluish(pictures[0]), 0);
  for (const Image& picture : pictures) {
    EXPECT_EQ(picture.width, 600);
    EXPECT_EQ(picture.height, pictures[0].height);
  }
  scene.correct.clear();
  EXPECT_GT(hues_of(match_pictures(scene, {{"known to nobody", range(0, half)}}, 600)[0]).blue, 500);
}

TEST(MatchPictures, TheTruthTurnsBothSurfacesAlike) {
  PairScene scene = ball_scene();
  scene.source_points.resize(0, 3);
  scene.target_points.resize(0, 3);
  scene.correct.clear();
  const Image picture = match_pictures(scene, {{"none", {}}}, 800)[0];
  // The columns that hold a surface, left and right: the same silhouette twice.
  std::vector<int> heights;
  for (int x = 0; x < picture.width; ++x) {
    int height = 0;
    for (int y = 80; y < picture.height; ++y) {
      const Color color = picture.at(x, y);
      height += color.maxCoeff() - color.minCoeff() < 12 && color[0] < 250;
    }
    heights.push_back(height);
  }
  const int middle = picture.width / 2;
  const int left = std::accumulate(heights.begin(), heights.begin() + middle, 0);
  const int right = std::accumulate(heights.begin() + middle, heights.end(), 0);
  EXPECT_GT(left, 10000);
  EXPECT_NEAR(left, right, 0.01 * left);
}

TEST(AlignmentPictures, ShowBothSurfacesMingledWhereTheyFit) {
  const PairScene scene = ball_scene();
  RigidTransform beside = *scene.truth;
  beside.translation.x() += 0.4;
  const std::vector<Image> pictures =
      alignment_pictures(scene, {{"truth", scene.truth}, {"off", beside}, {"none", std::nullopt}}, 400);
  ASSERT_EQ(pictures.size(), 3U);
  EXPECT_GT(hues_of(pictures[1]).orange, 2000);
  EXPECT_GT(hues_of(pictures[1]).blue, 2000);
  EXPECT_EQ(hues_of(pictures[2]).orange, 0);
  EXPECT_GT(hues_of(pictures[2]).blue, 10000);
  RigidTransform lost = *scene.truth;
  lost.translation.x() += 1e6;  // leaves the picture as it is without a pose
  const std::vector<Image> far = alignment_pictures(scene, {{"", lost}, {"", std::nullopt}}, 400);
  EXPECT_EQ(far[0].bytes, far[1].bytes);
  EXPECT_GT(hues_of(far[0]).blue, 10000);
}

TEST(ContactSheet, StandsRowByRow) {
  const Image sheet = contact_sheet({Image(4, 3, {1, 0, 0}), Image(4, 3, {2, 0, 0}), Image(4, 3, {3, 0, 0})}, 2);
  EXPECT_EQ(sheet.width, 8);
  EXPECT_EQ(sheet.height, 6);
  EXPECT_EQ(sheet.at(0, 0)[0], 1);
  EXPECT_EQ(sheet.at(7, 2)[0], 2);
  EXPECT_EQ(sheet.at(3, 5)[0], 3);
  EXPECT_EQ(sheet.at(4, 3)[0], 255);
}

TEST(ChooseView, LooksAtTheSideThatFacesOut) {
  for (const Eigen::Vector3d& normal : {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(-1, 0, 0),
                                        Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, -1, 0)}) {
    const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal);
    const PaintedSurface flat = moved(painted_surface(testing::grid(9, 9)), {turn.toRotationMatrix(), {0, 0, 0}});
    const ChosenView view = choose_view(flat);
    EXPECT_LT((view.view_from_mesh.row(2).transpose() - normal).norm(), 1e-9) << normal.transpose();
    EXPECT_NEAR(view.facing, 1, 1e-9);
    EXPECT_TRUE(is_rotation(view.view_from_mesh, 1e-9));
  }
  EXPECT_NEAR(choose_view(painted_surface(testing::icosphere(3))).facing, 0.25, 0.01);  // pi r^2 of 4 pi r^2
}

}  // namespace
}  // namespace corral
