// SPDX-License-Identifier: MIT
#include "grouping/graph/leading_entry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace corral {
namespace {

constexpr int kProducts = 8;           // most before the answer is uncertain
constexpr double kWorthAsking = 3e-2;  // the sine below which a proof is tried
constexpr double kMargin = 1e-9;       // for rounding of what is computed from the image
constexpr int kCompared = 4096;        // most comparisons of rows in one proof
constexpr double kRounding = 0x1p-52;  // of a difference or a quotient and what it came from
constexpr double kRoundings = 32;  // of an entry of an image made of products, and of the same entries of the products

/// A bound of the sine of the angle between a vector and the principal eigenvector, from its Rayleigh quotient and the
/// length of its residual; infinite if nothing is known.
///
/// The largest eigenvalue is at least the quotient v, the square of each other at most (sum of squares) - v^2. With a gap g
/// between the two, sine <= residual / g.
double sine_bound(double value, double residual, double sum_of_squares) {
  const double gap = value - std::sqrt(std::max(sum_of_squares * (1 + 1e-12) - value * value, 0.0));
  if (!(gap > 1e-3 * value)) return std::numeric_limits<double>::infinity();
  return (residual + 1e-13 * value) / gap;
}

/// What a unit vector and its product prove about the largest entry.
class Proof {
 public:
  Proof(const Subgraph& graph, const Eigen::VectorXd& image, RowDifferences& differences)
      : graph_(graph), image_(image), differences_(differences) {}

  int leader(const Eigen::VectorXd& vector, double rounding, double tie) {
    const double value = vector.dot(image_), residual = (image_ - value * vector).norm() + rounding;
    sine_ = sine_bound(value, residual, graph_.sum_of_squares);
    if (!(sine_ < kWorthAsking && vector.sum() > sine_ * std::sqrt(vector.size())))  // near x, not -x
      return LeadingEntry::kUncertain;
    value_ = value + residual;
    rounding_ = rounding;
    no_tie_ = tie * (1 + kMargin) * value_ + 2 * rounding;
    surely_tie_ = tie * (1 - kMargin - sine_ * sine_) * value - 2 * rounding;  // cos >= 1 - sine^2
    least_value_ = value;
    most_columns_ = differences_.columns_read() + 8 + graph_.count / 128;
    int first = 0, larger = 0;
    image_.maxCoeff(&larger);
    while (larger != kNobody) first = std::exchange(larger, kNobody), leader_ = lowest_of_largest(first, larger);
    return leader_;
  }

 private:
  enum class Order { Smaller, Tied, Larger, Unknown };
  static constexpr int kNobody = -1;

  /// The first of the nodes whose entries are those of `first`; or one whose entry is larger.
  int lowest_of_largest(int first, int& larger) {
    int leader = first;
    const double most_error = sine_ * std::sqrt(2.0 * graph_.count);
    for (int node = 0; node < image_.size(); ++node) {
      if (image_(first) - image_(node) > most_error + no_tie_ || node == first || !(graph_.takes_part(node) > 0))
        continue;
      const Order order = compare(node, first);
      if (order == Order::Larger) return larger = node;
      if (order == Order::Unknown) return LeadingEntry::kUncertain;
      if (order == Order::Tied) leader = std::min(leader, node);
    }
    return leader;
  }

  /// How the entry of a node compares with that of `first`.
  Order compare(int node, int first) {
    const double lead = image_(first) - image_(node), error = sine_ * std::sqrt(most_differences(first, node));
    if (lead > error + no_tie_) return Order::Smaller;
    if (std::abs(lead) + 2 * error <= surely_tie_) return Order::Tied;
    if (++compared_ > kCompared || differences_.columns_read() > most_columns_) return Order::Unknown;

    double squares = 0, others = 0, sum = 0, size = 0, product = 0, product_error = 0;
    for (const auto& [other, weight] : differences_.between(graph_, first, node)) {
      squares += weight * weight;
      others += other == first || other == node ? 0 : 1;
      sum += weight;
      size += std::abs(weight);
      product += weight * image_(other);
      product_error += std::abs(weight) * std::sqrt(row_bound(other));
    }
    if (lead > sine_ * std::sqrt(squares) + no_tie_) return Order::Smaller;
    if (others == 0 && sum == 0) return Order::Tied;  // they can change places
    if (graph_.is_binary) product_error += std::abs(sum) * std::sqrt(graph_.count);
    product_error = sine_ * product_error + size * rounding_;
    if (std::abs(product) + product_error <= surely_tie_ * least_value_) return Order::Tied;
    product_error += no_tie_ * value_;
    if (product > product_error) return Order::Smaller;
    return -product > product_error ? Order::Larger : Order::Unknown;
  }

  /// A bound of the sum of squares of the difference of two rows: all that they hold, or all zeros of bits.
  double most_differences(int i, int j) const {
    const double held = graph_.degrees(i) + graph_.degrees(j);
    return graph_.is_binary ? std::min(held, 2 * graph_.count - held) : held;
  }

  /// A bound of the sum of squares of a row of M, or of M - 1 where M is of bits.
  double row_bound(int node) const {
    return graph_.is_binary ? graph_.count - graph_.degrees(node) : graph_.degrees(node);
  }

  const Subgraph& graph_;
  const Eigen::VectorXd& image_;
  RowDifferences& differences_;
  double sine_ = 0, value_ = 0, least_value_ = 0, rounding_ = 0, no_tie_ = 0, surely_tie_ = 0;
  int compared_ = 0, most_columns_ = 0, leader_ = LeadingEntry::kUncertain;
};

struct Ritz {
  double value = 0;
  Eigen::VectorXd vector;
};

/// The largest eigenvalue of a symmetric tridiagonal matrix, and its eigenvector of some length.
///
/// p_k = x - a_k, p_i = x - a_i - b_i^2 / p_(i+1): x is the largest eigenvalue where p_1 = 0 and all others are positive.
/// There p_1 is concave, so that Newton's steps from below stay below; where it is not, the interval is halved.
Ritz largest_of_tridiagonal(const Eigen::VectorXd& a, const Eigen::VectorXd& b, Eigen::Index size) {
  Eigen::VectorXd p(size);
  double low = a.head(size).maxCoeff(), high = low + 2 * (size > 1 ? b.head(size - 1).maxCoeff() : 0), x = low;
  for (int step = 0; step < 100; ++step) {
    double slope = 1;
    p(size - 1) = x - a(size - 1);
    Eigen::Index i = size - 1;
    for (; i > 0 && p(i) > 0; --i) {
      const double ratio = b(i - 1) / p(i);
      p(i - 1) = x - a(i - 1) - b(i - 1) * ratio;
      slope = 1 + ratio * ratio * slope;
    }
    const bool is_below = i > 0 || p(0) < 0;
    (is_below ? low : high) = x;
    const double next = i > 0 ? 0.5 * (low + high) : x - p(0) / slope;
    if (i == 0 && std::abs(next - x) <= 1e-15 * std::abs(x)) break;
    x = next > low && next < high ? next : 0.5 * (low + high);
  }
  Ritz pair{x, Eigen::VectorXd(size)};
  pair.vector(0) = 1;
  for (Eigen::Index i = 1; i < size; ++i) pair.vector(i) = pair.vector(i - 1) * b(i - 1) / p(i);
  return pair;
}

}  // namespace

const Indices& RowDifferences::zeros(const Subgraph& graph, int node) {
  const auto [known, is_new] = zeros_.try_emplace(node);
  if (!is_new) return known->second;
  ++columns_read_;
  graph.matrix.get_column(node, column_);
  for (int other = 0; other < column_.size(); ++other)
    if (graph.takes_part(other) > 0 && !(column_(other) > 0)) known->second.push_back(other);
  remembered_ += known->second.size();
  return known->second;
}

void RowDifferences::subtract_bits(const Subgraph& graph, const Indices& of_i, const Indices& of_j) {
  const auto add = [&](int node, double weight) {
    if (graph.takes_part(node) > 0) terms_.push_back({node, weight});
  };
  auto i = of_i.begin(), j = of_j.begin();
  while (i != of_i.end() || j != of_j.end()) {
    if (j == of_j.end() || (i != of_i.end() && *i < *j))
      add(*i++, -1);
    else if (i == of_i.end() || *j < *i)
      add(*j++, 1);
    else
      ++i, ++j;
  }
}

const std::vector<RowDifferences::Term>& RowDifferences::between(const Subgraph& graph, int i, int j) {
  terms_.clear();
  if (graph.is_binary) {
    if (remembered_ > 16 * static_cast<std::size_t>(graph.matrix.size())) forget();
    const Indices& of_i = zeros(graph, i);  // another entry does not move it
    subtract_bits(graph, of_i, zeros(graph, j));
    return terms_;
  }
  columns_read_ += 2;
  graph.matrix.get_column(i, column_);
  graph.matrix.get_column(j, other_column_);
  for (int node = 0; node < column_.size(); ++node)
    if (graph.takes_part(node) > 0 && column_(node) != other_column_(node))
      terms_.push_back({node, column_(node) - other_column_(node)});
  return terms_;
}

void LeadingEntry::restart(Eigen::VectorXd start) {
  image_ = std::move(start);
  vector_ = Eigen::VectorXd::Zero(image_.size());
}

void LeadingEntry::remove(int node, const Eigen::VectorXd& column) {
  if (vector_(node) != 0) {
    image_ -= vector_(node) * column;
    rounding_ += kRounding * image_norm_;
  }
  vector_(node) = image_(node) = 0;
}

void LeadingEntry::remove(const Indices& nodes, const GraphMatrix& matrix) {
  Eigen::VectorXd leaving = Eigen::VectorXd::Zero(vector_.size()), product;
  leaving(nodes) = vector_(nodes);
  if (!leaving.isZero(0)) {
    matrix.multiply(leaving, product);
    image_ -= product;
    rounding_ += kRoundings * kRounding * image_norm_;
  }
  vector_(nodes).setZero();
  image_(nodes).setZero();
}

void LeadingEntry::renumber(const Indices& nodes) {
  vector_ = Eigen::VectorXd(vector_(nodes));
  image_ = Eigen::VectorXd(image_(nodes));
  differences_.forget();
}

int LeadingEntry::find(const Subgraph& graph, double tie) {
  const double length = vector_.norm();
  if (length > 0) {
    vector_ /= length, image_ /= length;
    image_norm_ = image_.norm();
    rounding_ = rounding_ / length + kRounding * image_norm_;
    const int leader = Proof(graph, image_, differences_).leader(vector_, rounding_, tie);
    if (leader != kUncertain) return leader;
  }
  return improve(graph, tie);
}

/// Lanczos iteration with vectors rounded to the precision of a fast product. The result does not rely on the recurrence but
/// on the product of the final vector, which is the same combination of products as the vector is of basis vectors.
int LeadingEntry::improve(const Subgraph& graph, double tie) {
  const Eigen::Index size = image_.size();
  Eigen::MatrixXd basis(size, kProducts), products(size, kProducts);
  Eigen::VectorXd diagonal(kProducts), off_diagonal(kProducts), next = image_.cwiseMax(0), product, projection;
  double norm = next.norm();
  if (!(norm > 0)) return kUncertain;
  for (int used = 1;; ++used) {
    const int last = used - 1;
    next /= norm;
    graph.matrix.round_and_multiply(next, product);
    product = product.cwiseProduct(graph.takes_part);
    if (last > 0) {  // removes the components along the others that rounding introduced, also from the product
      projection.noalias() = basis.leftCols(last).transpose() * next;
      next.noalias() -= basis.leftCols(last) * projection;
      product.noalias() -= products.leftCols(last) * projection;
    }
    norm = next.norm();
    basis.col(last) = next / norm;
    products.col(last) = product / norm;
    projection.noalias() = basis.leftCols(used).transpose() * products.col(last);
    diagonal(last) = projection(last);
    next = products.col(last);
    next.noalias() -= basis.leftCols(used) * projection;
    norm = off_diagonal(last) = next.norm();
    const Ritz pair = largest_of_tridiagonal(diagonal, off_diagonal, used);
    const double residual = norm * std::abs(pair.vector(last)) / pair.vector.norm();
    const bool ends = used == kProducts || !(norm > 1e-9 * pair.value);
    if (!ends && !(sine_bound(pair.value, residual, graph.sum_of_squares) < kWorthAsking)) continue;
    const double length = (basis.leftCols(used) * pair.vector).norm();
    vector_ = basis.leftCols(used) * pair.vector / length;
    image_ = products.leftCols(used) * pair.vector / length;
    image_norm_ = image_.norm();
    rounding_ =
        kRoundings * kRounding * (products.leftCols(used).cwiseAbs() * pair.vector.cwiseAbs()).maxCoeff() / length;
    const int leader = Proof(graph, image_, differences_).leader(vector_, rounding_, tie);
    if (ends || leader != kUncertain) return leader;
  }
}

}  // namespace corral
