// SPDX-License-Identifier: MIT
#include "grouping/graph/principal_eigenvector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/matrices.h"

namespace corral {
namespace {

using testing::cliques;
using testing::dense_answer;
using testing::random_connected;

Eigen::VectorXd principal_eigenvector(const Eigen::MatrixXd& matrix) {
  return corral::principal_eigenvector(DenseGraph(matrix));
}

TEST(PrincipalEigenvector, EqualsTheDenseSolution) {
  for (const int size : {1, 2, 3, 10, 25, 60, 150})
    for (const double density : {0.02, 0.3, 1.0})
      for (const bool unit_diagonal : {false, true}) {
        if (size == 1 && !unit_diagonal) continue;
        const Eigen::MatrixXd matrix = random_connected(size, density, 7, unit_diagonal);
        const Eigen::VectorXd x = principal_eigenvector(matrix);
        EXPECT_LT((x - dense_answer(matrix)).cwiseAbs().maxCoeff(), 1e-9) << size << " " << density;
        EXPECT_NEAR(x.norm(), 1, 1e-12);
        EXPECT_GE(x.minCoeff(), 0);
      }
}

TEST(PrincipalEigenvector, EmptyMatrix) { EXPECT_EQ(principal_eigenvector(Eigen::MatrixXd(0, 0)).size(), 0); }

TEST(PrincipalEigenvector, BipartiteGraphDoesNotOscillate) {
  // The path 0 - 1 - 2 without diagonal has eigenvalues sqrt 2, 0, -sqrt 2; the first belongs to (1, sqrt 2, 1) / 2.
  Eigen::MatrixXd path(3, 3);
  path << 0, 1, 0, 1, 0, 1, 0, 1, 0;
  EXPECT_TRUE(principal_eigenvector(path).isApprox(Eigen::Vector3d(0.5, std::sqrt(0.5), 0.5), 1e-10));
}

TEST(PrincipalEigenvector, HeaviestPartTakesAll) {
  const Eigen::MatrixXd matrix = cliques({2, 4, 3});
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(9);
  expected.segment(2, 4).setConstant(0.5);
  EXPECT_LT((principal_eigenvector(matrix) - expected).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(PrincipalEigenvector, PartsMayBeInterleaved) {
  // 0 - 2 - 4 with weight 1 and 1 - 3 with weight 1: sqrt 2 beats 1.
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(5, 5);
  matrix(0, 2) = matrix(2, 0) = matrix(2, 4) = matrix(4, 2) = matrix(1, 3) = matrix(3, 1) = 1;
  Eigen::VectorXd expected(5);
  expected << 0.5, 0, std::sqrt(0.5), 0, 0.5;
  EXPECT_LT((principal_eigenvector(matrix) - expected).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(PrincipalEigenvector, EquallyHeavyPartsTheLowestIndexWins) {
  Eigen::MatrixXd matrix = cliques({3, 3});
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(6);
  expected.head(3).setConstant(1 / std::sqrt(3.0));
  for (const double difference : {0.0, 1e-11, -1e-11}) {  // agreement to 1e-9 relative is equality
    matrix.bottomRightCorner(3, 3).setConstant(1 + difference);
    EXPECT_LT((principal_eigenvector(matrix) - expected).cwiseAbs().maxCoeff(), 1e-12);
  }
  matrix.bottomRightCorner(3, 3).setConstant(1 + 1e-7);
  EXPECT_LT((principal_eigenvector(matrix) - expected.reverse()).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(PrincipalEigenvector, EqualPathsTheLowestIndexWins) {
  // 0 - 2 - 4 and 1 - 3 - 5: the row sums of the second exceed the eigenvalue 1 + sqrt 2 of the first.
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(6, 6);
  for (const int i : {0, 1, 2, 3}) matrix(i, i + 2) = matrix(i + 2, i) = 1;
  Eigen::VectorXd expected(6);
  expected << 0.5, 0, std::sqrt(0.5), 0, 0.5, 0;
  EXPECT_LT((principal_eigenvector(matrix) - expected).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(PrincipalEigenvector, NearlyEqualEigenvalues) {
  // Two cliques of 20 joined by one edge: the second eigenvalue is within 0.5 % of the first. The answer is symmetric.
  Eigen::MatrixXd matrix = cliques({20, 20});
  matrix(19, 20) = matrix(20, 19) = 1;
  const Eigen::VectorXd x = principal_eigenvector(matrix);
  EXPECT_LT((x - dense_answer(matrix)).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((x - x.reverse()).cwiseAbs().maxCoeff(), 1e-9);
  // A weak edge brings the two eigenvalues within 1e-7 relative of each other.
  matrix(19, 20) = matrix(20, 19) = 1e-5;
  const Eigen::VectorXd weak = principal_eigenvector(matrix);
  EXPECT_LT((weak - weak.reverse()).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(PrincipalEigenvector, AMatrixWithoutEntriesHasNone) {
  for (const int size : {1, 2, 5})
    EXPECT_TRUE(principal_eigenvector(Eigen::MatrixXd::Zero(size, size)).isZero(0)) << size;
}

TEST(PrincipalEigenvector, ScaleOfTheMatrixDoesNotMatter) {
  const Eigen::MatrixXd matrix = random_connected(30, 0.3, 5, true);
  const Eigen::VectorXd x = principal_eigenvector(matrix);
  for (const double scale : {1e-6, 1e6})
    EXPECT_LT((principal_eigenvector(scale * matrix) - x).cwiseAbs().maxCoeff(), 1e-9);
}

}  // namespace
}  // namespace corral
