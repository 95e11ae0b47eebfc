// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "kernel/correspondence_set.h"
#include "kernel/rigid_transform.h"

namespace corral {

/// What a pose T is worth by the residuals e_i = |T p_i - p'_i| of all rows below the tolerance tau; larger is better.
enum class PoseScore {
  Inliers,  ///< sum 1
  Mae,      ///< sum 1 - e/tau
  Mse,      ///< sum (1 - e/tau)^2
  Msac,     ///< sum 1 - (e/tau)^2, the truncated quadratic
  Oamae,    ///< for each distinct target point the mean of 1 - e/tau over its rows below tau; their sum
  Fs,       ///< of the rows that fit, the most that keep their distances to one of them within tau/2; see PoseChoice
};
inline std::array<const char*, 6> choice_names(PoseScore) { return {"inliers", "mae", "mse", "msac", "oamae", "fs"}; }

/// residuals[i] = |T p_i - p'_i| in mesh units.
void measure_residuals(const CorrespondenceSet& matches, const RigidTransform& target_from_source,
                       std::vector<double>& residuals);

/// The rows with a residual below the tolerance.
Indices rows_within(const std::vector<double>& residuals, double tolerance);

/// A score over the residuals of a table, in the order of its rows.
///
/// Source    [yang2023mutual] (inliers, mae, mse), [torr2000mlesac] (msac), the code of MAC++ (oamae).
class PoseScorer {
 public:
  PoseScorer(const CorrespondenceSet& matches, PoseScore score, double tolerance);

  /// Bytes for so many rows.
  static double memory(int rows) { return 4.0 * rows; }

  /// At most the number of rows below the tolerance. Fs counts as Inliers here: it is for a choice among the best.
  double operator()(const std::vector<double>& residuals) const;

 private:
  double one_per_target(const std::vector<double>& residuals) const;

  PoseScore score_;
  double tolerance_;
  Indices by_target_;  ///< Oamae: the rows, those of one target point behind each other
  std::vector<char> starts_target_;
};

}  // namespace corral
