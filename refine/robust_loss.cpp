// SPDX-License-Identifier: MIT
#include "refine/robust_loss.h"

#include <cmath>
#include <limits>

namespace corral {

LossValue evaluate_loss(const ScaledLoss& loss, double squared) {
  const double limit = loss.scale * loss.scale;
  const double u = squared / limit;
  switch (loss.loss) {
    case RobustLoss::None:
      break;
    case RobustLoss::Huber: {
      if (squared <= limit) break;
      const double weight = loss.scale / std::sqrt(squared);
      return {2 * loss.scale * std::sqrt(squared) - limit, weight, -weight / 2};
    }
    case RobustLoss::Cauchy: {
      const double weight = 1 / (1 + u);
      return {limit * std::log1p(u), weight, -u * weight * weight};
    }
    case RobustLoss::Tukey: {
      const double rest = u < 1 ? 1 - u : 0;
      return {u < 1 ? squared * (1 - u + u * u / 3) : limit / 3, rest * rest, -2 * u * rest};
    }
    case RobustLoss::GemanMcClure: {
      const double share = 1 / (1 + u);
      return {squared * share, share * share, -2 * u * share * share * share};
    }
  }
  return {squared, 1, 0};
}

double graduation_reach(RobustLoss loss) {
  switch (loss) {  // where rho'(r^2) + 2 r^2 rho''(r^2) changes its sign, in r / a
    case RobustLoss::Tukey:
      return std::sqrt(0.2);
    case RobustLoss::GemanMcClure:
      return std::sqrt(1 / 3.0);
    default:
      return std::numeric_limits<double>::infinity();
  }
}

}  // namespace corral
