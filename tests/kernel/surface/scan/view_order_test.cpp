// SPDX-License-Identifier: MIT
// What the triangles of a view depend on, and what is no view.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "kernel/surface/mesh/perturbation.h"
#include "tests/support/meshes.h"
#include "tests/support/tables.h"
#include "tests/support/views.h"

namespace corral {
namespace {

using testing::Corners;
using testing::counted;
using ::testing::HasSubstr;
using testing::points_of;
using testing::renumbered;
using testing::rough_view;
using testing::seen_along;
using testing::seen_from;
using testing::unlimited;

Indices shuffled(Eigen::Index count, std::uint64_t seed) {
  Indices rows = counted(count);
  RandomStream random(seed);
  for (std::size_t i = rows.size(); i > 1; --i) std::swap(rows[i - 1], rows[random.below(i)]);
  return rows;
}

TEST(TriangulateView, TheOrderOfTheVerticesDoesNotMatter) {
  // Seen from right above, the squares of the grid are four points on one circle each: their diagonals are a matter of
  // order.
  for (const Points& points : {testing::grid(40, 30).vertices, rough_view(400, 5),
                               Points(testing::bumpy_sphere(3, 2).vertices.topRows(300).array() * 0.7)})
    for (const ViewOptions& options : {seen_along({0, 0, -1}), seen_from({3, 2, 15}), seen_along({0.2, -0.1, -1})}) {
      const Triangles expected = triangulate_view(points, 0.5, options).triangles;
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const Indices order = shuffled(points.rows(), seed);
        const Triangles found = triangulate_view(points(order, Eigen::all), 0.5, options).triangles;
        EXPECT_EQ(renumbered(found, order), renumbered(expected, counted(points.rows())));
      }
    }
}

TEST(TriangulateView, RowsAreInOneOrder) {
  const Points points = rough_view(300, 8);
  const Triangles found = triangulate_view(points, 0.5, seen_from({0, 0, 20})).triangles;
  const auto sorted = renumbered(found, counted(points.rows()));
  ASSERT_EQ(static_cast<Eigen::Index>(sorted.size()), found.rows());
  for (Eigen::Index face = 0; face < found.rows(); ++face)
    for (int corner = 0; corner < 3; ++corner)
      EXPECT_EQ(found(face, corner), sorted[static_cast<std::size_t>(face)][static_cast<std::size_t>(corner)]);
}

TEST(TriangulateView, AFarSensorSeesWhatADirectionDoes) {
  const Points points = rough_view(300, 3);
  const Eigen::Vector3d side = Eigen::Vector3d(0.3, -0.2, 1).normalized();
  const Eigen::Vector3d mean = points.colwise().mean();
  const Triangles far = triangulate_view(points, 0.5, seen_from(mean + 1e9 * side)).triangles;
  const Triangles parallel = triangulate_view(points, 0.5, seen_along(-3 * side)).triangles;
  EXPECT_GT(far.rows(), 300);
  EXPECT_EQ(far, parallel);
  const Triangles near = triangulate_view(points, 0.5, seen_from(mean + 10 * side)).triangles;
  EXPECT_FALSE(near.rows() == far.rows() && near == far);
}

TEST(TriangulateView, DependsNeitherOnTheUnitNorOnThePlace) {
  const Points points = rough_view(300, 4);
  const Eigen::Vector3d sensor(1, 2, 14);
  const ViewTriangulation view = triangulate_view(points, 0.5, seen_from(sensor));
  EXPECT_EQ(triangulate_view(1024 * points, 512, seen_from(1024 * sensor)).triangles, view.triangles);
  const RigidTransform motion = random_motion({points, {}}, 6);
  EXPECT_EQ(triangulate_view(motion.apply(points), 0.5, seen_from(motion * sensor)).triangles, view.triangles);
}

TEST(TriangulateView, TheNearerOfTwoInOnePlaceIsSeen) {
  // Vertex 0 is behind 4 (three times as far, off by rounding), 5 is behind 1, 6 is the double of 2.
  const Points points =
      points_of({{0.3, 0.6, -3}, {1, 0, -1}, {0, 1, -1}, {-1, -1, -1}, {0.1, 0.2, -1}, {2, 0, -2}, {0, 1, -1}});
  const ViewTriangulation view = triangulate_view(points, 1, {});
  EXPECT_EQ(view.hidden, 3);
  EXPECT_EQ(renumbered(view.triangles, counted(7)), (std::vector<Corners>{{1, 2, 4}, {1, 4, 3}, {2, 3, 4}}));
  const Points stacked = points_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 2}, {0, 0, 2}});
  const ViewTriangulation below = triangulate_view(stacked, 1, seen_along({0, 0, 1}));
  const ViewTriangulation above = triangulate_view(stacked, 1, seen_along({0, 0, -1}));
  EXPECT_EQ(renumbered(below.triangles, counted(5)), (std::vector<Corners>{{0, 2, 1}}));
  EXPECT_EQ(renumbered(above.triangles, counted(5)), (std::vector<Corners>{{1, 2, 3}}));
  EXPECT_EQ(below.hidden, 2);
  EXPECT_EQ(above.hidden, 2);
}

TEST(TriangulateView, DoublesChangeNothing) {
  const Points points = rough_view(400, 10);
  Points more(2400, 3);
  more << points, points.row(7).replicate(2000, 1);
  const ViewTriangulation view = triangulate_view(points, 0.5, seen_from({1, 2, 6}));
  const ViewTriangulation same = triangulate_view(more, 0.5, seen_from({1, 2, 6}));
  EXPECT_EQ(same.triangles, view.triangles);
  EXPECT_EQ(same.hidden, view.hidden + 2000);
}

TEST(TriangulateView, WithoutAPlaneThereAreNoTriangles) {
  Points oblique(50, 3), ray(50, 3);
  for (int row = 0; row < 50; ++row) {
    oblique.row(row) << 0.1 * row, 0.3 * row, 5 + 0.7 * row;
    ray.row(row) << 0.1 * (row + 1), 0.3 * (row + 1), 0.7 * (row + 1);
  }
  for (const ViewOptions& options : {ViewOptions(), seen_along({0.1, 0.2, 1}), seen_along({0, 0, 1})}) {
    for (const Points& points :
         {Points(0, 3), points_of({{0, 0, 1}}), points_of({{0, 0, 1}, {1, 0, 1}}), oblique,
          Points(oblique.rowwise() + Eigen::RowVector3d(1e5, 2e5, 3e5)), ray, Points(Points::Ones(40, 3))})
      EXPECT_EQ(triangulate_view(points, 0.76, unlimited(options)).triangles.rows(), 0) << points.rows();
  }
  EXPECT_EQ(triangulate_view(ray, 0.76, {}).hidden, 49);
  EXPECT_EQ(triangulate_view(Points::Ones(40, 3), 1, {}).hidden, 39);
}

std::string refusal(const Points& points, double resolution, const ViewOptions& options) {
  return testing::refusal_of([&] { triangulate_view(points, resolution, options); });
}

TEST(TriangulateView, PointsBehindTheSensorAreRefused) {
  const Points points = rough_view(40, 9).rowwise() + Eigen::RowVector3d(0, 0, 20);
  EXPECT_EQ(refusal(points, 1, {}), "");
  Points two = points;
  two.row(3) << 0, 0, -1;
  two.row(17).setZero();  // at the sensor itself, as scanners write what they did not measure
  EXPECT_EQ(
      refusal(two, 1, {}),
      "triangulate_view: the sensor is at 0,0,0 with 2 of 40 points not in front of it, expected the position from "
      "which all were seen (--sensor), or its viewing direction from far away (--direction)");
  EXPECT_EQ(refusal(two, 1, seen_along({0, 0, 1})), "");
  EXPECT_THAT(refusal(points_of({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}}), 1, {}), HasSubstr("4 of 4 points"));
}

TEST(TriangulateView, OptionsAreChecked) {
  const Points points = testing::grid(3, 3).vertices;
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  ASSERT_EQ(refusal(points, 1, seen_from({0, 0, 9})), "");
  for (const double bad : {0.0, -1.0, nan, inf}) {
    EXPECT_THAT(refusal(points, bad, seen_from({0, 0, 9})), HasSubstr("resolution is"));
    ViewOptions options = seen_from({0, 0, 9});
    options.longest_edge_pr = bad;
    EXPECT_THAT(refusal(points, 1, options), HasSubstr("longest_edge_pr is"));
    options = seen_from({0, 0, 9});
    options.grazing_deg = bad;
    EXPECT_THAT(refusal(points, 1, options), HasSubstr("grazing_deg is"));
    options.grazing_deg = 90.001;
    EXPECT_THAT(refusal(points, 1, options), HasSubstr("grazing_deg is 90.001, expected"));
  }
  EXPECT_THAT(refusal(points, 1, seen_from({0, nan, 9})), HasSubstr("sensor is 0,nan,9"));
  EXPECT_THAT(refusal(points, 1, seen_along({0, 0, inf})), HasSubstr("direction is 0,0,inf"));
  EXPECT_THAT(refusal(points, 1, seen_along({0, 0, 0})), HasSubstr("direction is 0,0,0"));
  EXPECT_EQ(refusal(points, 1, seen_along({0, 0, -1e-300})), "");
  Points broken = points;
  broken(4, 1) = nan;
  EXPECT_NE(refusal(broken, 1, seen_from({0, 0, 9})), "");
  EXPECT_THAT(refusal(broken, 1, seen_along({0, 0, -1})), HasSubstr("not finite"));
}

}  // namespace
}  // namespace corral
