// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "kernel/correspondence_set.h"
#include "kernel/rigid_transform.h"

namespace corral {

/// Rigidity ratio of two matches from the distance of their points on either surface: min(a/b, b/a), in [0, 1]; 0 if a
/// distance is 0. 1 means the pair moves rigidly.
///
/// Source    [yang2017evaluation], [buch2014search].
inline double rigidity_ratio(double source_distance, double target_distance) {
  if (!(source_distance > 0) || !(target_distance > 0)) return 0;
  return std::min(source_distance / target_distance, target_distance / source_distance);
}

/// The two distances between rows i and j, in mesh units.
struct PairDistances {
  double source, target;
};
inline double point_distance(const Points& points, int i, int j) {
  const double x = points(i, 0) - points(j, 0), y = points(i, 1) - points(j, 1), z = points(i, 2) - points(j, 2);
  return std::sqrt(x * x + y * y + z * z);
}
inline PairDistances pair_distances(const CorrespondenceSet& matches, int i, int j) {
  return {point_distance(matches.source_points, i, j), point_distance(matches.target_points, i, j)};
}

/// d1/d2 of each match; NaN where the second nearest feature is absent or coincides (d2 <= 0). Needs both columns.
std::vector<double> feature_ratios(const CorrespondenceSet& matches);

/// Distinctiveness of each match, 1 - d1/d2: 0 where the ratio is NaN. Finite, also where d1/d2 is not.
///
/// Source    [yang2017evaluation] eq. (2), [lowe2004distinctive].
std::vector<double> ratio_scores(const std::vector<double>& ratios);

/// Lowe's test on one match: d2 > 0 and d1/d2 <= maximum_ratio (rounding makes 1 - d1/d2 >= 1 - maximum_ratio another test).
inline bool passes_ratio_test(double d1, double d2, double maximum_ratio) { return d2 > 0 && d1 / d2 <= maximum_ratio; }

/// The rows with a mark of 1; the others have 0.
Indices marked_rows(const std::vector<std::uint8_t>& marks);

/// The rigid motion that one match alone proposes by its two frames: R = L'^T L, t = p' - R p.
RigidTransform transform_from_frames(const CorrespondenceSet& matches, int row);

}  // namespace corral
