// SPDX-License-Identifier: MIT
#include "kernel/surface/keypoints.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "kernel/error.h"
#include "kernel/number_text.h"
#include "kernel/surface/search/point_grid.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/surface/keypoints.cpp"
#include <hwy/foreach_target.h>

#include "kernel/surface/plane_fit-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
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
    parallel(block_count(grid_), [this](int block) { fit(block_of(block)); });
    fits_.solve_all(parallel);
    parallel(block_count(grid_), [this](int block) { respond(block_of(block)); });
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

  HWY_FLATTEN void fit(const Block& block) {
    std::int64_t neighbors = 0;
    PackedSlots<3> places;
    for (int cell = block.first_cell; cell < block.last_cell; ++cell) {
      places.collect({&grid_.x(), &grid_.y(), &grid_.z()}, around_.begin(cell), around_.end(cell));
      for (int slot = grid_.begin(cell); slot < grid_.end(cell); ++slot) {
        neighbors += fits_.fit(static_cast<std::size_t>(slot), grid_, places, squared_);
        if (neighbors > most_) count(neighbors);  // a crowd: to its end it would take long
      }
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

  HWY_FLATTEN void respond(const Block& block) {
    PackedSlots<6> places;  // and normals
    for (int cell = block.first_cell; cell < block.last_cell; ++cell) {
      places.collect({&grid_.x(), &grid_.y(), &grid_.z(), &fits_.nx, &fits_.ny, &fits_.nz}, around_.begin(cell),
                     around_.end(cell));
      for (int i = grid_.begin(cell); i < grid_.end(cell); ++i) {
        const auto slot = static_cast<std::size_t>(i);
        const Lanes zero = Lanes::fill(0);
        Lanes xx = zero, xy = zero, xz = zero, yy = zero, yz = zero, zz = zero;
        const double *nx = places[3], *ny = places[4], *nz = places[5];
        visit_within(places, grid_.x()[slot], grid_.y()[slot], grid_.z()[slot], squared_,
                     [&](auto inside, Lanes, Lanes, Lanes, int other) HWY_ATTR {
                       const Lanes a = select(inside, Lanes::load(nx + other), zero),
                                   b = select(inside, Lanes::load(ny + other), zero),
                                   c = select(inside, Lanes::load(nz + other), zero);
                       xx = xx + a * a, xy = xy + a * b, xz = xz + a * c;
                       yy = yy + b * b, yz = yz + b * c, zz = zz + c * c;
                     });
        response_[slot] = determinant({sum(xx), sum(xy), sum(xz), sum(yy), sum(yz), sum(zz)});
      }
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
class LocalMaxima {
 public:
  LocalMaxima(const PointGrid& grid, const CellNeighborhoods& around, const AlignedColumn& response, double radius)
      : grid_(grid), around_(around), response_(response), squared_(radius * radius) {}

  HWY_FLATTEN Indices find() const {
    Indices maxima;
    for (int cell = 0; cell < grid_.cells(); ++cell) {
      const int first = grid_.begin(cell), last = grid_.end(cell);
      int top = first;
      for (int slot = first; slot < last; ++slot)
        if (at(slot) > at(top)) top = slot;
      for (int slot = first; slot < last; ++slot)  // most are beaten by the top of their cell
        if (at(slot) >= kSmallestResponse && !is_beaten(slot, top) &&
            is_highest(slot, around_.begin(cell), around_.end(cell)))
          maxima.push_back(grid_.row(slot));
    }
    std::sort(maxima.begin(), maxima.end());
    return maxima;
  }

 private:
  double at(int slot) const { return response_[static_cast<std::size_t>(slot)]; }

  /// Whether another slot within the radius is higher, or as high with a lower row.
  bool is_beaten(int slot, int other) const {
    const auto i = static_cast<std::size_t>(slot), j = static_cast<std::size_t>(other);
    if (response_[j] < response_[i]) return false;
    const double x = grid_.x()[j] - grid_.x()[i], y = grid_.y()[j] - grid_.y()[i], z = grid_.z()[j] - grid_.z()[i];
    return x * x + y * y + z * z <= squared_ && (response_[j] > response_[i] || grid_.row(other) < grid_.row(slot));
  }

  /// Whether no slot of some ranges beats one. The range of its own cell comes first: most are beaten there.
  HWY_INLINE bool is_highest(int slot, const SlotRange* first, const SlotRange* last) const {
    const SlotRange* const home = std::find_if(first, last, [&](const SlotRange& range) { return slot < range.end; });
    if (beats(*home, slot)) return false;
    for (const SlotRange* range = first; range != last; ++range)
      if (range != home && beats(*range, slot)) return false;
    return true;
  }

  /// Whether a slot of a range beats another one.
  HWY_INLINE bool beats(const SlotRange& range, int slot) const {
    const auto own = static_cast<std::size_t>(slot);
    const Lanes response = Lanes::fill(response_[own]), x = Lanes::fill(grid_.x()[own]),
                y = Lanes::fill(grid_.y()[own]), z = Lanes::fill(grid_.z()[own]), squared = Lanes::fill(squared_);
    for (int i = range.begin; i < range.end; i += kLanes) {
      const auto at = static_cast<std::size_t>(i);
      const Lanes dx = Lanes::load(&grid_.x()[at]) - x, dy = Lanes::load(&grid_.y()[at]) - y,
                  dz = Lanes::load(&grid_.z()[at]) - z;
      unsigned left = bits(response <= Lanes::load(&response_[at])) & bits(dx * dx + dy * dy + dz * dz <= squared);
      for (; left != 0; left &= left - 1)  // those behind the range count as well
        if (is_beaten(slot, i + static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(left)))) return true;
    }
    return false;
  }

  const PointGrid& grid_;
  const CellNeighborhoods& around_;
  const AlignedColumn& response_;
  double squared_;
};

AlignedColumn respond(const PointGrid& grid, const CellNeighborhoods& around, double radius,
                      const ParallelFor& parallel) {
  return HarrisOperator(grid, around, radius).run(parallel);
}

Indices find_maxima(const PointGrid& grid, const CellNeighborhoods& around, const AlignedColumn& response,
                    double radius) {
  return LocalMaxima(grid, around, response, radius).find();
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(respond);
HWY_EXPORT(find_maxima);

Eigen::VectorXd harris_response(const Points& vertices, double radius, const ParallelFor& parallel) {
  require_positive("harris_response", "radius", radius);
  const PointGrid grid = PointGrid::for_radius(vertices, radius, 1);
  const CellNeighborhoods around(grid, 1);
  const AlignedColumn by_slot = HWY_DYNAMIC_DISPATCH(respond)(grid, around, radius, parallel);
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
  const AlignedColumn response = HWY_DYNAMIC_DISPATCH(respond)(grid, around, radius, parallel);
  keypoints.vertices = HWY_DYNAMIC_DISPATCH(find_maxima)(grid, around, response, radius);
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
#endif
