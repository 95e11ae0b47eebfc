// SPDX-License-Identifier: MIT
#include "kernel/surface/search/nearest_error.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>

#include "kernel/evaluation.h"
#include "kernel/random.h"

namespace corral {
namespace {

RigidTransform about_z(double angle, const Eigen::Vector3d& translation) {
  return {Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix(), translation};
}

/// Every point placed by the truth against every one placed by the estimate.
double plain_error(const RigidTransform& estimate, const RigidTransform& truth, const Points& points) {
  const Points right = truth.apply(points), placed = estimate.apply(points);
  double sum = 0;
  for (Eigen::Index i = 0; i < right.rows(); ++i) sum += (placed.rowwise() - right.row(i)).rowwise().norm().minCoeff();
  return sum / static_cast<double>(right.rows());
}

Points random_points(int count, std::uint64_t seed) {
  RandomStream random(seed);
  Points points(count, 3);
  for (Eigen::Index row = 0; row < count; ++row)
    points.row(row) << random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1);
  return points;
}

TEST(NearestError, IsThatOfEveryPointAgainstEveryOther) {
  const Points points = random_points(700, 3);
  const PointTree tree(points);
  const RigidTransform truth = about_z(0.4, {1, 2, 3});
  for (const double angle : {0.4, 0.41, 0.7, 3.0})
    for (const double shift : {0.0, 0.03, 2.0, 1e4}) {
      const RigidTransform estimate = about_z(angle, {1 + shift, 2, 3});
      const double expected = plain_error(estimate, truth, points);
      EXPECT_NEAR(nearest_error(estimate, truth, points, tree), expected, 1e-9 * (1 + expected))
          << angle << " " << shift;
      EXPECT_LE(expected, point_error(estimate, truth, points, 1)->mean_pr + 1e-12);
    }
}

TEST(NearestError, DoesNotSeeASymmetry) {
  Points square(4, 3);
  square << 1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0;
  const RigidTransform truth = about_z(0, {0, 0, 0}), quarter = about_z(std::acos(-1.0) / 2, {0, 0, 0});
  EXPECT_NEAR(nearest_error(quarter, truth, square, PointTree(square)), 0, 1e-12);
  EXPECT_NEAR(point_error(quarter, truth, square, 1)->mean_pr, std::sqrt(2.0), 1e-12);
}

TEST(NearestError, OfManyPointsTakesEveryKth) {
  const Points points = random_points(5'001, 5);  // every third
  const RigidTransform truth = about_z(0, {0, 0, 0}), estimate = about_z(0, {0.3, 0, 0});
  double sum = 0;
  int count = 0;
  for (Eigen::Index row = 0; row < points.rows(); row += 3, ++count)
    sum += (estimate.apply(points).rowwise() - points.row(row)).rowwise().norm().minCoeff();
  EXPECT_NEAR(nearest_error(estimate, truth, points, PointTree(points)), sum / count, 1e-12);
}

TEST(NearestError, OfNoPointsIsZero) {
  const Points none(0, 3);
  EXPECT_EQ(nearest_error({}, {}, none, PointTree(none)), 0);
}

}  // namespace
}  // namespace corral
