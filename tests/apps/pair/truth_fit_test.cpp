// SPDX-License-Identifier: MIT
#include "apps/pair/truth_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "kernel/random.h"
#include "kernel/surface/mesh/perturbation.h"
#include "kernel/surface/search/resolution.h"
#include "tests/support/meshes.h"

namespace corral {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A surface and its moved copy, with what a truth of theirs is found to be.
struct MovedPair {
  Mesh source = testing::bumpy_sphere(4, 2);
  RigidTransform truth = random_motion(source, 5);
  Mesh target = move_mesh(source, truth);

  TruthFit fit(const RigidTransform& motion) const {
    return fit_truth(source, target, motion, point_spacing(source.vertices), point_spacing(target.vertices));
  }
};

TEST(TruthFit, TheTrueOneFits) {
  const MovedPair pair;
  const TruthFit fit = pair.fit(pair.truth);
  EXPECT_EQ(fit.verdict, TruthFit::Fits);
  EXPECT_TRUE(fit.belongs());
  EXPECT_EQ(fit.text(), "");
  EXPECT_EQ(fit.given.share, 1);
}

TEST(TruthFit, NamesAnInverseWhicheverSideIsTheCoarser) {
  MovedPair pair;
  for (int side = 0; side < 3; ++side) {
    if (side > 0) (side == 1 ? pair.source : pair.target) = thin_mesh(side == 1 ? pair.source : pair.target, 0.4, 1);
    const TruthFit fit = pair.fit(pair.truth.inverse());
    EXPECT_EQ(fit.verdict, TruthFit::Inverted) << side;
    EXPECT_FALSE(fit.belongs());
    EXPECT_THAT(fit.text(), StartsWith("the truth fits inverted: 100 % within 2 pr, median ")) << side;
    EXPECT_THAT(fit.text(), HasSubstr("as given nothing within 2 pr")) << side;
  }
}

TEST(TruthFit, SwappedMeshesAreAnInverse) {
  const MovedPair pair;
  const PointSpacing spacing = point_spacing(pair.source.vertices);
  EXPECT_EQ(fit_truth(pair.target, pair.source, pair.truth, spacing, spacing).verdict, TruthFit::Inverted);
}

TEST(TruthFit, NamesTheFactorOfATranslationInOtherUnits) {
  const MovedPair pair;
  for (const double factor : {0.001, 1000.0, 0.01, 100.0, 0.1, 10.0}) {
    const TruthFit fit = pair.fit({pair.truth.rotation, pair.truth.translation / factor});
    ASSERT_EQ(fit.verdict, TruthFit::OtherUnits) << factor;
    EXPECT_EQ(fit.factor, factor);
    EXPECT_THAT(fit.name(), StartsWith("translation times "));
  }
}

TEST(TruthFit, NamesAnInverseInOtherUnitsAndATransposedRotation) {
  MovedPair pair;
  const RigidTransform inverse = pair.truth.inverse();
  for (const double factor : {0.001, 1000.0}) {
    const TruthFit fit = pair.fit({inverse.rotation, inverse.translation / factor});
    EXPECT_EQ(fit.verdict, TruthFit::Inverted);
    EXPECT_EQ(fit.factor, factor);
    EXPECT_THAT(fit.text(), HasSubstr("inverted, with its translation multiplied by "));
  }
  pair.source.vertices.col(0) *= 3;
  pair.source.vertices.col(1) *= 2;
  pair.truth = {Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix(), {9, -4, 2}};
  pair.target = move_mesh(pair.source, pair.truth);
  for (int side = 0; side < 2; ++side) {
    if (side == 1) pair.source = thin_mesh(pair.source, 0.4, 1), pair.target = thin_mesh(pair.target, 0.9, 1);
    EXPECT_EQ(pair.fit({pair.truth.rotation.transpose(), pair.truth.translation}).name(), "transposed") << side;
  }
}

TEST(TruthFit, IdentityAndTheTruthOfAnotherPairAreMisplaced) {
  const MovedPair pair;
  EXPECT_EQ(pair.fit({}).verdict, TruthFit::Misplaced);
  for (std::uint64_t seed = 10; seed < 20; ++seed)
    EXPECT_EQ(pair.fit(random_motion(pair.source, seed)).verdict, TruthFit::Misplaced) << seed;
}

TEST(TruthFit, APoseThatCrossesTheSurfaceIsMisplacedThoughManyPointsAreClose) {
  const Mesh mesh = testing::bumpy_sphere(4, 3);
  const PointSpacing spacing = point_spacing(mesh.vertices);
  RandomStream random(4);
  int close = 0;
  for (int i = 0; i < 30; ++i) {
    const RigidTransform wrong{random.rotation(), Eigen::Vector3d(0.9 + 0.4 * random.uniform(), 0, 0)};
    const TruthFit fit = fit_truth(mesh, mesh, wrong, spacing, spacing);
    close += fit.given.share >= 0.02;
    EXPECT_FALSE(fit.belongs()) << i << ": " << fit.given.share;
  }
  EXPECT_GT(close, 20) << "the share alone does not tell";
}

TEST(TruthFit, SurfacesSomePrApartFitLoosely) {
  const MovedPair pair;
  const double pr = point_resolution(pair.target.vertices);
  Mesh thicker = pair.target;  // 1.4 pr outside, as a coat of paint
  const Eigen::RowVector3d middle = thicker.vertices.colwise().mean();
  for (int row = 0; row < thicker.vertices.rows(); ++row)
    thicker.vertices.row(row) += 1.4 * pr * (thicker.vertices.row(row) - middle).normalized();
  const TruthFit fit =
      fit_truth(pair.source, thicker, pair.truth, point_spacing(pair.source.vertices), point_spacing(thicker.vertices));
  EXPECT_EQ(fit.verdict, TruthFit::Loose);
  EXPECT_TRUE(fit.belongs());
  EXPECT_THAT(fit.text(), StartsWith("the truth fits loosely: "));
}

TEST(TruthFit, ATruthThatIsItsOwnInverseFits) {
  const Mesh mesh = testing::bumpy_sphere(4, 2);
  const PointSpacing spacing = point_spacing(mesh.vertices);
  EXPECT_EQ(fit_truth(mesh, mesh, {}, spacing, spacing).verdict, TruthFit::Fits);
  const Mesh ball = testing::icosphere(4);  // any turn fits
  EXPECT_TRUE(fit_truth(ball, ball, {RandomStream(3).rotation(), Eigen::Vector3d::Zero()}, point_spacing(ball.vertices),
                        point_spacing(ball.vertices))
                  .belongs());
}

TEST(TruthFit, APartOfTheSurfaceIsEnough) {
  const MovedPair pair;
  std::vector<int> right;  // a tenth of the target, by one coordinate
  Eigen::VectorXd x = pair.target.vertices.col(0);
  std::sort(x.begin(), x.end());
  for (int row = 0; row < pair.target.vertices.rows(); ++row)
    if (pair.target.vertices(row, 0) < x(x.size() / 10)) right.push_back(row);
  const Mesh part{pair.target.vertices(right, Eigen::all), {}};
  const PointSpacing spacing = point_spacing(pair.source.vertices);
  EXPECT_EQ(fit_truth(pair.source, part, pair.truth, spacing, spacing).verdict, TruthFit::Fits);
  EXPECT_FALSE(fit_truth(pair.source, part, pair.truth.inverse(), spacing, spacing).belongs());
}

}  // namespace
}  // namespace corral
