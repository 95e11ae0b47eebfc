// SPDX-License-Identifier: MIT
#include "kernel/bounding_box.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/bounding_box.cpp"
#include <hwy/foreach_target.h>

#include "kernel/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

HWY_FLATTEN Extent extent_of(const double* numbers, Eigen::Index count) {
  Lanes least = Lanes::fill(numbers[0]), most = least;
  const Eigen::Index whole = count - count % kLanes;
  for (Eigen::Index i = 0; i < whole; i += kLanes) {
    const Lanes number = Lanes::load(numbers + i);
    least = smaller(least, number), most = larger(most, number);
  }
  Extent extent{smallest(least), largest(most)};
  for (Eigen::Index i = whole; i < count; ++i) {
    extent.low = std::min(extent.low, numbers[i]);
    extent.high = std::max(extent.high, numbers[i]);
  }
  return extent;
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(extent_of);

Extent extent_of(const double* numbers, Eigen::Index count) { return HWY_DYNAMIC_DISPATCH(extent_of)(numbers, count); }

BoundingBox bounding_box(const Points& points) {
  BoundingBox box;
  if (points.rows() == 0) return box;
  for (int axis = 0; axis < 3; ++axis) {
    const Extent extent = extent_of(points.col(axis).data(), points.rows());
    box.low(axis) = extent.low, box.high(axis) = extent.high;
  }
  return box;
}

}  // namespace corral
#endif
