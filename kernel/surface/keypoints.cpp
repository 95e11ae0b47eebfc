// SPDX-License-Identifier: MIT
#include "kernel/surface/keypoints.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "kernel/error.h"
#include "kernel/number_text.h"
#include "kernel/surface/plane_fit.h"
#include "kernel/surface/point_grid.h"

namespace corral {
namespace {

constexpr double kSmallestResponse = 1e-9;
constexpr std::int64_t kLargestMeanNeighborhood = 500;
constexpr std::int64_t kAlwaysAccepted = 20000000;  // neighbours in all
constexpr int kCellsPerBlock = 256;

int block_count(const PointGrid& grid) { return (grid.cells() + kCellsPerBlock - 1) / kCellsPerBlock; }

/// The response of every slot, in two passes over the neighbourhoods of all of them.
class HarrisOperator {
 public:
  HarrisOperator(const PointGrid& grid, const CellNeighborhoods& around, double radius)
      : grid_(grid),
        around_(around),
        squared_(radius * radius),
        most_(std::max(kAlwaysAccepted, kLargestMeanNeighborhood * grid.size())),
        fits_(grid.size()),
        response_(grid.x().size(), 0.0) {}

  AlignedColumn run(const ParallelFor& parallel) {
    parallel(block_count(grid_), [this](int block) {
      vectorized([&](auto kind) { fit<typename decltype(kind)::Lanes>(block_of(block)); });
    });
    fits_.solve_all(parallel);
    parallel(block_count(grid_), [this](int block) {
      vectorized([&](auto kind) { respond<typename decltype(kind)::Lanes>(block_of(block)); });
    });
    return std::move(response_);
  }

 private:
  struct Block {
    int first_cell, last_cell;
  };
  Block block_of(int block) const {
    const int first = block * kCellsPerBlock, last = std::min(grid_.cells(), first + kCellsPerBlock);
    return {first, last};
  }

  template <class Lanes>
  CORRAL_INLINE void fit(const Block& block) {
    std::int64_t neighbors = 0;
    for (int cell = block.first_cell; cell < block.last_cell; ++cell)
      for (int slot = grid_.begin(cell); slot < grid_.end(cell); ++slot) {
        const auto i = static_cast<std::size_t>(slot);
        neighbors += fits_.fit<Lanes>(i, grid_, around_.begin(cell), around_.end(cell), i, squared_);
        if (neighbors > most_) count(neighbors);  // a crowd: to its end it would take long
      }
    count(neighbors);
  }

  /// Refuses a radius that holds so many vertices that it cannot be meant.
  void count(std::int64_t neighbors) {
    if ((neighbors_ += neighbors) > most_)
      throw InvalidInput("detect_harris", "keypoint radius",
                         to_text(std::sqrt(squared_)) + " mesh units, which holds over " +
                             std::to_string(kLargestMeanNeighborhood) + " vertices on average",
                         "a radius that holds about 30 (is the resolution in the unit of this mesh, or do many "
                         "vertices share one place?)");
  }

  template <class Lanes>
  CORRAL_INLINE void respond(const Block& block) {
    for (int cell = block.first_cell; cell < block.last_cell; ++cell)
      for (int i = grid_.begin(cell); i < grid_.end(cell); ++i) {
        const auto slot = static_cast<std::size_t>(i);
        const Lanes zero = Lanes::fill(0);
        Lanes xx = zero, xy = zero, xz = zero, yy = zero, yz = zero, zz = zero;
        visit_within<Lanes>(grid_, around_.begin(cell), around_.end(cell), grid_.x()[slot], grid_.y()[slot],
                            grid_.z()[slot], squared_, [&](auto inside, Lanes, Lanes, Lanes, std::size_t other) {
                              const Lanes a = select(inside, Lanes::load(&fits_.nx[other]), zero),
                                          b = select(inside, Lanes::load(&fits_.ny[other]), zero),
                                          c = select(inside, Lanes::load(&fits_.nz[other]), zero);
                              xx = xx + a * a, xy = xy + a * b, xz = xz + a * c;
                              yy = yy + b * b, yz = yz + b * c, zz = zz + c * c;
                            });
        response_[slot] = determinant({sum(xx), sum(xy), sum(xz), sum(yy), sum(yz), sum(zz)});
      }
  }

  /// det of the mean: unit vectors have as many in the sum as its trace says.
  static double determinant(const Moments<double>& m) {
    const double trace = m.xx + m.yy + m.zz;
    if (!(trace > 0)) return 0;
    return (m.xx * (m.yy * m.zz - m.yz * m.yz) - m.xy * (m.xy * m.zz - m.yz * m.xz) +
            m.xz * (m.xy * m.yz - m.yy * m.xz)) /
           (trace * trace * trace);
  }

  const PointGrid& grid_;
  const CellNeighborhoods& around_;
  double squared_;
  std::int64_t most_;  // neighbours in all
  PlaneFits fits_;
  AlignedColumn response_;
  std::atomic<std::int64_t> neighbors_{0};
};

/// The rows of the slots that have the largest value within a radius, and at least the smallest accepted one.
Indices local_maxima(const PointGrid& grid, const CellNeighborhoods& around, const AlignedColumn& response,
                     double radius) {
  Indices maxima;
  const double squared = radius * radius;
  for (int cell = 0; cell < grid.cells(); ++cell) {
    const auto first = static_cast<std::size_t>(grid.begin(cell)), last = static_cast<std::size_t>(grid.end(cell));
    if (!(*std::max_element(&response[first], &response[last]) >= kSmallestResponse)) continue;
    const auto beaten_by = [&](std::size_t slot, std::size_t other) {
      if (response[other] < response[slot]) return false;
      const double x = grid.x()[other] - grid.x()[slot], y = grid.y()[other] - grid.y()[slot],
                   z = grid.z()[other] - grid.z()[slot];
      if (!(x * x + y * y + z * z <= squared)) return false;
      return response[other] > response[slot] || grid.row(static_cast<int>(other)) < grid.row(static_cast<int>(slot));
    };
    const auto survives = [&](std::size_t slot) {
      for (std::size_t other = first; other < last; ++other)  // the nearest first: most are beaten there
        if (beaten_by(slot, other)) return false;
      for (const SlotRange* range = around.begin(cell); range != around.end(cell); ++range)
        for (auto other = static_cast<std::size_t>(range->begin); other < static_cast<std::size_t>(range->end); ++other)
          if (beaten_by(slot, other)) return false;
      return true;
    };
    for (std::size_t slot = first; slot < last; ++slot)
      if (response[slot] >= kSmallestResponse && survives(slot)) maxima.push_back(grid.row(static_cast<int>(slot)));
  }
  std::sort(maxima.begin(), maxima.end());
  return maxima;
}

}  // namespace

Eigen::VectorXd harris_response(const Points& vertices, double radius, const ParallelFor& parallel) {
  require_positive("harris_response", "radius", radius);
  const PointGrid grid = PointGrid::for_radius(vertices, radius, 1);
  const CellNeighborhoods around(grid, 1);
  const AlignedColumn by_slot = HarrisOperator(grid, around, radius).run(parallel);
  Eigen::VectorXd response(vertices.rows());
  for (int slot = 0; slot < grid.size(); ++slot) response(grid.row(slot)) = by_slot[static_cast<std::size_t>(slot)];
  return response;
}

Keypoints detect_harris(const Points& vertices, double resolution, const HarrisOptions& options,
                        const ParallelFor& parallel) {
  require_positive("detect_harris", "resolution", resolution);
  require_positive("detect_harris", "radius_pr", options.radius_pr);
  const double radius = options.radius_pr * resolution;
  const PointGrid grid = PointGrid::for_radius(vertices, radius, 1);
  const CellNeighborhoods around(grid, 1);
  Keypoints keypoints;
  keypoints.vertices = local_maxima(grid, around, HarrisOperator(grid, around, radius).run(parallel), radius);
  keypoints.candidates = static_cast<int>(keypoints.vertices.size());
  return keypoints;
}

Keypoints detect_uniform(const Points& vertices, double resolution, double spacing_pr) {
  require_positive("detect_uniform", "resolution", resolution);
  require_positive("detect_uniform", "spacing_pr", spacing_pr);
  const PointGrid grid(vertices, spacing_pr * resolution);
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
