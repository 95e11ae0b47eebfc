// SPDX-License-Identifier: MIT
#include "kernel/surface/resolution.h"

#include <cmath>

#include "kernel/error.h"
#include "kernel/surface/neighborhood.h"
#include "kernel/surface/topology.h"

namespace corral {

double point_resolution(const Points& vertices) {
  const Points distinct = distinct_points(vertices);
  if (distinct.rows() < 2)
    throw InvalidInput("point_resolution", "number of distinct vertices", std::to_string(distinct.rows()),
                       "at least 2 (resolution would be zero)");
  const PointIndex index(distinct);
  double sum = 0;
  for (Eigen::Index row = 0; row < distinct.rows(); ++row)
    sum += std::sqrt(index.nearest(distinct.row(row).transpose(), 2)[1].squared_distance);
  return sum / static_cast<double>(distinct.rows());
}

}  // namespace corral
