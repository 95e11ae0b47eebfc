// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "kernel/types.h"

namespace corral {

/// How the two classes of scores are separated.
enum class OtsuRule {
  Exact,    ///< every gap between neighbouring values is tried
  Bins100,  ///< histogram of 100 equal bins between the smallest and the largest score
  Covis,    ///< histogram of round(sqrt n) bins over [0, 1]
};
constexpr std::array<const char*, 3> choice_names(OtsuRule) { return {"exact", "bins100", "covis"}; }

/// Rows whose score lies in the upper of the two classes that maximise the variance between them, ascending.
///
///   maximise  n1 n2 (m1 - m2)^2    over all ways to cut the sorted scores in two (sizes n, means m)
///
/// exact     the threshold is the midpoint of the best gap (ties, to 1e-12: the lowest gap); accepts score >= threshold.
/// bins100   the threshold is the lower edge of the last bin of the lower class, so that bin is accepted too.
/// covis     the threshold is index / (bins - 1), index the last bin of the lower class; accepts score > threshold.
///
/// All scores equal (for the histograms: all in one bin): all rows. covis puts scores outside [0, 1] into the end bins.
/// Source    [otsu1979threshold]; bins100 after the program of [yang2017evaluation], covis of [buch2014search].
/// Departs   bins100 subtracts the smallest score before it indexes a bin (the program it follows does not, and so shifts
///           every bin when that score is not 0).
/// Throws    InvalidInput if a score is not finite.
Indices select_by_otsu(const std::vector<double>& scores, OtsuRule rule);

/// The threshold of bins100; of equal scores that score, of none 0.
double otsu_bins100_threshold(const std::vector<double>& scores);

/// Peak memory in bytes for this many scores: the result as it grows, and for the exact rule a sorted copy and the classes.
constexpr double otsu_memory(int scores, OtsuRule rule) {
  return (rule == OtsuRule::Exact ? 72.0 : 16.0) * scores + 4096;
}

}  // namespace corral
