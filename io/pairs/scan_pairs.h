// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/pose/transform_file.h"

namespace corral {

/// A pair of scans in a list of KITTI's odometry benchmark: scan i of a sequence is mapped into scan j of another, or the same.
struct ScanPair {
  int source_sequence = 0, source = 0, target_sequence = 0, target = 0;
  StoredTransform target_from_source;
  std::optional<double> overlap;  ///< a share, where the list has it
};

/// Whether a text file begins as such a list does: "seq i seq_db j".
bool is_scan_list(const std::string& path);

/// The pairs of a list, in its order. Below the header, each line has seq i seq_db j, a 4x4 matrix row by row, and perhaps the
/// overlap. (The header of the published lists names 15 entries of the 16, so it is not counted.)
///
/// Source    the lists of the LiDAR-Registration-Benchmark (KITTI-10m and loop closures), described in its README.
/// Throws    IoError naming file and line: no such line, a pose that is not rigid, a pair twice.
std::vector<ScanPair> read_scan_list(const std::string& path);

}  // namespace corral
