// SPDX-License-Identifier: MIT
#include "kernel/surface/uniform.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "kernel/error.h"
#include "kernel/surface/search/point_grid.h"

namespace corral {

Keypoints detect_uniform(const Points& vertices, double resolution, const UniformOptions& options) {
  require_positive("detect_uniform", "resolution", resolution);
  validate_options(options, "detect_uniform");
  const PointGrid grid(vertices, options.spacing_pr * resolution);
  Keypoints keypoints;
  for (int cell = 0; cell < grid.cells(); ++cell) {
    std::pair<double, int> nearest{std::numeric_limits<double>::infinity(), 0};
    for (int slot = grid.begin(cell); slot < grid.end(cell); ++slot)
      nearest = std::min(nearest, {grid.from_middle(slot), grid.row(slot)});
    keypoints.vertices.push_back(nearest.second);
  }
  std::sort(keypoints.vertices.begin(), keypoints.vertices.end());
  keypoints.candidates = static_cast<int>(vertices.rows());
  return keypoints;
}

}  // namespace corral
