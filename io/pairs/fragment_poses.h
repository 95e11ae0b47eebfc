// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace corral {

/// A pair of fragments in gt.log, as 3DMatch and Redwood publish it.
struct FragmentPair {
  int source = 0, target = 0;            ///< the pose of "i j n" maps fragment j, the source, into i
  std::optional<double> overlap_points;  ///< the first entry of the pair's matrix in gt.info: points that they share
};

/// The pairs of a gt.log, in its order; the poses are read by read_transform(log + ":source,target"). `info`: gt.info, whose
/// blocks are "i j n" with 6 lines of 6 numbers below; may be empty.
/// Throws    IoError naming file and line: what is no such block, a name that is no number, a pair twice.
std::vector<FragmentPair> read_fragment_pairs(const std::string& log, const std::string& info);

}  // namespace corral
