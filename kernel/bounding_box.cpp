// SPDX-License-Identifier: MIT
#include "kernel/bounding_box.h"

#include <algorithm>

#include "kernel/vectorized.h"

namespace corral {

BoundingBox bounding_box(const Points& points) {
  BoundingBox box;
  if (points.rows() == 0) return box;
  vectorized([&](auto kind) {
    using Lanes = typename decltype(kind)::Lanes;
    const Eigen::Index whole = points.rows() - points.rows() % kLanes;
    for (int axis = 0; axis < 3; ++axis) {
      const double* const column = points.col(axis).data();
      Lanes least = Lanes::fill(column[0]), most = least;
      for (Eigen::Index row = 0; row < whole; row += kLanes) {
        const Lanes place = Lanes::load(column + row);
        least = smaller(least, place), most = larger(most, place);
      }
      box.low(axis) = smallest(least), box.high(axis) = largest(most);
      for (Eigen::Index row = whole; row < points.rows(); ++row) {
        box.low(axis) = std::min(box.low(axis), column[row]);
        box.high(axis) = std::max(box.high(axis), column[row]);
      }
    }
  });
  return box;
}

}  // namespace corral
