// SPDX-License-Identifier: MIT
#include "kernel/spatial_order.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "kernel/vectorized.h"

namespace corral {
namespace {

constexpr int kBranches = 8;    // of a node, and points of a full leaf
constexpr int kFew = 64;        // items that are ranked, each against all
constexpr int kLuck = 20;       // pivots from samples; more are bad luck
constexpr int kStackSize = 64;  // two parts for each cut, and no more cuts above each other than a row number has bits

/// Places as floats that are 1 at most, which is enough for an order, and the bits of their rows.
struct Items {
  static constexpr int kColumns = 4;
  FloatColumn columns[kColumns];

  explicit Items(int count) {
    for (FloatColumn& column : columns) column.resize(static_cast<std::size_t>(padded(count, kFloatLanes)));
  }
  float* column(int i) { return columns[i].data(); }

  void set(int at, const Eigen::RowVector3d& place, std::int32_t row) {
    for (int axis = 0; axis < 3; ++axis) column(axis)[at] = static_cast<float>(place(axis));
    std::memcpy(column(3) + at, &row, sizeof(row));
  }
  int row(int at) {
    std::int32_t row;
    std::memcpy(&row, column(3) + at, sizeof(row));
    return row;
  }
};

/// Items first .. last - 1, which are to become shares of so many.
struct Part {
  int first, last, share;
  int size() const { return last - first; }
};

/// Cuts parts of some items in two, on one thread.
template <class Floats>
class Cutter {
 public:
  /// Touches nothing but items of the part.
  CORRAL_INLINE Cutter(Items& items, const Part& part) : items_(items), upper_(part.size()) {}

  /// Cuts until no part is larger than the least share.
  CORRAL_INLINE void divide(const Part& whole, int least_share) {
    Part waiting[kStackSize];
    int size = 0;
    waiting[size++] = whole;
    while (size > 0) {
      Part part = waiting[--size];
      while (part.size() <= part.share && part.share > least_share) part.share /= kBranches;
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
  CORRAL_INLINE Floats load(const float* column, int from, int last) const {
    if (from + kFloatLanes <= last) return Floats::load(column + from);
    float numbers[kFloatLanes];
    std::fill_n(std::copy(column + from, column + last, numbers), kFloatLanes - (last - from), column[from]);
    return Floats::load(numbers);
  }

  CORRAL_INLINE int longest_axis(int first, int last) {
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
  CORRAL_INLINE int split(int first, int last, const Bits& lower) {
    int front = first, back = 0;
    for (int from = first; from < last; from += kFloatLanes) {
      const int count = std::min(last - from, kFloatLanes);
      const unsigned all = (1U << count) - 1, low = lower(from) & all;
      const int lows = __builtin_popcount(low);
      for (int i = 0; i < Items::kColumns; ++i) {
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
    for (int i = 0; i < Items::kColumns; ++i) std::copy_n(upper_.column(i), back, items_.column(i) + front);
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
      greatest = std::max(greatest, below[__builtin_ctzll(left)]);
    for (int i = kFew - 1, too_many = __builtin_popcountll(lower) - wanted; too_many > 0; --i)
      if ((lower >> i & 1) != 0 && below[i] == greatest) lower &= ~(std::uint64_t{1} << i), --too_many;
  }

  /// Moves the smallest ones before the nth, each ranked against all; of equal ones the first.
  CORRAL_INLINE void rank(int axis, int first, int nth, int last) {
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
    if (__builtin_popcountll(lower) > nth - first) leave_out_equals(lower, below, nth - first);
    split(first, last, [&](int from) { return static_cast<unsigned>(lower >> (from - first)); });
  }

  /// std::nth_element along the longest side of the box.
  CORRAL_INLINE void cut(int first, int nth, int last) {
    const int axis = longest_axis(first, last);
    const float* const column = items_.column(axis);
    for (int pivots = 0; last - first > kFew; ++pivots) {
      const float number = pivots < kLuck ? sampled_pivot(column, first, nth, last) : middle_pivot(column, first, last);
      const Floats pivot = Floats::fill(number);
      const int lower = split(first, last, [&](int from) { return bits(load(column, from, last) < pivot); });
      if (nth == lower) return;
      if (nth < lower) {
        last = lower;
        continue;
      }
      int equal = lower;
      if (lower - first <= (last - first) / 8)
        equal = split(lower, last, [&](int from) { return bits(load(column, from, last) <= pivot); });
      if (nth <= equal) return;
      first = equal;
    }
    rank(axis, first, nth, last);
  }

  Items& items_;
  Items upper_;
};

void divide(Items& items, const Part& part, int least_share) {
  vectorized([&](auto kind) { Cutter<typename decltype(kind)::Floats>(items, part).divide(part, least_share); });
}

}  // namespace

Indices spatial_order(const Points& points, const ParallelFor& parallel) {
  Eigen::AlignedBox3d box;
  Indices finite, rest;
  for (int row = 0; row < points.rows(); ++row) {
    const Eigen::Vector3d place = points.row(row).transpose();
    const bool is_finite = place.allFinite();
    (is_finite ? finite : rest).push_back(row);
    if (is_finite) box.extend(place);
  }
  const int count = static_cast<int>(finite.size());
  const Eigen::RowVector3d middle = (0.5 * box.min() + 0.5 * box.max()).transpose();
  const double reach = (0.5 * box.max() - 0.5 * box.min()).maxCoeff(), scale = reach > 1e-300 ? 1 / reach : 0;
  Items items(count);
  for (int i = 0; i < count; ++i) {
    const int row = finite[static_cast<std::size_t>(i)];
    items.set(i, scale * (points.row(row) - middle), row);
  }
  int share = kBranches;
  while (share < (count + kBranches - 1) / kBranches) share *= kBranches;
  divide(items, {0, count, share}, share);  // the root
  parallel((count + share - 1) / share, [&](int i) {
    const int first = i * share;
    divide(items, {first, std::min(count, first + share), share}, kBranches);
  });
  Indices rows;
  rows.reserve(static_cast<std::size_t>(points.rows()));
  for (int i = 0; i < count; ++i) rows.push_back(items.row(i));
  rows.insert(rows.end(), rest.begin(), rest.end());
  return rows;
}

}  // namespace corral
