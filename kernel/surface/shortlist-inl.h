// SPDX-License-Identifier: MIT
// Candidates for the k nearest of a point, listed by floats. Compiled once for each target; only sources with
// foreach_target.h include this.
#if defined(CORRAL_KERNEL_SURFACE_SHORTLIST_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef CORRAL_KERNEL_SURFACE_SHORTLIST_INL_H
#undef CORRAL_KERNEL_SURFACE_SHORTLIST_INL_H
#else
#define CORRAL_KERNEL_SURFACE_SHORTLIST_INL_H
#endif

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/surface/search/packed_slots-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {

/// The points around a cell, next to each other: in double, and in floats relative to one of them in sides of a cell.
class Crowd {
 public:
  PackedSlots<3> places;
  FloatColumn near[3];  ///< what follows up to a multiple of sixteen is infinitely far away

  int size() const { return places.size(); }

  float near_to(double value, int axis) const { return static_cast<float>((value - origin_[axis]) * scale_); }

  /// Points as near as one that seems to be within this seem to be within the result (squares of floats). Let u be half the
  /// last place of 1 and coordinates be up to E: rounding both ends moves each coordinate of an offset by 2 u E,
  /// subtracting them by 2 u E more, so that a distance is off by e = sqrt(3) 4 u E, and by 2 u of itself from its square.
  /// One point may seem nearer by that, another farther. The bounds here are a little wider.
  float reach(double squared) const {
    const double reached = std::sqrt(squared) * (1 + 8 * kUnit) + 2 * (7.5 * kUnit * extent_ + kTiny);
    return static_cast<float>(reached * reached * (1 + 4 * kUnit));
  }

  HWY_INLINE void collect(const PointGrid& grid, const SlotRange* first, const SlotRange* last) {
    places.collect({&grid.x(), &grid.y(), &grid.z()}, first, last);
    scale_ = 1 / grid.cell_side();
    const int count = size();
    const auto room = static_cast<std::size_t>(padded(count, kFloatLanes));
    static constexpr double kLane[] = {0, 1, 2, 3, 4, 5, 6, 7};
    const Lanes lane = Lanes::load(kLane), zero = Lanes::fill(0), scale = Lanes::fill(scale_);
    double extents[3];
    for (int axis = 0; axis < 3; ++axis) {
      FloatColumn& column = near[axis];
      if (column.size() < room) column.resize(2 * room);
      origin_[axis] = places[axis][0];
      const Lanes origin = Lanes::fill(origin_[axis]);
      const double* const from = places[axis];
      float* const to = column.data();
      Lanes extent = zero;
      const int whole = count / kLanes * kLanes;
      for (int i = 0; i < whole; i += kLanes) {
        const Lanes offset = (Lanes::load(from + i) - origin) * scale;
        offset.store(to + i);
        extent = larger(extent, magnitude(offset));
      }
      if (whole < count) {
        const Lanes offset = (Lanes::load(from + whole) - origin) * scale;
        offset.store(to + whole);
        extent = larger(extent, select(lane < Lanes::fill(count - whole), magnitude(offset), zero));
      }
      extents[axis] = largest(extent);
    }
    std::fill_n(near[0].data() + count, room - static_cast<std::size_t>(count), std::numeric_limits<float>::infinity());
    extent_ = std::max(std::max(extents[0], extents[1]), extents[2]);
  }

 private:
  static constexpr double kUnit = 0x1p-24;
  static constexpr double kTiny = 1e-20;  // more than underflow takes away
  double origin_[3] = {}, scale_ = 1, extent_ = 0;
};

/// Places in a crowd with their squared distances, by place.
struct Shortlist {
  FloatColumn places, squares;
  int count = 0;

  void make_room(int size) {
    if (places.size() >= static_cast<std::size_t>(size + kFloatLanes)) return;
    for (FloatColumn* column : {&places, &squares}) column->resize(static_cast<std::size_t>(2 * size + kFloatLanes));
  }

  /// Makes this the points of a crowd that seem to be within a squared distance.
  HWY_INLINE void fill(const Crowd& crowd, const float (&at)[3], float squared) {
    static constexpr float kLane[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    const Floats cx = Floats::fill(at[0]), cy = Floats::fill(at[1]), cz = Floats::fill(at[2]),
                 limit = Floats::fill(squared), step = Floats::fill(kFloatLanes);
    const float *x = crowd.near[0].data(), *y = crowd.near[1].data(), *z = crowd.near[2].data();
    Floats place = Floats::load(kLane);
    float *to_places = places.data(), *to_squares = squares.data();
    const int end = crowd.size();
    for (int i = 0; i < end; i += kFloatLanes, place = place + step) {
      const Floats dx = Floats::load(x + i) - cx, dy = Floats::load(y + i) - cy, dz = Floats::load(z + i) - cz;
      const Floats square = dx * dx + dy * dy + dz * dz;
      const unsigned inside = bits(square <= limit);
      place.pack(inside, to_places), square.pack(inside, to_squares);
      const std::size_t found = hwy::PopCount(inside);
      to_places += found, to_squares += found;
    }
    count = static_cast<int>(to_places - places.data());
  }

  /// The k-th smallest squared distance: of each the smaller ones are counted.
  HWY_INLINE float nth(int k) {
    const Floats zero = Floats::fill(0), one = Floats::fill(1);
    std::fill_n(&squares[count], kFloatLanes, std::numeric_limits<float>::infinity());
    const float* const all = squares.data();
    const int end = count;
    for (int wanted = k - 1;; --wanted)  // equal ones leave out ranks behind theirs
      for (int i = 0; i < end; i += kFloatLanes) {
        const Floats own = Floats::load(all + i);
        Floats even = zero, odd = zero;
        for (int j = 0; j < end; j += 2) {  // behind the last is an infinite one
          even = even + select(Floats::fill(all[j]) < own, one, zero);
          odd = odd + select(Floats::fill(all[j + 1]) < own, one, zero);
        }
        const unsigned found = bits(even + odd == Floats::fill(static_cast<float>(wanted)));
        if (found != 0) return all[i + hwy::Num0BitsBelowLS1Bit_Nonzero32(found)];
      }
  }

  HWY_INLINE void keep_within(float squared) {
    const Floats limit = Floats::fill(squared);
    const float *from = places.data(), *judged = squares.data();
    float* to = places.data();
    for (int i = 0; i < count; i += kFloatLanes) {
      const unsigned inside = bits(Floats::load(judged + i) <= limit);
      Floats::load(from + i).pack(inside, to);
      to += hwy::PopCount(inside);
    }
    count = static_cast<int>(to - from);
  }
};

}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
