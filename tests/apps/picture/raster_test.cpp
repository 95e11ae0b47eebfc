// SPDX-License-Identifier: MIT
// Triangles, lines and letters on a picture, against areas that are known.
#include "apps/picture/raster.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <limits>

#include "apps/picture/lettering.h"
#include "apps/picture/surface_view.h"
#include "tests/support/meshes.h"

namespace corral {
namespace {

const Color kWhite(255, 255, 255), kBlack(0, 0, 0), kRed(255, 0, 0), kBlue(0, 0, 255);

/// How many pixels' worth of a picture is not white, if all that is drawn is black.
double black_area(const Image& image) {
  double sum = 0;
  for (const std::uint8_t byte : image.bytes) sum += 255 - byte;
  return sum / (3 * 255);
}

Corner corner(double x, double y, double z, const Color& color) { return {{x, y, z}, color}; }

TEST(Raster, ATriangleCoversItsArea) {
  Raster raster(40, 30, kWhite);
  raster.draw_triangle(corner(4, 3, 0, kBlack), corner(34, 3, 0, kBlack), corner(4, 23, 0, kBlack));
  const Image image = raster.image();
  EXPECT_NEAR(black_area(image), 0.5 * 30 * 20, 3);
  EXPECT_EQ(image.at(4, 3), kBlack);       // the first pixel that is inside as a whole
  EXPECT_EQ(image.at(3, 3), kWhite);       // left of it
  EXPECT_EQ(image.at(4, 2), kWhite);       // above it
  EXPECT_EQ(image.at(33, 22), kWhite);     // beyond the long side
  const float half = image.at(18, 13)[0];  // the long side runs through its middle
  EXPECT_GT(half, 60);
  EXPECT_LT(half, 200);
}

TEST(Raster, NeighboursLeaveNoGapAndEitherTurnIsFilled) {
  Raster raster(50, 50, kWhite);
  const Corner a = corner(3.3, 4.1, 0, kBlack), b = corner(46.7, 7.9, 0, kBlack), c = corner(41.2, 44.4, 0, kBlack),
               d = corner(5.5, 39.8, 0, kBlack);
  raster.draw_triangle(a, b, c);
  raster.draw_triangle(a, d, c);  // turned the other way
  const auto area = [](const Corner& p, const Corner& q, const Corner& r) {
    return 0.5 * (q.place - p.place).cross(r.place - p.place).norm();
  };
  EXPECT_NEAR(black_area(raster.image()), area(a, b, c) + area(a, d, c), 6);
  for (int i = 6; i < 40; ++i) EXPECT_EQ(raster.image().at(i, i), kBlack) << i;  // along the seam
}

TEST(Raster, TheNearestIsInFrontInAnyOrder) {
  const std::vector<Corner> near = {corner(0, 0, 5, kRed), corner(20, 0, 5, kRed), corner(0, 20, 5, kRed)};
  const std::vector<Corner> far = {corner(0, 0, 1, kBlue), corner(20, 0, 1, kBlue), corner(0, 20, 1, kBlue)};
  for (const bool near_first : {true, false}) {
    Raster raster(20, 20, kWhite);
    const auto& first = near_first ? near : far;
    const auto& second = near_first ? far : near;
    raster.draw_triangle(first[0], first[1], first[2]);
    raster.draw_triangle(second[0], second[1], second[2]);
    EXPECT_EQ(raster.image().at(5, 5), kRed);
  }
  Raster crossing(20, 20, kWhite);  // one leans through the other: each is seen where it is nearer
  crossing.draw_triangle(corner(0, 0, 0, kRed), corner(20, 0, 0, kRed), corner(0, 40, 0, kRed));
  crossing.draw_triangle(corner(0, 0, -10, kBlue), corner(20, 0, 10, kBlue), corner(0, 40, -10, kBlue));
  EXPECT_EQ(crossing.image().at(4, 5), kRed);
  EXPECT_EQ(crossing.image().at(13, 5), kBlue);
}

TEST(Raster, WhatCannotBeSeenIsLeftOut) {
  Raster raster(10, 10, kWhite);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  raster.draw_triangle(corner(20, 20, 0, kBlack), corner(30, 20, 0, kBlack), corner(20, 30, 0, kBlack));
  raster.draw_triangle(corner(-9, -9, 0, kBlack), corner(-1, -9, 0, kBlack), corner(-9, -1, 0, kBlack));
  raster.draw_triangle(corner(nan, 1, 0, kBlack), corner(8, 1, 0, kBlack), corner(1, 8, 0, kBlack));
  raster.draw_triangle(corner(1, 1, nan, kBlack), corner(8, 1, nan, kBlack), corner(1, 8, nan, kBlack));
  raster.draw_disc(corner(nan, 5, 0, kBlack), 3);
  raster.draw_disc(corner(-5, 5, 0, kBlack), 3);
  raster.draw_triangle(corner(1, 1, 0, kBlack), corner(5, 5, 0, kBlack), corner(9, 9, 0, kBlack));  // no area
  EXPECT_EQ(black_area(raster.image()), 0);
  raster.draw_triangle(corner(-1e9, -1e9, 0, kBlack), corner(1e9, -1e9, 0, kBlack), corner(0, 1e9, 0, kBlack));
  EXPECT_EQ(black_area(raster.image()), 100);
}

TEST(Raster, ASphereIsARoundDiscLitFromTheUpperLeft) {
  const PaintedSurface sphere = painted_surface(testing::icosphere(4, 2.0));
  const auto draw = [&] {
    Raster raster(100, 100, kWhite);
    paint(raster, sphere, {Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero(), 20, {50, 50}}, {200, 200, 200});
    return raster.image();
  };
  const Image image = draw();
  int inside = 0;
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 100; ++x) inside += image.at(x, y) != kWhite;
  EXPECT_NEAR(inside, M_PI * 40 * 40, 0.03 * M_PI * 40 * 40);  // border pixels count whole
  EXPECT_EQ(image.at(8, 50), kWhite);
  EXPECT_NE(image.at(12, 50), kWhite);
  EXPECT_GT(image.at(36, 32)[0], image.at(64, 68)[0] + 30);
  EXPECT_EQ(draw().bytes, image.bytes);
}

TEST(Raster, ACloudIsDrawnAsDiscs) {
  Mesh cloud = testing::grid(11, 11, 1.0);
  cloud.triangles.resize(0, 3);
  Raster raster(60, 60, kWhite);
  paint(raster, painted_surface(cloud), {Eigen::Matrix3d::Identity(), {5, 5, 0}, 5, {30, 30}}, kBlack);
  const double disc = M_PI * 4 * 4;  // 0.8 pr; they overlap into a square with round corners
  EXPECT_NEAR(black_area(raster.image()), 50 * 50 + 4 * 50 * 3.4 + disc, 120);
}

TEST(DrawLine, CoversItsLengthAndItsRoundEnds) {
  for (const Place& to : {Place(80, 20), Place(20, 80), Place(70, 75), Place(20, 20)}) {
    Image image(100, 100, kWhite);
    draw_line(image, {20, 20}, to, {kBlack, 6, 1});
    EXPECT_NEAR(black_area(image), 6 * (to - Place(20, 20)).norm() + M_PI * 9, 4) << to.transpose();
    Image back(100, 100, kWhite);
    draw_line(back, to, {20, 20}, {kBlack, 6, 1});
    EXPECT_NEAR(black_area(back), black_area(image), 0.5);
  }
  Image faint(100, 100, kWhite);
  draw_line(faint, {20, 50}, {80, 50}, {kBlack, 6, 0.5});
  EXPECT_NEAR(black_area(faint), 0.5 * (6 * 60 + M_PI * 9), 4);
}

TEST(DrawLine, IsCutAtTheBorder) {
  Image image(20, 20, kWhite);
  draw_line(image, {-1e7, 10}, {1e7, 10}, {kBlack, 2, 1});
  EXPECT_NEAR(black_area(image), 2 * 20, 1);
  draw_line(image, {-50, -50}, {-20, -60}, {kBlack, 2, 1});
  EXPECT_NEAR(black_area(image), 2 * 20, 1);
}

TEST(Lettering, StandsWhereItShould) {
  Image image(200, 60, kWhite);
  draw_text(image, {10, 40}, "E", 20, kBlack);
  EXPECT_GT(black_area(image), 60);
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 200; ++x)
      if (image.at(x, y) != kWhite) {
        EXPECT_TRUE(x >= 10 && x <= 11 + text_width("E", 20) && y >= 18 && y <= 42) << x << " " << y;
      }
  EXPECT_DOUBLE_EQ(text_width("true", 10) + text_width(" 7", 10), text_width("true 7", 10));
  EXPECT_DOUBLE_EQ(text_width("true", 20), 2 * text_width("true", 10));
  Image other(200, 60, kWhite), unknown(200, 60, kWhite), question(200, 60, kWhite);
  draw_text(other, {10, 40}, "F", 20, kBlack);
  EXPECT_GT(black_area(image), black_area(other) + 10);  // the foot of the E
  draw_text(unknown, {10, 40}, "\xff\n", 20, kBlack);
  draw_text(question, {10, 40}, "??", 20, kBlack);
  EXPECT_EQ(unknown.bytes, question.bytes);
}

TEST(Png, ReadsBackWhatWasWritten) {
  Image image(37, 23, {10, 200, 30});
  draw_line(image, {2, 3}, {30, 20}, {kRed, 3, 0.7});
  const std::string bytes = png_bytes(image);
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()), 0) << header.message;
  EXPECT_EQ(header.width, 37U);
  EXPECT_EQ(header.height, 23U);
  header.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> read(PNG_IMAGE_SIZE(header));
  ASSERT_NE(png_image_finish_read(&header, nullptr, read.data(), 0, nullptr), 0) << header.message;
  EXPECT_EQ(read, image.bytes);
  EXPECT_EQ(png_bytes(image), bytes);
}

TEST(Image, PastesWhatFits) {
  Image image(4, 4, kWhite);
  paste(image, Image(3, 3, kRed), 2, -1);
  EXPECT_EQ(image.at(2, 0), kRed);
  EXPECT_EQ(image.at(3, 1), kRed);
  EXPECT_EQ(image.at(2, 2), kWhite);
  EXPECT_EQ(image.at(1, 0), kWhite);
}

}  // namespace
}  // namespace corral
