// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "grouping/principal_eigenvector.h"
#include "kernel/correspondence_set.h"

namespace corral {

/// Which matches are compatible, as one bit for each ordered pair:
///
///   M_ij = [ r(i,j) >= similarity ],  M_ii = 1,   r the rigidity ratio
///
/// Eight columns share a byte. A product looks up each byte in tables of partial sums (the method of four Russians). Sums are
/// whole numbers and therefore exact: each number is a multiple of a power of two, small enough that no sum reaches 2^31.
class CompatibilityGraph : public GraphMatrix {
 public:
  CompatibilityGraph(const CorrespondenceSet& matches, double similarity);

  /// Bytes for so many rows.
  static double memory(int rows);

  int size() const override { return size_; }
  void multiply(const Eigen::VectorXd& from, Eigen::VectorXd& to) const override;
  void round_and_multiply(Eigen::VectorXd& numbers, Eigen::VectorXd& to) const override;
  Eigen::VectorXd degrees() const override;
  double sum_of_squares() const override { return degrees().sum(); }
  void get_column(int node, Eigen::VectorXd& column) const override;
  std::unique_ptr<GraphMatrix> restricted(const Indices& nodes) const override;

 private:
  explicit CompatibilityGraph(int size);
  std::uint8_t* bytes(int block) { return &bytes_[static_cast<std::size_t>(block) * stride_]; }
  const std::uint8_t* bytes(int block) const { return &bytes_[static_cast<std::size_t>(block) * stride_]; }

  int size_;
  std::size_t stride_;               ///< rows, padded
  std::vector<std::uint8_t> bytes_;  ///< block of eight columns by block, one byte a row: column 8 block + k in bit k
};

}  // namespace corral
