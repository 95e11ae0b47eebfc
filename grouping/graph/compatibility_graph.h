// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "grouping/columns/filter.h"
#include "grouping/graph/principal_eigenvector.h"
#include "kernel/correspondence_set.h"

namespace corral {

/// Which matches are compatible, as one bit for each ordered pair:
///
///   M_ij = [ r(i,j) >= similarity ],  M_ii = 1,   r the rigidity ratio
///
/// Eight columns share a byte. A product looks up each byte in tables of partial sums (the method of four Russians). Sums are
/// whole numbers and therefore exact: each number is a multiple of a power of two, small enough that no sum reaches 2^31.
///
/// No more bytes than a limit are stored, enough for 113,000 rows; the columns beyond are computed whenever they are needed. As
/// sums are exact, every result is the same to the last bit whatever the limit. A product costs the blocks whose numbers are
/// not all 0.
class CompatibilityGraph : public GraphMatrix {
 public:
  static constexpr double kMostStored = 0x1.8p30;

  /// `matches` must outlive the graph and what is restricted from it.
  CompatibilityGraph(const CorrespondenceSet& matches, double similarity, double most_stored = kMostStored);

  /// Bytes for so many rows.
  static double memory(int rows, double most_stored = kMostStored);

  int size() const override { return table_.rows(); }
  void multiply(const Eigen::VectorXd& from, Eigen::VectorXd& to) const override;
  void round_and_multiply(Eigen::VectorXd& numbers, Eigen::VectorXd& to) const override;
  Eigen::VectorXd degrees() const override;
  double sum_of_squares() const override { return degrees().sum(); }
  void get_column(int node, Eigen::VectorXd& column) const override;
  std::unique_ptr<GraphMatrix> restricted(const Indices& nodes) const override;
  void keep(const Indices& nodes) override;

 private:
  CompatibilityGraph(const CompatibilityGraph& whole, const Indices& nodes);
  void take_rows(const Indices& rows, const Indices& nodes);
  int take_blocks(const std::uint8_t* blocks, std::size_t stride, int count, const Indices& nodes);
  void compute_from(int block);
  void compute(int block, std::uint8_t* to) const;
  void decide(int row, int block, std::uint8_t undecided, std::uint8_t& certain) const;
  std::uint8_t* stored(int block) const { return &bytes_[static_cast<std::size_t>(block) * stride()]; }
  std::size_t stride() const { return static_cast<std::size_t>(table_.padded_rows()); }

  const CorrespondenceSet& matches_;
  double similarity_, most_stored_;  ///< the second in bytes
  Indices rows_;                     ///< of the table of matches, by node
  FilterTable table_;
  int blocks_stored_ = 0;                    ///< a multiple of kBlocksTogether
  mutable std::vector<std::uint8_t> bytes_;  ///< block of eight columns by block, one byte a row: column 8 block + k in
                                             ///< bit k; then those that were computed last, and what is possible in one
  mutable int computed_ = -1;                ///< the block computed last by get_column
};

}  // namespace corral
