// SPDX-License-Identifier: MIT
#include "refine/refine_surface.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <cmath>
#include <cstring>
#include <limits>

#include "kernel/error.h"
#include "kernel/evaluation.h"
#include "kernel/random.h"
#include "kernel/surface/mesh/perturbation.h"
#include "kernel/surface/normals.h"
#include "kernel/surface/search/nearest_points.h"
#include "kernel/surface/search/resolution.h"
#include "tests/support/execution.h"
#include "tests/support/meshes.h"

namespace corral {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kSide = 80;  // of the landscape, pr
const SurfaceResidual kResiduals[] = {SurfaceResidual::PointToPlane, SurfaceResidual::PointToPoint};

struct Surface {
  Points points, normals;
};

/// Hills over a square, about one point per square pr at random places, with the normals of the formula.
Surface landscape(double from, double to, std::uint64_t seed, double pr = 1) {
  RandomStream random(seed);
  const auto count = static_cast<Eigen::Index>((to - from) * kSide);
  Surface surface{Points(count, 3), Points(count, 3)};
  for (Eigen::Index row = 0; row < count; ++row) {
    const double x = random.uniform(from, to), y = random.uniform(0, kSide);
    const double z = 5 * std::sin(x / 7) * std::cos(y / 9) + 3 * std::sin(x / 13 + y / 11);
    const double by_x = 5 / 7.0 * std::cos(x / 7) * std::cos(y / 9) + 3 / 13.0 * std::cos(x / 13 + y / 11);
    const double by_y = -5 / 9.0 * std::sin(x / 7) * std::sin(y / 9) + 3 / 11.0 * std::cos(x / 13 + y / 11);
    surface.points.row(row) << pr * x, pr * y, pr * z;
    surface.normals.row(row) = Eigen::RowVector3d(-by_x, -by_y, 1).normalized();
  }
  return surface;
}

/// Away from the pose that lays the surfaces on each other, about their middle.
RigidTransform start_off(double angle_deg, double shift, std::uint64_t seed,
                         const Eigen::Vector3d& middle = {kSide / 2, kSide / 2, 0}) {
  RandomStream random(seed);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle_deg * M_PI / 180, random.direction()).toRotationMatrix();
  return {turn, middle - turn * middle + shift * random.direction()};
}

RefinedSurface refine(const Surface& source, const Surface& target, const RigidTransform& start,
                      const SurfaceOptions& options = {}, double pr = 1) {
  const PointTree tree(target.points);
  NearestTracker tracker(tree);
  const NearestPairs pair = [&](const Points& queries, double limit) -> const PointPairs& {
    return tracker.pair(queries, limit);
  };
  return refine_surface({{source.points, source.normals}, {target.points, target.normals}, pr, pair}, start, options);
}

SurfaceOptions with(SurfaceResidual residual) {
  SurfaceOptions options;
  options.residual = residual;
  return options;
}

double turn_deg(const RefinedSurface& found) { return rotation_error_deg(*found.target_from_source, {}); }
double rmse_pr(const RefinedSurface& found, const Points& points, double pr = 1) {
  return point_error(*found.target_from_source, {}, points, pr)->rmse_pr;
}

void expect_no_pose(const RefinedSurface& found, SurfaceStatus status) {
  EXPECT_EQ(found.status, status) << to_text(found.status) << ", condition " << found.condition;
  EXPECT_FALSE(found.target_from_source.has_value());
}

TEST(RefineSurface, KnownMotionIsRecovered) {
  const Surface target = landscape(0, kSide, 1), source = landscape(0, kSide, 2);
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    for (const SurfaceResidual residual : kResiduals) {
      const bool by_planes = residual == SurfaceResidual::PointToPlane;
      const RefinedSurface found = refine(source, target, start_off(6, 5, seed), with(residual));
      ASSERT_EQ(found.status, SurfaceStatus::Refined) << to_text(found.status);
      EXPECT_LT(turn_deg(found), by_planes ? 0.05 : 0.3) << seed;
      EXPECT_LT(rmse_pr(found, source.points), by_planes ? 0.05 : 0.5) << seed;
      EXPECT_TRUE(is_rotation(found.target_from_source->rotation, 1e-12));
      EXPECT_GT(found.after.overlap, 0.99);
      EXPECT_GE(found.after.overlap, found.before.overlap);
      EXPECT_LT(found.after.rms_pr, found.before.rms_pr);
      EXPECT_EQ(found.levels.size(), 4u);
    }
}

TEST(RefineSurface, ThreadsDoNotShow) {
  const Surface target = landscape(0, 2 * kSide, 1), source = landscape(0, 2 * kSide, 2);
  const PointTree tree(target.points);
  for (const SurfaceResidual residual : kResiduals) {
    const SurfaceOptions options = with(residual);
    const RefinedSurface expected = refine(source, target, start_off(3, 3, 1), options);
    ASSERT_TRUE(expected.target_from_source.has_value());
    for (const ParallelFor& parallel : {ParallelFor(testing::last_first), ParallelFor(testing::on_three_threads)}) {
      NearestTracker tracker(tree, parallel);
      const NearestPairs pair = [&](const Points& queries, double limit) -> const PointPairs& {
        return tracker.pair(queries, limit);
      };
      const RefinedSurface found =
          refine_surface({{source.points, source.normals}, {target.points, target.normals}, 1, pair, parallel},
                         start_off(3, 3, 1), options);
      EXPECT_EQ(found.target_from_source->rotation, expected.target_from_source->rotation);
      EXPECT_EQ(found.target_from_source->translation, expected.target_from_source->translation);
      EXPECT_EQ(found.condition, expected.condition);
    }
  }
}

TEST(RefineSurface, UnitsDoNotMatter) {
  const Surface target = landscape(0, kSide, 1, 0.001), source = landscape(0, kSide, 2, 0.001);
  const RigidTransform start = start_off(6, 0.005, 3, {0.04, 0.04, 0});
  const RefinedSurface found = refine(source, target, start, {}, 0.001);
  ASSERT_TRUE(found.target_from_source.has_value());
  EXPECT_LT(turn_deg(found), 0.05);
  EXPECT_LT(rmse_pr(found, source.points, 0.001), 0.05);
  EXPECT_GT(found.after.overlap, 0.99);
}

/// The target is one half: what lies beyond its edge finds its rim, and pulls by points but hardly by planes.
TEST(RefineSurface, HalfOfASurfaceIsEnough) {
  const Surface half = landscape(0, kSide / 2, 3), source = landscape(0, kSide, 4);
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const RefinedSurface found = refine(source, half, start_off(4, 3, seed));
    ASSERT_TRUE(found.target_from_source.has_value()) << to_text(found.status);
    EXPECT_LT(turn_deg(found), 0.05) << seed;
    EXPECT_LT(rmse_pr(found, source.points), 0.05) << seed;
    EXPECT_NEAR(found.after.overlap, 0.5, 0.08);
    const RefinedSurface by_points = refine(source, half, start_off(4, 3, seed), with(SurfaceResidual::PointToPoint));
    ASSERT_TRUE(by_points.target_from_source.has_value());
    EXPECT_LT(rmse_pr(found, source.points), rmse_pr(by_points, source.points));
  }
}

/// Half of the target is hidden behind a wall that bends away from it: points above it find its rim and its face.
TEST(RefineSurface, NormalsThatDisagreeAreNoPair) {
  const Surface source = landscape(0, kSide, 18);
  Surface target = landscape(0, kSide / 2, 19), wall = landscape(0, kSide / 2, 20);
  for (Eigen::Index row = 0; row < wall.points.rows(); ++row) {
    const Eigen::RowVector3d place = wall.points.row(row);
    wall.points.row(row) << kSide / 2 + 0.3 * place.x(), place.y(), 4 + 2 * place.x();
    wall.normals.row(row) = Eigen::RowVector3d(-2, 0, 0.3).normalized();
  }
  const Eigen::Index rows = target.points.rows();
  target.points.conservativeResize(2 * rows, 3), target.normals.conservativeResize(2 * rows, 3);
  target.points.bottomRows(rows) = wall.points, target.normals.bottomRows(rows) = wall.normals;
  SurfaceOptions all;
  all.largest_angle_deg = 90;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const RefinedSurface found = refine(source, target, start_off(3, 3, seed)),
                         by_all = refine(source, target, start_off(3, 3, seed), all);
    ASSERT_TRUE(found.target_from_source && by_all.target_from_source);
    EXPECT_LT(rmse_pr(found, source.points), 0.05);
    EXPECT_LT(3 * rmse_pr(found, source.points), rmse_pr(by_all, source.points));
    EXPECT_LT(found.after.overlap, by_all.after.overlap);
  }
}

/// Normals that are off to one side here and to the other there.
TEST(RefineSurface, BothNormalsCount) {
  Surface target = landscape(0, kSide, 25), source = landscape(0, kSide, 26);
  const Eigen::Matrix3d tilt = Eigen::AngleAxisd(10 * M_PI / 180, Eigen::Vector3d::UnitX()).toRotationMatrix();
  target.normals = (target.normals * tilt).eval();
  const double by_target = refine(source, target, {}).after.rms_pr;
  source.normals = (source.normals * tilt.transpose()).eval();
  const RefinedSurface found = refine(source, target, {});
  EXPECT_LT(found.after.rms_pr, 0.005);  // of 0.5 along the surface
  EXPECT_GT(by_target, 0.02);
  EXPECT_LT(rmse_pr(found, source.points), 0.05);
}

TEST(RefineSurface, SurfacesMayBeInsideOut) {
  const Surface target = landscape(0, kSide, 21), source = landscape(0, kSide, 22);
  const RefinedSurface found = refine(source, target, start_off(4, 3, 1)),
                       turned = refine({source.points, -source.normals}, target, start_off(4, 3, 1));
  ASSERT_TRUE(found.target_from_source && turned.target_from_source);
  EXPECT_EQ(found.target_from_source->rotation, turned.target_from_source->rotation);
  EXPECT_EQ(found.target_from_source->translation, turned.target_from_source->translation);
}

/// Points with noise on them: the best pose is that of points to points. Another sample of the surface: it is not.
TEST(RefineSurface, PointsThatAreSeenTwiceAreLaidOnThemselves) {
  for (const double noise_pr : {0.05, 0.2, 0.4})
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const Surface source = landscape(0, kSide, 23), other = landscape(0, kSide, 24);
      RandomStream random(seed);
      const auto noisy = [&](Surface surface) {
        for (Eigen::Index row = 0; row < surface.points.rows(); ++row)
          for (int axis = 0; axis < 3; ++axis) surface.points(row, axis) += noise_pr * random.normal();
        return surface;
      };
      const Surface again = noisy(source);
      const RefinedSurface found = refine(source, again, start_off(2, 2, seed)),
                           by_points =
                               refine(source, again, *found.target_from_source, with(SurfaceResidual::PointToPoint));
      ASSERT_TRUE(found.target_from_source && by_points.target_from_source);
      EXPECT_EQ(found.levels.size(), 5u) << noise_pr;
      EXPECT_NEAR(rmse_pr(found, source.points), rmse_pr(by_points, source.points), 2e-3);
      EXPECT_EQ(refine(source, noisy(other), start_off(2, 2, seed)).levels.size(), 4u) << noise_pr;
    }
  // So much noise that it is larger than the distances between points.
  RandomStream random(4);
  Surface blurred = landscape(0, kSide, 28);
  for (Eigen::Index row = 0; row < blurred.points.rows(); ++row)
    for (int axis = 0; axis < 3; ++axis) blurred.points(row, axis) += random.normal();
  EXPECT_EQ(refine(landscape(0, kSide, 29), blurred, start_off(1, 1, 1)).levels.size(), 4u);
  // Every second of them on one side, none of its own on the other: seen twice, but without noise.
  const Surface source = landscape(0, kSide, 27);
  const auto half = Eigen::seqN(0, source.points.rows() / 2, 2);
  const RefinedSurface found =
      refine(source, {source.points(half, Eigen::all), source.normals(half, Eigen::all)}, start_off(2, 2, 1));
  EXPECT_EQ(found.levels.size(), 4u);
}

/// A wall that is not in the target, farther away than the last limit, changes nothing once the pose is near.
TEST(RefineSurface, PointsOutsideTheOverlapDoNotPull) {
  const Surface target = landscape(0, kSide, 5), source = landscape(0, kSide, 6);
  SurfaceOptions options;
  options.levels = {{4}};
  const RigidTransform start = start_off(0.5, 0.5, 7);
  Surface longer{Points(2 * source.points.rows(), 3), Points(2 * source.points.rows(), 3)};
  longer.points << source.points, source.points.rowwise() + Eigen::RowVector3d(0, 0, 30);
  longer.normals << source.normals, source.normals;
  const RefinedSurface alone = refine(source, target, start, options);
  for (const SurfaceResidual residual : kResiduals) {
    options.residual = residual;
    const RigidTransform without = *refine(source, target, start, options).target_from_source;
    const RefinedSurface found = refine(longer, target, start, options);
    EXPECT_LT(rotation_error_deg(*found.target_from_source, without), 1e-4);
    EXPECT_LT((found.target_from_source->translation - without.translation).norm(), 1e-4);
    EXPECT_NEAR(found.after.overlap, 0.5, 0.01);
  }
  EXPECT_NEAR(alone.after.overlap, 1, 0.01);
}

TEST(RefineSurface, CostNeverRisesWithinALevel) {
  const Surface target = landscape(0, 0.7 * kSide, 8), source = landscape(0, kSide, 9);
  for (std::uint64_t seed = 1; seed <= 8; ++seed)
    for (const SurfaceResidual residual : kResiduals) {
      const RefinedSurface found =
          refine(source, target, start_off(static_cast<double>(2 * seed), 5, seed), with(residual));
      ASSERT_FALSE(found.levels.empty());
      for (const auto& level : found.levels)
        for (std::size_t i = 0; i < level.size(); ++i) {
          EXPECT_LE(level[i].squares_after, level[i].squares_before);
          if (residual == SurfaceResidual::PointToPoint && i > 0) {
            EXPECT_LE(level[i].cost, level[i - 1].cost * (1 + 1e-12));
          }
        }
    }
}

TEST(RefineSurface, SameInputSameBytes) {
  const Surface target = landscape(0, kSide, 10), source = landscape(0, kSide, 11);
  for (const SurfaceResidual residual : kResiduals) {
    const SurfaceOptions options = with(residual);
    const auto once = refine(source, target, start_off(5, 3, 1), options);
    const auto twice = refine(source, target, start_off(5, 3, 1), options);
    ASSERT_TRUE(once.target_from_source && twice.target_from_source);
    EXPECT_EQ(std::memcmp(&*once.target_from_source, &*twice.target_from_source, sizeof(RigidTransform)), 0);
    ASSERT_EQ(once.levels.back().size(), twice.levels.back().size());
    EXPECT_EQ(once.levels.back().back().cost, twice.levels.back().back().cost);
  }
}

/// With the normals of the formula, and with those that a noisy sample gives.
TEST(RefineSurface, SurfacesThatSlideUponThemselvesAreReported) {
  const Mesh sphere = testing::icosphere(5), plane = testing::grid(60, 60, 1);
  for (const Mesh& mesh : {sphere, plane})
    for (const double noise_pr : {0.0, 0.1})
      for (const SurfaceResidual residual : kResiduals) {
        const double pr = point_resolution(mesh.vertices);
        const Mesh noisy = add_gaussian_noise(mesh, noise_pr * pr, 1);
        const Surface target{noisy.vertices, estimate_normals(noisy)};
        const Eigen::Vector3d middle = vertex_centroid(mesh);
        const RefinedSurface found =
            refine({mesh.vertices, estimate_normals(mesh)}, target, start_off(1, pr, 2, middle), with(residual), pr);
        expect_no_pose(found, SurfaceStatus::DegenerateGeometry);
        EXPECT_GT(found.condition, 1000);
        EXPECT_GT(found.after.overlap, 0.9);
      }
}

/// On itself every point is its own partner: the matrix of the header, written out.
TEST(RefineSurface, ConditionFollowsItsFormula) {
  const Surface target = landscape(0, kSide, 17);
  const Eigen::RowVector3d mean = target.points.colwise().mean();
  const double size =
      std::sqrt((target.points.rowwise() - mean).squaredNorm() / static_cast<double>(target.points.rows()));
  Eigen::Matrix<double, 6, 6> equations = Eigen::Matrix<double, 6, 6>::Zero();
  for (Eigen::Index row = 0; row < target.points.rows(); ++row) {
    const Eigen::Vector3d q = (target.points.row(row) - mean).transpose() / size,
                          n = target.normals.row(row).transpose();
    Eigen::Matrix<double, 6, 1> a;
    a << q.y() * n.z() - q.z() * n.y(), q.z() * n.x() - q.x() * n.z(), q.x() * n.y() - q.y() * n.x(), n;
    equations += a * a.transpose();
  }
  const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(equations).singularValues();
  const RefinedSurface found = refine(target, target, {});
  EXPECT_NEAR(found.condition, values(0) / values(5), 1e-6 * found.condition);
  EXPECT_LT(rmse_pr(found, target.points), 1e-9);
}

TEST(RefineSurface, TooLittleOverlapIsReported) {
  const Surface target = landscape(0, kSide, 12);
  RigidTransform far;
  far.translation << 0, 0, 500;
  const RefinedSurface apart = refine(target, target, far);
  expect_no_pose(apart, SurfaceStatus::TooLittleOverlap);
  EXPECT_EQ(apart.before.overlap, 0);
  EXPECT_EQ(apart.after.overlap, 0);
  const Surface strip = landscape(0, 2, 13);
  SurfaceOptions picky;
  picky.least_overlap = 0.5;
  expect_no_pose(refine(target, strip, {}, picky), SurfaceStatus::TooLittleOverlap);

  expect_no_pose(refine({Points(0, 3), Points(0, 3)}, target, {}), SurfaceStatus::TooLittleOverlap);
  expect_no_pose(refine(target, {Points(0, 3), Points(0, 3)}, {}), SurfaceStatus::TooLittleOverlap);
  expect_no_pose(refine({target.points.topRows(1), target.normals.topRows(1)}, target, {}),
                 SurfaceStatus::TooLittleOverlap);
  expect_no_pose(refine({Points::Constant(50, 3, kNaN), target.normals.topRows(50)}, target, {}),
                 SurfaceStatus::TooLittleOverlap);
}

TEST(RefineSurface, PointsWithoutANormalAreNoPartners) {
  Surface target = landscape(0, kSide, 14);
  const Surface source = landscape(0, kSide, 15);
  for (Eigen::Index row = 0; row < target.points.rows(); row += 4)
    target.normals.row(row).setConstant(row % 8 == 0 ? kNaN : 0.0);
  for (const SurfaceResidual residual : kResiduals) {
    const RefinedSurface found = refine(source, target, start_off(4, 3, 1), with(residual));
    ASSERT_TRUE(found.target_from_source.has_value());
    EXPECT_LT(rmse_pr(found, source.points), residual == SurfaceResidual::PointToPlane ? 0.05 : 0.5);
    EXPECT_NEAR(found.after.overlap, 0.75, 0.03);
  }
  const Surface whole = landscape(0, kSide, 14);
  Surface holed = source;
  for (Eigen::Index row = 0; row < holed.points.rows(); row += 4)
    holed.normals.row(row).setConstant(row % 8 == 0 ? kNaN : 0.0);
  for (const SurfaceResidual residual : kResiduals)
    EXPECT_NEAR(refine(holed, whole, start_off(4, 3, 1), with(residual)).after.overlap, 0.75, 0.03);
  target.normals.setConstant(kNaN);
  expect_no_pose(refine(source, target, {}), SurfaceStatus::TooLittleOverlap);
}

TEST(RefineSurface, OptionsOutOfRangeThrow) {
  const Surface target = landscape(0, kSide, 16);
  const auto expect_refused = [&](const SurfaceOptions& options) {
    EXPECT_THROW(refine(target, target, {}, options), InvalidInput);
  };
  SurfaceOptions options;
  for (const SurfaceLevel& level : {SurfaceLevel{0}, SurfaceLevel{kNaN}, SurfaceLevel{1, 0}, SurfaceLevel{1, 1, 0}}) {
    options.levels = {level};
    expect_refused(options);
  }
  options.levels.clear();
  expect_refused(options);
  options = {};
  options.rest_pr = -1;
  expect_refused(options);
  options = {};
  options.least_overlap = kNaN;
  expect_refused(options);
  options = {};
  options.largest_condition = 0;
  expect_refused(options);
  for (const double angle_deg : {0.0, 91.0, kNaN}) {
    options = {};
    options.largest_angle_deg = angle_deg;
    expect_refused(options);
  }
  EXPECT_THROW(refine(target, {target.points, Points(1, 3)}, {}), InvalidInput);
  EXPECT_THROW(refine({target.points, Points(1, 3)}, target, {}), InvalidInput);
  EXPECT_THROW(refine(target, target, {}, {}, 0), InvalidInput);
  RigidTransform nowhere;
  nowhere.translation.setConstant(kNaN);
  EXPECT_THROW(refine(target, target, nowhere), InvalidInput);
}

}  // namespace
}  // namespace corral
