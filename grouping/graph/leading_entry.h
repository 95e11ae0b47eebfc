// SPDX-License-Identifier: MIT
#pragma once

#include <unordered_map>
#include <utility>
#include <vector>

#include "grouping/graph/principal_eigenvector.h"

namespace corral {

/// Some nodes of a graph, whose edges weigh at most 1.
struct Subgraph {
  const GraphMatrix& matrix;
  const Eigen::VectorXd& takes_part;  ///< 1 for nodes of the subgraph, 0 for the others
  const Eigen::VectorXd& degrees;     ///< number of positive entries of each node within the subgraph
  double sum_of_squares;              ///< of the entries within the subgraph
  int count;                          ///< of its nodes
  bool is_binary;                     ///< no entries but 0 and 1
};

/// In which entries two rows of a matrix differ. Rows of bits are remembered by their zeros, of which the rows of large
/// entries hold few.
class RowDifferences {
 public:
  struct Term {
    int node;
    double weight;
  };
  /// Row i minus row j, within the subgraph; valid until the next call.
  const std::vector<Term>& between(const Subgraph& graph, int i, int j);
  int columns_read() const { return columns_read_; }  ///< so far
  void forget() { zeros_.clear(), remembered_ = 0; }

 private:
  const Indices& zeros(const Subgraph& graph, int node);
  void subtract_bits(const Subgraph& graph, const Indices& of_i, const Indices& of_j);

  std::unordered_map<int, Indices> zeros_;  ///< by node, those that left since among them
  std::size_t remembered_ = 0;
  int columns_read_ = 0;
  std::vector<Term> terms_;
  Eigen::VectorXd column_, other_column_;
};

/// The largest entry in the principal eigenvector x of a subgraph that loses nodes, known before the eigenvector is.
///
/// The proof needs no convergence. The squares of all eigenvalues add up to the squares of all entries, which bounds all but
/// the largest; so the residual of a vector y bounds its angle to x. With y = cos x + sin u, u a unit vector, M y = cos l x +
/// sin M u; and with d the difference of rows i and j of M
///
///   (M y)_i - (M y)_j = cos l (x_i - x_j) + sin d u         d (M y) = cos l^2 (x_i - x_j) + sin (M d) u
///
/// Either side decides which entry is larger where it exceeds sin |d| or sin |M d|. Rows i and j that are equal, but for what
/// they hold of one another, have equal entries.
///
/// A vector and its product stay a pair when a node leaves: its column is subtracted from the product. Only where the pair
/// does not prove enough it is multiplied again.
class LeadingEntry {
 public:
  /// To be improved from `start`, one number for each node.
  explicit LeadingEntry(Eigen::VectorXd start) { restart(std::move(start)); }
  void restart(Eigen::VectorXd start);

  /// A node leaves, of this column.
  void remove(int node, const Eigen::VectorXd& column);
  /// Nodes of this matrix leave.
  void remove(const Indices& nodes, const GraphMatrix& matrix);
  /// The nodes are numbered anew.
  void renumber(const Indices& nodes);

  /// The node of the largest entry, the first of those that are within `tie` of it; or kUncertain where a few rounded
  /// products do not prove which one that is.
  int find(const Subgraph& graph, double tie);
  static constexpr int kUncertain = -1;

 private:
  int improve(const Subgraph& graph, double tie);

  Eigen::VectorXd vector_, image_;  ///< M vector = image, for the nodes that remain; a vector of zeros: a start
  double image_norm_ = 0;           ///< when it was last used
  double rounding_ = 0;             ///< length of the error of the image
  RowDifferences differences_;
};

}  // namespace corral
