// SPDX-License-Identifier: MIT
#include "grouping/graph/leading_entry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "tests/support/matrices.h"

namespace corral {
namespace {

using testing::cliques;
using testing::dense_answer;
using testing::random_connected;

constexpr int kUncertain = LeadingEntry::kUncertain;

/// The nodes that take part, as LeadingEntry sees them.
class Part {
 public:
  Part(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& takes_part)
      : graph_(matrix), takes_part_(takes_part), alive_(takes_part.asDiagonal() * matrix * takes_part.asDiagonal()) {
    degrees_ = (alive_.array() > 0).cast<double>().rowwise().sum();
    is_binary_ = (matrix.array() == 0 || matrix.array() == 1).all();
  }
  Subgraph graph() const {
    return {graph_, takes_part_, degrees_, alive_.squaredNorm(), static_cast<int>(takes_part_.sum()), is_binary_};
  }

 private:
  DenseGraph graph_;
  Eigen::VectorXd takes_part_, degrees_;
  Eigen::MatrixXd alive_;
  bool is_binary_;
};

int leading_entry(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& takes_part, double tie, Eigen::VectorXd start) {
  return LeadingEntry(std::move(start)).find(Part(matrix, takes_part).graph(), tie);
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

/// Counts its products.
class CountedGraph : public DenseGraph {
 public:
  using DenseGraph::DenseGraph;
  void round_and_multiply(Eigen::VectorXd& numbers, Eigen::VectorXd& to) const override {
    ++products;
    DenseGraph::round_and_multiply(numbers, to);
  }
  mutable int products = 0;
};

// Nodes leave one at a time; the pair of a vector and its product follows them.
TEST(LeadingEntry, IsKnownWhileNodesLeave) {
  int certain = 0, cases = 0, products = 0;
  for (const bool weighted : {false, true})
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      constexpr int kSize = 120;
      Eigen::MatrixXd matrix = random_connected(kSize, 0.9, seed, true);
      if (!weighted) matrix = matrix.unaryExpr([](double entry) { return entry > 0 ? 1.0 : 0.0; });
      CountedGraph counted(matrix);
      RandomStream random(seed);
      LeadingEntry leading(Eigen::VectorXd::Ones(kSize));
      Eigen::VectorXd takes_part = Eigen::VectorXd::Ones(kSize), column;
      for (int left = kSize; left > 40; --left, ++cases) {
        const Part part(matrix, takes_part);
        const Subgraph alive = part.graph();
        const int found = leading.find(
            {counted, takes_part, alive.degrees, alive.sum_of_squares, alive.count, alive.is_binary}, 1e-9);
        if (found != kUncertain) {
          ++certain;
          EXPECT_EQ(found, first_of_largest(matrix, takes_part, 1e-9)) << weighted << " " << seed << " " << left;
        }
        int node = 0;
        do node = static_cast<int>(random.uniform() * kSize);
        while (!(takes_part(node) > 0));
        counted.get_column(node, column);
        leading.remove(node, column);
        takes_part(node) = 0;
      }
      products += counted.products;
    }
  EXPECT_GT(certain, cases * 9 / 10);
  EXPECT_LT(products, cases * 3 / 2);  // without the pair at least two each
}

TEST(LeadingEntry, IsKnownAfterManyNodesLeaveTogether) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    constexpr int kSize = 120;
    const Eigen::MatrixXd matrix =
        random_connected(kSize, 0.9, seed, true).unaryExpr([](double entry) { return entry > 0 ? 1.0 : 0.0; });
    const CountedGraph counted(matrix);
    Eigen::VectorXd takes_part = Eigen::VectorXd::Ones(kSize);
    LeadingEntry leading(takes_part);
    const auto find = [&] {
      const Part part(matrix, takes_part);
      const Subgraph alive = part.graph();
      return leading.find({counted, takes_part, alive.degrees, alive.sum_of_squares, alive.count, alive.is_binary},
                          1e-9);
    };
    ASSERT_EQ(find(), first_of_largest(matrix, takes_part, 1e-9)) << seed;
    Indices leaving;
    for (int node = static_cast<int>(seed); node < kSize; node += 7) leaving.push_back(node);
    takes_part(leaving).setZero();
    leading.remove(leaving, counted);
    EXPECT_EQ(find(), first_of_largest(matrix, takes_part, 1e-9)) << seed;
  }
}

// What decides is whether a lead exceeds the tie, however little.
TEST(LeadingEntry, LeadsNearATieAreDecided) {
  const Eigen::MatrixXd matrix =
      random_connected(200, 0.9, 3, true).unaryExpr([](double entry) { return entry > 0 ? 1.0 : 0.0; });
  const Eigen::VectorXd all = Eigen::VectorXd::Ones(200);
  const Eigen::VectorXd x = dense_answer(matrix);
  Eigen::Index first = 0;
  for (Eigen::Index node = 0; node < 200; ++node)
    if (x(node) > x(first)) first = node;
  Eigen::Index second = first == 0;
  for (Eigen::Index node = 0; node < 200; ++node)
    if (node != first && x(node) > x(second)) second = node;
  const double lead = x(first) - x(second);
  ASSERT_GT(lead, 1e-6);
  EXPECT_EQ(leading_entry(matrix, all, lead * (1 - 1e-4)), first);
  EXPECT_EQ(leading_entry(matrix, all, lead * (1 + 1e-4)), std::min(first, second));
}

TEST(LeadingEntry, NodesThatCanChangePlacesAreAlike) {
  // Nodes 1 and 4 are compatible with all but each other, the others with all but two: the rows of 1 and 4 differ, and yet
  // their entries are equal.
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Ones(6, 6);
  for (const auto& [i, j] : {std::pair(1, 4), {0, 2}, {0, 3}, {2, 5}, {3, 5}}) matrix(i, j) = matrix(j, i) = 0;
  EXPECT_EQ(leading_entry(matrix, Eigen::VectorXd::Ones(6), 1e-9), 1);
}

}  // namespace
}  // namespace corral
