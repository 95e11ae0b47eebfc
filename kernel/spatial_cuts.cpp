// SPDX-License-Identifier: MIT
#include "kernel/spatial_cuts.h"

#include <algorithm>
#include <array>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/spatial_cuts.cpp"
#include <hwy/foreach_target.h>

#include "kernel/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

constexpr int kFew = 64;        // items that are ranked, each against all
constexpr int kLuck = 20;       // pivots from samples; more are bad luck
constexpr int kStackSize = 64;  // two parts for each cut, and no more cuts above each other than a row number has bits

/// Cuts parts of some items in two, on one thread.
class Cutter {
 public:
  /// Touches nothing but items of the part.
  HWY_INLINE Cutter(SpatialItems& items, const SpatialPart& part) : items_(items), upper_(part.size()) {}

  /// Cuts until no part is larger than the least share.
  HWY_INLINE void divide(const SpatialPart& whole, int least_share) {
    SpatialPart waiting[kStackSize];
    int size = 0;
    waiting[size++] = whole;
    while (size > 0) {
      SpatialPart part = waiting[--size];
      while (part.size() <= part.share && part.share > least_share) part.share /= kSpatialBranches;
      if (part.size() <= part.share) continue;
      const int shares = (part.size() + part.share - 1) / part.share;
      const int middle = part.first + part.share * (shares / 2);
      cut(part.first, middle, part.last);
      waiting[size++] = {middle, part.last, part.share};
      waiting[size++] = {part.first, middle, part.share};
    }
  }

 private:
  /// The items of one register in a column; of fewer, the rest are like the first.
  HWY_INLINE Floats load(const float* column, int from, int last) const {
    if (from + kFloatLanes <= last) return Floats::load(column + from);
    float numbers[kFloatLanes];
    std::fill_n(std::copy(column + from, column + last, numbers), kFloatLanes - (last - from), column[from]);
    return Floats::load(numbers);
  }

  HWY_INLINE int longest_axis(int first, int last) {
    float lengths[3];
    for (int axis = 0; axis < 3; ++axis) {
      const float* const column = items_.column(axis);
      Floats low = Floats::fill(column[first]), high = low;
      for (int from = first; from < last; from += kFloatLanes) {
        const Floats places = load(column, from, last);
        low = smaller(low, places), high = larger(high, places);
      }
      float lows[kFloatLanes], highs[kFloatLanes];
      low.store(lows), high.store(highs);
      lengths[axis] = *std::max_element(highs, highs + kFloatLanes) - *std::min_element(lows, lows + kFloatLanes);
    }
    return static_cast<int>(std::max_element(lengths, lengths + 3) - lengths);
  }

  /// Moves the items whose bits are set to the front, in their order; where they end. lower(from) tells the bits of sixteen.
  template <class Bits>
  HWY_INLINE int split(int first, int last, const Bits& lower) {
    int front = first, back = 0;
    for (int from = first; from < last; from += kFloatLanes) {
      const int count = std::min(last - from, kFloatLanes);
      const unsigned all = (1U << count) - 1, low = lower(from) & all;
      const int lows = static_cast<int>(hwy::PopCount(low));
      for (int i = 0; i < SpatialItems::kColumns; ++i) {
        float* const column = items_.column(i);
        const Floats moved = load(column, from, last);
        if (count == kFloatLanes) {
          moved.pack(low, column + front);  // what it writes beyond the packed ones has been read
        } else {
          float packed[kFloatLanes];
          moved.pack(low, packed);
          std::copy_n(packed, lows, column + front);
        }
        moved.pack(all & ~low, upper_.column(i) + back);
      }
      front += lows, back += count - lows;
    }
    for (int i = 0; i < SpatialItems::kColumns; ++i) std::copy_n(upper_.column(i), back, items_.column(i) + front);
    return front;
  }

  /// About as large a share of the items lies below it as of them lies before the nth.
  static float sampled_pivot(const float* column, int first, int nth, int last) {
    std::array<float, 65> samples;
    const int size = last - first, count = size > 4096 ? 65 : size > 512 ? 17 : 9;
    for (std::int64_t i = 0; i < count; ++i)
      samples[static_cast<std::size_t>(i)] = column[first + (size - 1) * i / (count - 1)];
    const auto pivot = samples.begin() + std::int64_t{nth - first} * count / size;
    std::nth_element(samples.begin(), pivot, samples.begin() + count);
    return *pivot;
  }

  static float middle_pivot(const float* column, int first, int last) {
    const auto [low, high] = std::minmax_element(column + first, column + last);
    return 0.5F * *low + 0.5F * *high;
  }

  /// Takes as many bits away as there are too many, the last ones of those that are equal at the cut.
  static void leave_out_equals(std::uint64_t& lower, const float* below, int wanted) {
    float greatest = 0;
    for (std::uint64_t left = lower; left != 0; left &= left - 1)
      greatest = std::max(greatest, below[hwy::Num0BitsBelowLS1Bit_Nonzero64(left)]);
    for (int i = kFew - 1, too_many = static_cast<int>(hwy::PopCount(lower)) - wanted; too_many > 0; --i)
      if ((lower >> i & 1) != 0 && below[i] == greatest) lower &= ~(std::uint64_t{1} << i), --too_many;
  }

  /// Moves the smallest ones before the nth, each ranked against all; of equal ones the first.
  HWY_INLINE void rank(int axis, int first, int nth, int last) {
    const float* const column = items_.column(axis);
    const Floats one = Floats::fill(1), wanted = Floats::fill(static_cast<float>(nth - first));
    float below[kFew];  // how many items are smaller
    std::uint64_t lower = 0;
    for (int from = first; from < last; from += kFloatLanes) {
      const Floats places = load(column, from, last);
      Floats smaller_ones = Floats::fill(0);
      for (int i = first; i < last; ++i)
        smaller_ones = select(Floats::fill(column[i]) < places, smaller_ones + one, smaller_ones);
      smaller_ones.store(below + (from - first));
      lower |= static_cast<std::uint64_t>(bits(smaller_ones < wanted)) << (from - first);
    }
    if (last - first < kFew) lower &= (std::uint64_t{1} << (last - first)) - 1;
    if (static_cast<int>(hwy::PopCount(lower)) > nth - first) leave_out_equals(lower, below, nth - first);
    split(first, last, [&](int from) HWY_ATTR { return static_cast<unsigned>(lower >> (from - first)); });
  }

  /// std::nth_element along the longest side of the box.
  HWY_INLINE void cut(int first, int nth, int last) {
    const int axis = longest_axis(first, last);
    const float* const column = items_.column(axis);
    for (int pivots = 0; last - first > kFew; ++pivots) {
      const float number = pivots < kLuck ? sampled_pivot(column, first, nth, last) : middle_pivot(column, first, last);
      const Floats pivot = Floats::fill(number);
      const int lower = split(first, last, [&](int from) HWY_ATTR { return bits(load(column, from, last) < pivot); });
      if (nth == lower) return;
      if (nth < lower) {
        last = lower;
        continue;
      }
      int equal = lower;
      if (lower - first <= (last - first) / 8)
        equal = split(lower, last, [&](int from) HWY_ATTR { return bits(load(column, from, last) <= pivot); });
      if (nth <= equal) return;
      first = equal;
    }
    rank(axis, first, nth, last);
  }

  SpatialItems& items_;
  SpatialItems upper_;
};

HWY_FLATTEN void divide(SpatialItems& items, const SpatialPart& part, int least_share) {
  Cutter(items, part).divide(part, least_share);
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(divide);

void divide(SpatialItems& items, const SpatialPart& part, int least_share) {
  HWY_DYNAMIC_DISPATCH(divide)(items, part, least_share);
}

}  // namespace corral
#endif
