// SPDX-License-Identifier: MIT
#include "kernel/surface/search/resolution.h"

#include <limits>
#include <utility>

#include "kernel/surface/search/mean_nearest.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/surface/search/resolution.cpp"
#include <hwy/foreach_target.h>

#include "kernel/surface/search/nearest_sweep-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Squared distance of a slot to the nearest point in another place around it; infinite if there is none.
HWY_INLINE double nearest_other(const PointGrid& grid, const PackedSlots<3>& around, std::size_t slot) {
  const Lanes none = Lanes::fill(kInfinity), zero = Lanes::fill(0);
  Lanes nearest = none;
  visit_within(around, grid.x()[slot], grid.y()[slot], grid.z()[slot], kInfinity,
               [&](auto, Lanes dx, Lanes dy, Lanes dz, int) HWY_ATTR {
                 const Lanes squared = dx * dx + dy * dy + dz * dz;
                 nearest = smaller(nearest, select(zero < squared, squared, none));
               });
  return smallest(nearest);
}

/// Looks for the nearest of slots that follow each other.
class Worker {
 public:
  Worker(const PointGrid& grid, AlignedColumn& squares) : grid_(grid), squares_(squares) {}

  HWY_INLINE bool attempt(int slot, const SlotRange* first, const SlotRange* last, bool are_new, double sure_squared) {
    if (are_new) around_.collect({&grid_.x(), &grid_.y(), &grid_.z()}, first, last);
    const auto i = static_cast<std::size_t>(slot);
    squares_[i] = nearest_other(grid_, around_, i);
    return squares_[i] <= sure_squared;
  }

 private:
  const PointGrid& grid_;
  AlignedColumn& squares_;
  PackedSlots<3> around_;
};

/// By slot; infinite where it is not known.
AlignedColumn nearest_squares(const PointGrid& grid, const ParallelFor& parallel) {
  AlignedColumn squares(grid.x().size(), 0.0);
  const auto left = NearestSweep(grid).run(parallel, [&] { return Worker(grid, squares); });
  for (const int slot : left) squares[static_cast<std::size_t>(slot)] = kInfinity;
  return squares;
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(nearest_squares);

PointSpacing point_spacing(const Points& vertices, const ParallelFor& parallel) {
  constexpr double kOccupancy = 5;  // the nearest vertex is then nearly always in the next cells around
  const PointGrid grid = PointGrid::with_occupancy(vertices, kOccupancy);
  return mean_nearest(grid, vertices, HWY_DYNAMIC_DISPATCH(nearest_squares)(grid, parallel));
}

double point_resolution(const Points& vertices, const ParallelFor& parallel) {
  return point_spacing(vertices, parallel).resolution;
}

}  // namespace corral
#endif
