// SPDX-License-Identifier: MIT
#include "kernel/spatial_order.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "kernel/spatial_cuts.h"

namespace corral {

Indices spatial_order(const Points& points, const ParallelFor& parallel) {
  Eigen::AlignedBox3d box;
  Indices finite, rest;
  for (int row = 0; row < points.rows(); ++row) {
    const Eigen::Vector3d place = points.row(row).transpose();
    const bool is_finite = place.allFinite();
    (is_finite ? finite : rest).push_back(row);
    if (is_finite) box.extend(place);
  }
  const int count = static_cast<int>(finite.size());
  const Eigen::RowVector3d middle = (0.5 * box.min() + 0.5 * box.max()).transpose();
  const double reach = (0.5 * box.max() - 0.5 * box.min()).maxCoeff(), scale = reach > 1e-300 ? 1 / reach : 0;
  SpatialItems items(count);
  for (int i = 0; i < count; ++i) {
    const int row = finite[static_cast<std::size_t>(i)];
    items.set(i, scale * (points.row(row) - middle), row);
  }
  int share = kSpatialBranches;
  while (share < (count + kSpatialBranches - 1) / kSpatialBranches) share *= kSpatialBranches;
  divide(items, {0, count, share}, share);  // the root
  parallel((count + share - 1) / share, [&](int i) {
    const int first = i * share;
    divide(items, {first, std::min(count, first + share), share}, kSpatialBranches);
  });
  Indices rows;
  rows.reserve(static_cast<std::size_t>(points.rows()));
  for (int i = 0; i < count; ++i) rows.push_back(items.row(i));
  rows.insert(rows.end(), rest.begin(), rest.end());
  return rows;
}

}  // namespace corral
