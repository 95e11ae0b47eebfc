// SPDX-License-Identifier: MIT
#include "tests/benchmarks/pairs_by_grid.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/benchmarks/pairs_by_grid.cpp"
#include <hwy/foreach_target.h>

#include "kernel/surface/search/packed_slots-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

HWY_FLATTEN double count_pairs(const PointGrid& grid, const CellNeighborhoods& around, double squared) {
  Lanes count = Lanes::fill(0);
  PackedSlots<3> places;
  for (int cell = 0; cell < grid.cells(); ++cell) {
    places.collect({&grid.x(), &grid.y(), &grid.z()}, around.begin(cell), around.end(cell));
    for (auto slot = static_cast<std::size_t>(grid.begin(cell)); slot < static_cast<std::size_t>(grid.end(cell));
         ++slot)
      visit_within(places, grid.x()[slot], grid.y()[slot], grid.z()[slot], squared,
                   [&](auto inside, Lanes, Lanes, Lanes, int)
                       HWY_ATTR { count = count + select(inside, Lanes::fill(1), Lanes::fill(0)); });
  }
  return sum(count);
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(count_pairs);

double ours::pairs_by_grid(const Mesh& mesh, double radius) {
  const PointGrid grid = PointGrid::for_radius(mesh.vertices, radius, 1);
  return HWY_DYNAMIC_DISPATCH(count_pairs)(grid, CellNeighborhoods(grid, 1), radius * radius);
}

}  // namespace corral
#endif
