// SPDX-License-Identifier: MIT
#include "tests/support/reference/spatial_order.h"

namespace corral::testing {
namespace {

/// Whether rows first .. last - 1 of an order are what the definition makes of them: cut across the longest side of their box,
/// so that both halves are whole shares, until none is larger than eight.
bool is_cut(const Points& points, const Indices& order, std::ptrdiff_t first, std::ptrdiff_t last,
            std::ptrdiff_t share) {
  while (last - first <= share && share > 8) share /= 8;
  if (last - first <= share) return true;
  const auto part = [&](std::ptrdiff_t from, std::ptrdiff_t to) {
    return Points(points(Indices(order.begin() + from, order.begin() + to), Eigen::all));
  };
  const std::ptrdiff_t middle = first + share * ((last - first + share - 1) / share / 2);
  const Points whole = part(first, last), lower = part(first, middle), upper = part(middle, last);
  const Eigen::RowVector3d sides = whole.colwise().maxCoeff() - whole.colwise().minCoeff();
  bool is_apart = false;  // along a longest side, of which there may be several
  for (int axis = 0; axis < 3; ++axis)
    is_apart |=
        sides(axis) >= sides.maxCoeff() - 1e-6 && lower.col(axis).maxCoeff() <= upper.col(axis).minCoeff() + 1e-6;
  return is_apart && is_cut(points, order, first, middle, share) && is_cut(points, order, middle, last, share);
}

}  // namespace

bool is_spatial_order(const Points& points, const Indices& order) {
  const auto count = static_cast<std::ptrdiff_t>(order.size());
  std::ptrdiff_t share = 8;
  while (share < (count + 7) / 8) share *= 8;
  return is_cut(points, order, 0, count, share);
}

}  // namespace corral::testing
