// SPDX-License-Identifier: MIT
#include "grouping/principal_eigenvector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "kernel/random.h"

namespace corral {
namespace {

/// Symmetric, entries 0 or in (0, 1); a chain of entries keeps it connected.
Eigen::MatrixXd random_connected(int size, double density, std::uint64_t seed, bool unit_diagonal) {
  RandomStream random(seed);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  for (int i = 0; i < size; ++i) {
    if (unit_diagonal) matrix(i, i) = 1;
    for (int j = 0; j < i; ++j)
      if (random.uniform() < density || j == i - 1) matrix(i, j) = matrix(j, i) = random.uniform(0.01, 1.0);
  }
  return matrix;
}

Eigen::VectorXd principal_eigenvector(const Eigen::MatrixXd& matrix) {
  return corral::principal_eigenvector(DenseGraph(matrix));
}

Eigen::VectorXd dense_answer(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  return solver.eigenvectors().rightCols<1>().cwiseAbs();
}

/// Unit diagonal and the ones of cliques of the given sizes, one after another.
Eigen::MatrixXd cliques(const std::vector<int>& sizes) {
  int total = 0;
  for (const int size : sizes) total += size;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(total, total);
  int first = 0;
  for (const int size : sizes) {
    matrix.block(first, first, size, size).setOnes();
    first += size;
  }
  return matrix;
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

/// leading_entry() of the nodes that take part.
int leading_entry(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& takes_part, double tie, Eigen::VectorXd start) {
  const Eigen::MatrixXd alive = takes_part.asDiagonal() * matrix * takes_part.asDiagonal();
  const Eigen::VectorXd degrees = (alive.array() > 0).cast<double>().rowwise().sum();
  return corral::leading_entry({DenseGraph(matrix), takes_part, degrees, alive.squaredNorm()}, tie, start);
}
int leading_entry(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& takes_part, double tie) {
  return leading_entry(matrix, takes_part, tie, takes_part);
}

/// The first node within a tie of the largest entry of a converged vector.
int first_of_largest(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& takes_part, double tie) {
  const Eigen::VectorXd x = dense_answer(takes_part.asDiagonal() * matrix * takes_part.asDiagonal());
  const auto is_largest = [&](double entry) { return entry >= x.maxCoeff() - tie; };
  return static_cast<int>(std::find_if(x.begin(), x.end(), is_largest) - x.begin());
}

TEST(LeadingEntry, IsThatOfTheConvergedVector) {
  int certain = 0, cases = 0;
  for (const int size : {2, 5, 20, 100})
    for (const bool weighted : {false, true})
      for (std::uint64_t seed = 1; seed <= 50; ++seed, ++cases) {
        Eigen::MatrixXd matrix = random_connected(size, 0.8, seed, true);
        if (!weighted) matrix = matrix.unaryExpr([](double entry) { return entry > 0 ? 1.0 : 0.0; });
        Eigen::VectorXd takes_part = Eigen::VectorXd::Ones(size);
        if (size > 5) takes_part(static_cast<int>(seed) % size) = takes_part(1) = 0;
        const int found = leading_entry(matrix, takes_part, 1e-9);
        if (found == kUncertain) continue;
        ++certain;
        EXPECT_EQ(found, first_of_largest(matrix, takes_part, 1e-9)) << size << " " << weighted << " " << seed;
      }
  EXPECT_GT(certain, cases * 3 / 4);
}

TEST(LeadingEntry, IsNotMisledByAStartThatFavorsTheSecond) {
  int misleading = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Eigen::MatrixXd matrix = random_connected(60, 0.9, seed, true);
    Eigen::VectorXd x = dense_answer(matrix);
    Eigen::Index first = 0, second = 0;
    x.maxCoeff(&first);
    Eigen::VectorXd others = x;
    others(first) = 0;
    others.maxCoeff(&second);
    x += 0.002 * (matrix.row(second) - matrix.row(first)).transpose().normalized();
    const Eigen::VectorXd product = matrix * x;
    misleading += product(second) > product(first);
    EXPECT_EQ(leading_entry(matrix, Eigen::VectorXd::Ones(60), 1e-9, x), first) << seed;
  }
  EXPECT_GT(misleading, 2);
}

TEST(LeadingEntry, WithinATieTheFirst) {
  // Nodes 0 to 8 alike but for the weights between 3 and 7, which make these two lead the others, 7 by a little more.
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Constant(9, 9, 0.5);
  matrix.diagonal().setOnes();
  matrix(7, 7) = 1 - 1e-7;
  matrix(3, 3) = 1 - 2e-7;
  matrix(3, 7) = matrix(7, 3) = 0.9;
  const Eigen::VectorXd all = Eigen::VectorXd::Ones(9), x = dense_answer(matrix);
  const double lead = x(7) - x(3);
  ASSERT_GT(lead, 1e-9);
  EXPECT_EQ(leading_entry(matrix, all, 0.99 * lead), 7);
  EXPECT_EQ(leading_entry(matrix, all, 1.01 * lead), 3);
}

TEST(LeadingEntry, OfEqualRowsTheFirst) {
  EXPECT_EQ(leading_entry(cliques({2, 4, 3}), Eigen::VectorXd::Ones(9), 1e-9), 2);
  Eigen::MatrixXd path = Eigen::MatrixXd::Ones(3, 3);
  path(0, 2) = path(2, 0) = 0;
  EXPECT_EQ(leading_entry(path, Eigen::Vector3d(1, 0, 1), 1e-9), kUncertain);  // two parts alike: not by this proof
  EXPECT_EQ(leading_entry(path, Eigen::Vector3d(1, 1, 1), 1e-9), 1);
}

TEST(LeadingEntry, TwoPartsOfAboutTheSameWeightAreNotDecided) {
  Eigen::MatrixXd matrix = cliques({20, 20});
  matrix(19, 20) = matrix(20, 19) = 1e-5;
  EXPECT_EQ(leading_entry(matrix, Eigen::VectorXd::Ones(40), 1e-9), kUncertain);
}

}  // namespace
}  // namespace corral
