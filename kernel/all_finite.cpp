// SPDX-License-Identifier: MIT
#include "kernel/all_finite.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/all_finite.cpp"
#include <hwy/foreach_target.h>

#include "kernel/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

/// x - x is 0 for every finite number, and NaN stays NaN in sums. A multiple of 4 kLanes numbers.
HWY_FLATTEN double sum_of_differences(const double* numbers, Eigen::Index count) {
  Lanes sums[4] = {Lanes::fill(0), Lanes::fill(0), Lanes::fill(0), Lanes::fill(0)};
  for (Eigen::Index first = 0; first < count; first += 4 * kLanes)
    for (int k = 0; k < 4; ++k) {
      const Lanes number = Lanes::load(numbers + first + k * kLanes);
      sums[k] = sums[k] + (number - number);
    }
  return sum((sums[0] + sums[1]) + (sums[2] + sums[3]));
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(sum_of_differences);

bool all_finite(const double* numbers, Eigen::Index count) {
  const Eigen::Index end = count - count % (4 * kLanes);
  double rest = HWY_DYNAMIC_DISPATCH(sum_of_differences)(numbers, end);
  for (Eigen::Index i = end; i < count; ++i) rest += numbers[i] - numbers[i];
  return rest == 0;
}

}  // namespace corral
#endif
