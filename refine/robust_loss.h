// SPDX-License-Identifier: MIT
#pragma once

#include <array>

namespace corral {

/// The cost of a squared residual s. With the scale a (the unit of the residuals) and u = s / a^2:
///
///   none            s                                                        least squares
///   huber           s up to a^2, then 2 a sqrt(s) - a^2                      bounded influence, never zero
///   cauchy          a^2 log(1 + u)                                           decreasing influence
///   tukey           a^2 / 3 (1 - (1 - u)^3) up to a^2, then a^2 / 3          no influence beyond a
///   geman-mcclure   a^2 u / (1 + u)                                          influence decreases faster than cauchy's
///
/// Each is s for small s, never above s, and concave in s.
///
/// Source    [huber1964robust]; [beaton1974fitting] (tukey); [geman1987statistical].
enum class RobustLoss { None, Huber, Cauchy, Tukey, GemanMcClure };

/// As options name them, in the order of the enum.
constexpr std::array<const char*, 5> choice_names(RobustLoss) {
  return {"none", "huber", "cauchy", "tukey", "geman-mcclure"};
}

struct ScaledLoss {
  RobustLoss loss = RobustLoss::None;
  double scale = 1;  ///< a, above 0; not used by none
};

/// A loss at one squared residual s.
struct LossValue {
  double cost = 0;    ///< rho(s), in the unit of s
  double weight = 1;  ///< rho'(s), 0 .. 1: the influence of the residual relative to least squares
  double bend = 0;    ///< s rho''(s), at most 0
};
LossValue evaluate_loss(const ScaledLoss& loss, double squared);

/// Up to this residual, in units of the scale, a loss that is minimised by graduated non-convexity is convex in the
/// residual; infinite for the others.
double graduation_reach(RobustLoss loss);

}  // namespace corral
