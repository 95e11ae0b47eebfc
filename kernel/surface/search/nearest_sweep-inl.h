// SPDX-License-Identifier: MIT
// Finding the nearest neighbours of every point with a grid. Compiled once for each target; only sources with
// foreach_target.h include this.
#if defined(CORRAL_KERNEL_SURFACE_SEARCH_NEAREST_SWEEP_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef CORRAL_KERNEL_SURFACE_SEARCH_NEAREST_SWEEP_INL_H
#undef CORRAL_KERNEL_SURFACE_SEARCH_NEAREST_SWEEP_INL_H
#else
#define CORRAL_KERNEL_SURFACE_SEARCH_NEAREST_SWEEP_INL_H
#endif

#include <algorithm>
#include <limits>
#include <vector>

#include "kernel/parallel.h"
#include "kernel/surface/search/packed_slots-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {

/// Calls worker.attempt(slot, first, last, are_new, sure_squared) for every slot with ranges of slots that hold all points
/// within a squared distance, and whether they differ from those of the previous call of this worker; it returns whether that was
/// enough. If not, it is called again with more cells, and at last for a few with all slots. The slots for which that
/// would take too long (isolated or crowded ones) are returned, ascending.
class NearestSweep {
 public:
  explicit NearestSweep(const PointGrid& grid) : grid_(grid), from_faces_(grid.from_faces()) {}

  /// make_worker() is called for every block of slots; what it returns may hold scratch, and takes many slots.
  template <class MakeWorker>
  std::vector<int> run(const ParallelFor& parallel, const MakeWorker& make_worker) const {
    const int blocks = (grid_.cells() + kCellsPerBlock - 1) / kCellsPerBlock;
    std::vector<std::vector<int>> left(static_cast<std::size_t>(blocks));
    parallel(blocks, [&](int block) HWY_ATTR {
      auto& slots = left[static_cast<std::size_t>(block)];
      for (int slot = grid_.begin(block * kCellsPerBlock);
           slot < grid_.begin(std::min(grid_.cells(), (block + 1) * kCellsPerBlock)); ++slot)
        slots.push_back(slot);
      auto worker = make_worker();
      for (const int reach : {1, 2, 4, 9}) search(reach, worker, slots);
    });
    std::vector<int> all;
    for (const auto& slots : left) all.insert(all.end(), slots.begin(), slots.end());
    if (static_cast<double>(all.size()) * grid_.size() > kMostWork) return all;
    const SlotRange everything{0, grid_.size()};
    const int rest = static_cast<int>(all.size());
    parallel((rest + kSlotsPerWorker - 1) / kSlotsPerWorker, [&](int block) HWY_ATTR {
      auto worker = make_worker();
      const int first = block * kSlotsPerWorker;
      for (int i = first; i < std::min(rest, first + kSlotsPerWorker); ++i)
        worker.attempt(all[static_cast<std::size_t>(i)], &everything, &everything + 1, i == first,
                       std::numeric_limits<double>::infinity());
    });
    return {};
  }

 private:
  static constexpr int kCellsPerBlock = 256;
  static constexpr int kSlotsPerWorker = 64;
  static constexpr int kCrowd = 4000;       // slots around a cell beyond which a tree is faster
  static constexpr double kMostWork = 3e7;  // distances, some hundredths of a second

  /// Keeps in `slots` those that are left.
  template <class Worker>
  HWY_FLATTEN void search(int reach, Worker& worker, std::vector<int>& slots) const {
    CellSweep sweep(grid_, reach);
    std::vector<SlotRange> ranges;
    std::vector<int> left;
    int cell = slots.empty() ? 0 : grid_.cell_of(slots.front()) - 1;
    int end = 0, crowd = 0;
    bool are_new = false;
    for (const int slot : slots) {
      while (slot >= end) end = grid_.end(++cell), crowd = -1;
      if (crowd < 0) {
        ranges.clear();
        sweep.around(cell, ranges);
        crowd = 0;
        are_new = true;
        for (const SlotRange& range : ranges) crowd += range.end - range.begin;
      }
      const double sure = grid_.sure_radius(from_faces_[static_cast<std::size_t>(slot)], reach);
      if (crowd > kCrowd || !worker.attempt(slot, ranges.data(), ranges.data() + ranges.size(), are_new, sure * sure))
        left.push_back(slot);
      are_new = false;
    }
    slots.swap(left);
  }

  const PointGrid& grid_;
  const AlignedColumn from_faces_;  // by slot
};

}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
