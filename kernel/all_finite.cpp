// SPDX-License-Identifier: MIT
#include "kernel/all_finite.h"

#include "kernel/vectorized.h"

namespace corral {

// x - x is 0 for every finite number, and NaN stays NaN in sums.
bool all_finite(const double* numbers, Eigen::Index count) {
  double rest = 0, of_lanes = 0;
  const Eigen::Index end = count - count % (4 * kLanes);
  vectorized([&](auto kind) {
    using Lanes = typename decltype(kind)::Lanes;
    Lanes sums[4] = {Lanes::fill(0), Lanes::fill(0), Lanes::fill(0), Lanes::fill(0)};
    for (Eigen::Index first = 0; first < end; first += 4 * kLanes)
      for (int k = 0; k < 4; ++k) {
        const Lanes number = Lanes::load(numbers + first + k * kLanes);
        sums[k] = sums[k] + (number - number);
      }
    of_lanes = sum((sums[0] + sums[1]) + (sums[2] + sums[3]));
  });
  for (Eigen::Index i = end; i < count; ++i) rest += numbers[i] - numbers[i];
  return of_lanes + rest == 0;
}

}  // namespace corral
