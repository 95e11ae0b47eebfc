// SPDX-License-Identifier: MIT
#pragma once

#include <array>

namespace corral {

/// What a squared residual costs. With the scale a (the unit of the residuals) and u = s / a^2:
///
///   none            s                                                        least squares
///   huber           s up to a^2, then 2 a sqrt(s) - a^2                      a bounded pull, never none
///   cauchy          a^2 log(1 + u)                                           a pull that fades
///   tukey           a^2 / 3 (1 - (1 - u)^3) up to a^2, then a^2 / 3          no pull at all beyond a
///   geman-mcclure   a^2 u / (1 + u)                                          a pull that fades faster than cauchy's
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
  double scale = 1;  ///< a, above 0; none has no use for it
};

/// A loss at one squared residual s.
struct LossValue {
  double cost = 0;    ///< rho(s), in the unit of s
  double weight = 1;  ///< rho'(s), 0 .. 1: how much of its least-squares pull the residual keeps
  double bend = 0;    ///< s rho''(s), at most 0
};
LossValue evaluate_loss(const ScaledLoss& loss, double squared);

/// Up to this residual, in units of the scale, a loss that is met by graduated non-convexity is convex in the residual;
/// infinite for the others.
double graduation_reach(RobustLoss loss);

}  // namespace corral
