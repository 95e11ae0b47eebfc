// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "kernel/surface/fpfh.h"
#include "kernel/surface/support.h"

namespace corral {

constexpr int kFpfhBins = 11;  ///< of each angle

/// S(p), the histogram of one vertex, as numbers of pairs: theta, alpha, phi. Plain form: reference_simple_histogram.
struct PairHistogram {
  std::int32_t bins[kFpfhSize] = {};
  std::int32_t pairs = 0;
};

/// Counts the pairs of a vertex with this normal and those around it, normals of length one or zero.
PairHistogram count_pairs(const Support& support, const Eigen::Vector3d& normal, FpfhForm form);

}  // namespace corral
