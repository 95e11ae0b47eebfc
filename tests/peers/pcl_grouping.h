// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "kernel/correspondence_set.h"

namespace corral::peers {

/// The groupers that the Point Cloud Library has, on one table. Its clouds are made once, in the constructor, so that the
/// methods can be timed; row i of the table is point i of both clouds. Lengths are in mesh units. Each method answers with
/// the rows of its one best group, ascending.
class PclGrouping {
 public:
  explicit PclGrouping(const CorrespondenceSet& matches);  ///< needs frames and feature distances; rounds to float
  ~PclGrouping();
  PclGrouping(const PclGrouping&) = delete;
  PclGrouping& operator=(const PclGrouping&) = delete;

  /// The random sample consensus inside PCL's correspondence rejector, with exactly that many poses counted: by default it
  /// would stop as soon as it is 99 % sure. Throws std::runtime_error if it stopped early all the same.
  Indices ransac(double threshold, int iterations) const;

  /// Cliques grown from seeds in order of feature distance, kept above 3 members, each filtered by a RANSAC of at most
  /// 10,000 iterations: another method than the star of the paper.
  Indices geometric_consistency(double size) const;

  /// Votes shared among neighbouring cells, the fullest filtered as above. Its accumulator is dense over the extent of the
  /// votes, and its centroid is the mean of the source points.
  Indices hough_voting(double bin_size) const;

 private:
  struct Clouds;
  std::unique_ptr<Clouds> clouds_;
};

}  // namespace corral::peers
