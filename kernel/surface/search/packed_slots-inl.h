// SPDX-License-Identifier: MIT
// The neighbourhoods of a PointGrid on lanes. Compiled once for each target; only sources with foreach_target.h include this.
#if defined(CORRAL_KERNEL_SURFACE_SEARCH_PACKED_SLOTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef CORRAL_KERNEL_SURFACE_SEARCH_PACKED_SLOTS_INL_H
#undef CORRAL_KERNEL_SURFACE_SEARCH_PACKED_SLOTS_INL_H
#else
#define CORRAL_KERNEL_SURFACE_SEARCH_PACKED_SLOTS_INL_H
#endif

#include <algorithm>
#include <limits>

#include "kernel/lanes-inl.h"
#include "kernel/surface/search/point_grid.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {

/// Columns of the slots of some ranges, copied next to each other for loops that run over them often. The first column
/// goes on with infinity, for at least sixteen numbers.
template <int kColumns>
class PackedSlots {
 public:
  int size() const { return size_; }
  const double* operator[](int column) const { return columns_[column].data(); }

  HWY_INLINE void collect(const AlignedColumn* const (&from)[kColumns], const SlotRange* first, const SlotRange* last) {
    std::size_t count = 0;
    for (const SlotRange* range = first; range != last; ++range)
      count += static_cast<std::size_t>(range->end - range->begin);
    size_ = static_cast<int>(count);
    if (columns_[0].size() < count + kFloatLanes)
      for (AlignedColumn& column : columns_) column.resize(2 * count + kFloatLanes);
    const double* sources[kColumns];
    double* targets[kColumns];
    for (int i = 0; i < kColumns; ++i) sources[i] = from[i]->data(), targets[i] = columns_[i].data();
    for (const SlotRange* range = first; range != last; ++range) {
      const int length = range->end - range->begin;
      for (int at = 0; at < length; at += kLanes)  // what is too many is written over
        for (int i = 0; i < kColumns; ++i) Lanes::load(sources[i] + range->begin + at).store(targets[i] + at);
      for (int i = 0; i < kColumns; ++i) targets[i] += length;
    }
    std::fill_n(targets[0], kFloatLanes, std::numeric_limits<double>::infinity());
  }

 private:
  AlignedColumn columns_[kColumns];
  int size_ = 0;
};

/// Calls visit(inside, dx, dy, dz, i) for eight places after the other, the first three columns of packed slots: `inside` is
/// true on the lanes that lie within a squared distance of (x, y, z), d their offsets from it, i the first of the eight. What
/// is infinitely far, as the padding is, lies within no distance.
template <int kColumns, class Visit>
HWY_INLINE void visit_within(const PackedSlots<kColumns>& packed, double x, double y, double z, double squared,
                             const Visit& visit) {
  const Lanes cx = Lanes::fill(x), cy = Lanes::fill(y), cz = Lanes::fill(z),
              limit = Lanes::fill(std::min(squared, std::numeric_limits<double>::max()));
  const double *xs = packed[0], *ys = packed[1], *zs = packed[2];
  for (int i = 0; i < packed.size(); i += kLanes) {
    const Lanes dx = Lanes::load(xs + i) - cx, dy = Lanes::load(ys + i) - cy, dz = Lanes::load(zs + i) - cz;
    visit(dx * dx + dy * dy + dz * dz <= limit, dx, dy, dz, i);
  }
}

}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
