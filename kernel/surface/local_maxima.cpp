// SPDX-License-Identifier: MIT
#include "kernel/surface/local_maxima.h"

#include <algorithm>

namespace corral {
namespace {

class LocalMaxima {
 public:
  LocalMaxima(const PointGrid& grid, const CellNeighborhoods& around, const AlignedColumn& values,
              const MaximumRule& rule)
      : grid_(grid), around_(around), values_(values), squared_(rule.squared_radius), smallest_(rule.smallest) {}

  Indices find() const {
    Indices maxima;
    vectorized([&](auto kind) {
      using Lanes = typename decltype(kind)::Lanes;
      for (int cell = 0; cell < grid_.cells(); ++cell) {
        const int first = grid_.begin(cell), last = grid_.end(cell);
        int top = first;
        for (int slot = first; slot < last; ++slot)
          if (at(slot) > at(top)) top = slot;
        for (int slot = first; slot < last; ++slot)  // most are beaten by the top of their cell
          if (at(slot) >= smallest_ && !is_beaten(slot, top) &&
              is_highest<Lanes>(slot, around_.begin(cell), around_.end(cell)))
            maxima.push_back(slot);
      }
    });
    return maxima;
  }

 private:
  double at(int slot) const { return values_[static_cast<std::size_t>(slot)]; }

  /// Whether another slot within the radius is higher, or as high with a lower row.
  bool is_beaten(int slot, int other) const {
    const auto i = static_cast<std::size_t>(slot), j = static_cast<std::size_t>(other);
    if (values_[j] < values_[i]) return false;
    const double x = grid_.x()[j] - grid_.x()[i], y = grid_.y()[j] - grid_.y()[i], z = grid_.z()[j] - grid_.z()[i];
    return x * x + y * y + z * z <= squared_ && (values_[j] > values_[i] || grid_.row(other) < grid_.row(slot));
  }

  /// Whether no slot of some ranges beats one. The range of its own cell comes first: most are beaten there.
  template <class Lanes>
  CORRAL_INLINE bool is_highest(int slot, const SlotRange* first, const SlotRange* last) const {
    const SlotRange* const home = std::find_if(first, last, [&](const SlotRange& range) { return slot < range.end; });
    if (beats<Lanes>(*home, slot)) return false;
    for (const SlotRange* range = first; range != last; ++range)
      if (range != home && beats<Lanes>(*range, slot)) return false;
    return true;
  }

  /// Whether a slot of a range beats another one.
  template <class Lanes>
  CORRAL_INLINE bool beats(const SlotRange& range, int slot) const {
    const auto own = static_cast<std::size_t>(slot);
    const Lanes value = Lanes::fill(values_[own]), x = Lanes::fill(grid_.x()[own]), y = Lanes::fill(grid_.y()[own]),
                z = Lanes::fill(grid_.z()[own]), squared = Lanes::fill(squared_);
    for (int i = range.begin; i < range.end; i += kLanes) {
      const auto at = static_cast<std::size_t>(i);
      const Lanes dx = Lanes::load(&grid_.x()[at]) - x, dy = Lanes::load(&grid_.y()[at]) - y,
                  dz = Lanes::load(&grid_.z()[at]) - z;
      unsigned left = bits(value <= Lanes::load(&values_[at])) & bits(dx * dx + dy * dy + dz * dz <= squared);
      for (; left != 0; left &= left - 1)  // those behind the range count as well
        if (is_beaten(slot, i + __builtin_ctz(left))) return true;
    }
    return false;
  }

  const PointGrid& grid_;
  const CellNeighborhoods& around_;
  const AlignedColumn& values_;
  double squared_;
  double smallest_;
};

}  // namespace

Indices local_maxima(const PointGrid& grid, const CellNeighborhoods& around, const AlignedColumn& values,
                     const MaximumRule& rule) {
  return LocalMaxima(grid, around, values, rule).find();
}

Indices sorted_rows(const PointGrid& grid, const Indices& slots) {
  Indices rows;
  for (const int slot : slots) rows.push_back(grid.row(slot));
  std::sort(rows.begin(), rows.end());
  return rows;
}

}  // namespace corral
