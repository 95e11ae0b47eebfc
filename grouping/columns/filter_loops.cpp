// SPDX-License-Identifier: MIT
// Compiled with contraction: a multiplication and an addition may be one instruction.
#include "grouping/columns/filter_loops.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "grouping/columns/filter_loops.cpp"
#include <hwy/foreach_target.h>

#include "kernel/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

/// A point in every lane: sixteen of a column, or one repeated.
struct Point {
  Floats x, y, z;
  static HWY_INLINE Point load(const float* const (&columns)[3], int row) {
    return {Floats::load(columns[0] + row), Floats::load(columns[1] + row), Floats::load(columns[2] + row)};
  }
  static HWY_INLINE Point fill(const float* const (&columns)[3], int row) {
    return {Floats::fill(columns[0][row]), Floats::fill(columns[1][row]), Floats::fill(columns[2][row])};
  }
};

HWY_INLINE Floats squared_distance(const Point& a, const Point& b) {
  const Floats x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
  return x * x + y * y + z * z;
}

struct Columns {
  explicit Columns(const FilterTable& table)
      : source{table.source(0), table.source(1), table.source(2)},
        target{table.target(0), table.target(1), table.target(2)} {}
  explicit Columns(const ConsistencyFilter& filter)
      : source{filter.source(0), filter.source(1), filter.source(2)},
        target{filter.target(0), filter.target(1), filter.target(2)} {}
  const float *source[3], *target[3];
};

/// Adds 1 in the lanes where a comparison holds.
template <class Mask>
HWY_INLINE Floats counted(Mask mask, Floats count, Floats one) {
  return select(mask, count + one, count);
}

/// The sum of whole numbers.
HWY_INLINE int total(Floats counts) { return static_cast<int>(sum(counts)); }

/// Rows whose comparisons with one other row are made together.
struct ConsistencyLanes {
  Point p, q;
  Floats p_square, q_square;

  static HWY_INLINE ConsistencyLanes load(const ConsistencyFilter& filter, const Columns& columns, int first) {
    return {Point::load(columns.source, first), Point::load(columns.target, first),
            Floats::load(filter.source_square() + first), Floats::load(filter.target_square() + first)};
  }

  HWY_INLINE auto possible(const ConsistencyFilter::Row& row) const {
    const auto all = [](float value) HWY_ATTR { return Floats::fill(value); };
    const auto &s = row.source, &t = row.target;
    const Floats a = all(s[0]) * p.x + (all(s[1]) * p.y + (all(s[2]) * p.z + p_square));
    const Floats b = all(t[0]) * q.x + (all(t[1]) * q.y + (all(t[2]) * q.z + q_square));
    const Floats difference = (b + all(row.offset)) - a;
    return difference * difference - all(row.surplus) <= a;
  }
};

HWY_FLATTEN void count_consistent(const ConsistencyFilter& filter, int* counts) {
  const Columns columns(filter);
  constexpr int kGroup = ConsistencyFilter::kGroup;
  const Floats one = Floats::fill(1);
  for (int first = 0; first < filter.padded_rows(); first += kGroup) {
    const auto low = ConsistencyLanes::load(filter, columns, first),
               high = ConsistencyLanes::load(filter, columns, first + kFloatLanes);
    Floats of_low = Floats::fill(0), of_high = of_low;
    // Every pair once: a group against all rows before it, counted on both sides, and against itself.
    for (int i = 0; i < first; ++i) {
      const auto in_low = low.possible(filter.row(i)), in_high = high.possible(filter.row(i));
      of_low = counted(in_low, of_low, one), of_high = counted(in_high, of_high, one);
      counts[i] += static_cast<int>(hwy::PopCount(bits(in_low) | bits(in_high) << kFloatLanes));
    }
    for (int i = first; i < first + kGroup; ++i) {
      of_low = counted(low.possible(filter.row(i)), of_low, one);
      of_high = counted(high.possible(filter.row(i)), of_high, one);
    }
    of_low.store(counts + first), of_high.store(counts + first + kFloatLanes);
  }
}

/// The components of the residual in the order in which they follow the axis of the slab.
template <bool kInSlab>
HWY_INLINE int count_near_rows(const FilterTable& table, const PoseFilter& pose, const Slab& slab, int hopeless) {
  constexpr int kStretch = (kInSlab ? 16 : 4) * kFloatLanes;  // rows between two checks of the counts
  const Columns columns(table);
  const int end = table.padded_rows();
  int near = 0, in_slab = 0;
  const Floats one = Floats::fill(1), limit = Floats::fill(pose.possible), within = Floats::fill(slab.within);
  Floats r[3][3], t[3];
  const float* target[3];
  for (int i = 0; i < 3; ++i) {
    const int axis = (slab.axis + i) % 3;
    for (int j = 0; j < 3; ++j) r[i][j] = Floats::fill(pose.rotation[3 * axis + j]);
    t[i] = Floats::fill(pose.translation[axis]), target[i] = columns.target[axis];
  }
  for (int first = 0; first < end; first += kStretch) {
    if (near + table.rows() - first <= hopeless || (kInSlab && near + slab.most - in_slab <= hopeless)) return hopeless;
    Floats inside = Floats::fill(0), inside_slab = inside;
    for (int row = first; row < end && row < first + kStretch; row += kFloatLanes) {
      const auto p = Point::load(columns.source, row);
      const auto residual = [&](int i) HWY_ATTR {
        return r[i][0] * p.x + r[i][1] * p.y + r[i][2] * p.z + (t[i] - Floats::load(target[i] + row));
      };
      const Floats x = residual(0), y = residual(1), z = residual(2);
      if (kInSlab) inside_slab = counted(magnitude(x) <= within, inside_slab, one);
      inside = counted(x * x + y * y + z * z <= limit, inside, one);
    }
    near += total(inside);
    if (kInSlab) in_slab += total(inside_slab);
  }
  return near;
}

HWY_FLATTEN int count_near(const FilterTable& table, const PoseFilter& pose, const Slab& slab, int hopeless) {
  return 2 * slab.most < table.rows() ? count_near_rows<true>(table, pose, slab, hopeless)
                                      : count_near_rows<false>(table, pose, slab, hopeless);
}

HWY_FLATTEN void add_near(const FilterTable& table, int first, int last, const PoseFilter (&poses)[kPoseTile],
                          int (&counts)[kPoseTile]) {
  const Columns columns(table);
  const Floats one = Floats::fill(1);
  Floats inside[kPoseTile];
  for (Floats& count : inside) count = Floats::fill(0);
  for (int row = first; row < last; row += kFloatLanes) {
    const auto p = Point::load(columns.source, row), q = Point::load(columns.target, row);
    for (int k = 0; k < kPoseTile; ++k) {
      const float *r = poses[k].rotation, *t = poses[k].translation;
      const auto component = [&](int axis, Floats target) HWY_ATTR {
        return Floats::fill(r[3 * axis]) * p.x + Floats::fill(r[3 * axis + 1]) * p.y +
               Floats::fill(r[3 * axis + 2]) * p.z + (Floats::fill(t[axis]) - target);
      };
      const Floats x = component(0, q.x), y = component(1, q.y), z = component(2, q.z);
      inside[k] = counted(x * x + y * y + z * z <= Floats::fill(poses[k].possible), inside[k], one);
    }
  }
  for (int k = 0; k < kPoseTile; ++k) counts[k] += total(inside[k]);
}

struct Similarity {
  Floats certain_slope, possible_slope, offset;
  explicit Similarity(const SimilarityFilter& filter)
      : certain_slope(Floats::fill(filter.certain_slope)),
        possible_slope(Floats::fill(filter.possible_slope)),
        offset(Floats::fill(filter.offset)) {}
  HWY_INLINE auto certain(Floats lesser, Floats greater) const { return greater * certain_slope + offset <= lesser; }
  HWY_INLINE auto possible(Floats lesser, Floats greater) const { return greater * possible_slope <= lesser + offset; }
};

HWY_FLATTEN void compare_ratios(const FilterTable& table, const SimilarityFilter& filter, int block,
                                std::uint8_t* certain, std::uint8_t* possible) {
  const Columns columns(table);
  const int end = table.padded_rows(), first = 8 * block;
  const Similarity test(filter);
  const Floats zero = Floats::fill(0);
  Floats bit[8];
  for (int i = 0; i < 8; ++i) bit[i] = Floats::fill(static_cast<float>(1 << i));
  for (int row = 0; row < end; row += kFloatLanes) {
    const auto p = Point::load(columns.source, row), q = Point::load(columns.target, row);
    Floats are_certain = zero, are_possible = zero;
    for (int i = 0; i < 8; ++i) {
      const Floats a = squared_distance(p, Point::fill(columns.source, first + i));
      const Floats b = squared_distance(q, Point::fill(columns.target, first + i));
      const Floats lesser = smaller(a, b), greater = larger(a, b);
      are_certain = counted(test.certain(lesser, greater), are_certain, bit[i]);
      are_possible = counted(test.possible(lesser, greater), are_possible, bit[i]);
    }
    are_certain.store(certain + row);
    are_possible.store(possible + row);
  }
}

HWY_FLATTEN void measure_distances(const FilterTable& table, int row, float* squared) {
  const Columns columns(table);
  const auto center = Point::fill(columns.source, row);
  for (int lane = 0; lane < table.padded_rows(); lane += kFloatLanes)
    squared_distance(Point::load(columns.source, lane), center).store(squared + lane);
  squared[row] = std::numeric_limits<float>::infinity();
}

HWY_FLATTEN void count_up_to(const float* numbers, int count, const float (&limits)[kLimits], int (&counts)[kLimits]) {
  const Floats one = Floats::fill(1);
  Floats most[kLimits], found[kLimits];
  for (int k = 0; k < kLimits; ++k) most[k] = Floats::fill(limits[k]), found[k] = Floats::fill(0);
  for (int lane = 0; lane < count; lane += kFloatLanes) {
    const Floats number = Floats::load(numbers + lane);
    for (int k = 0; k < kLimits; ++k) found[k] = counted(number <= most[k], found[k], one);
  }
  for (int k = 0; k < kLimits; ++k) counts[k] = total(found[k]);
}

HWY_FLATTEN int mark_between(const float* numbers, int count, float first, float last, std::uint8_t* marks) {
  int below = 0;
  const Floats zero = Floats::fill(0), one = Floats::fill(1), from = Floats::fill(first), to = Floats::fill(last);
  Floats before = zero;
  for (int lane = 0; lane < count; lane += kFloatLanes) {
    const Floats number = Floats::load(numbers + lane);
    const Floats is_below = select(number < from, one, zero), is_up_to = select(number <= to, one, zero);
    before = before + is_below;
    (is_up_to - is_below).store(marks + lane);
  }
  below = total(before);
  return below;
}

HWY_FLATTEN FilteredVotes ask_near(const FilterTable& table, const SimilarityFilter& filter, int row,
                                   const float* squared, float limit, const float* trusted) {
  const Columns columns(table);
  FilteredVotes votes;
  const Similarity test(filter);
  const Floats zero = Floats::fill(0), most = Floats::fill(limit);
  const auto q = Point::fill(columns.target, row);
  Floats asked = zero, certain = zero, possible = zero;
  for (int lane = 0; lane < table.padded_rows(); lane += kFloatLanes) {
    const Floats a = Floats::load(squared + lane);
    const Floats voter = select(a < most, Floats::load(trusted + lane), zero);
    const Floats b = squared_distance(Point::load(columns.target, lane), q);
    const Floats lesser = smaller(a, b), greater = larger(a, b);
    asked = asked + voter;
    certain = counted(test.certain(lesser, greater), certain, voter);
    possible = counted(test.possible(lesser, greater), possible, voter);
  }
  votes = {total(asked), total(certain), total(possible)};
  return votes;
}

HWY_FLATTEN FilteredVotes ask_voters(const FilterTable& voters, const SimilarityFilter& filter,
                                     const FilterTable& table, int row, const PoseFilter& pose) {
  const Columns columns(voters), asking(table);
  FilteredVotes votes{voters.rows(), 0, 0};
  const Similarity test(filter);
  const Floats zero = Floats::fill(0), one = Floats::fill(1);
  const Floats surely = Floats::fill(pose.certain), perhaps = Floats::fill(pose.possible);
  const auto p = Point::fill(asking.source, row), q = Point::fill(asking.target, row);
  Floats r[9], t[3];
  for (int i = 0; i < 9; ++i) r[i] = Floats::fill(pose.rotation[i]);
  for (int i = 0; i < 3; ++i) t[i] = Floats::fill(pose.translation[i]);
  Floats certain = zero, possible = zero;
  for (int lane = 0; lane < voters.padded_rows(); lane += kFloatLanes) {
    const auto voter_p = Point::load(columns.source, lane);
    const auto voter_q = Point::load(columns.target, lane);
    const Floats a = squared_distance(voter_p, p), b = squared_distance(voter_q, q);
    const Floats lesser = smaller(a, b), greater = larger(a, b);
    const Floats x = r[0] * voter_p.x + r[1] * voter_p.y + r[2] * voter_p.z + (t[0] - voter_q.x);
    const Floats y = r[3] * voter_p.x + r[4] * voter_p.y + r[5] * voter_p.z + (t[1] - voter_q.y);
    const Floats z = r[6] * voter_p.x + r[7] * voter_p.y + r[8] * voter_p.z + (t[2] - voter_q.z);
    const Floats residual = x * x + y * y + z * z;
    certain = counted(test.certain(lesser, greater), certain, select(residual < surely, one, zero));
    possible = counted(test.possible(lesser, greater), possible, select(residual <= perhaps, one, zero));
  }
  votes.certain = total(certain);
  votes.possible = total(possible);
  return votes;
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(count_consistent);
HWY_EXPORT(add_near);
HWY_EXPORT(count_near);
HWY_EXPORT(compare_ratios);
HWY_EXPORT(measure_distances);
HWY_EXPORT(count_up_to);
HWY_EXPORT(mark_between);
HWY_EXPORT(ask_near);
HWY_EXPORT(ask_voters);

void count_consistent(const ConsistencyFilter& filter, int* counts) {
  HWY_DYNAMIC_DISPATCH(count_consistent)(filter, counts);
}

void add_near(const FilterTable& table, int first, int last, const PoseFilter (&poses)[kPoseTile],
              int (&counts)[kPoseTile]) {
  HWY_DYNAMIC_DISPATCH(add_near)(table, first, last, poses, counts);
}

int count_near(const FilterTable& table, const PoseFilter& pose, const Slab& slab, int hopeless) {
  return HWY_DYNAMIC_DISPATCH(count_near)(table, pose, slab, hopeless);
}

int count_near(const FilterTable& table, const PoseFilter& pose, int hopeless) {
  return count_near(table, pose, {0, table.rows(), -1}, hopeless);
}

void compare_ratios(const FilterTable& table, const SimilarityFilter& filter, int block, std::uint8_t* certain,
                    std::uint8_t* possible) {
  HWY_DYNAMIC_DISPATCH(compare_ratios)(table, filter, block, certain, possible);
}

void measure_distances(const FilterTable& table, int row, float* squared) {
  HWY_DYNAMIC_DISPATCH(measure_distances)(table, row, squared);
}

void count_up_to(const float* numbers, int count, const float (&limits)[kLimits], int (&counts)[kLimits]) {
  HWY_DYNAMIC_DISPATCH(count_up_to)(numbers, count, limits, counts);
}

int mark_between(const float* numbers, int count, float first, float last, std::uint8_t* marks) {
  return HWY_DYNAMIC_DISPATCH(mark_between)(numbers, count, first, last, marks);
}

FilteredVotes ask_near(const FilterTable& table, const SimilarityFilter& filter, int row, const float* squared,
                       float limit, const float* trusted) {
  return HWY_DYNAMIC_DISPATCH(ask_near)(table, filter, row, squared, limit, trusted);
}

FilteredVotes ask_voters(const FilterTable& voters, const SimilarityFilter& filter, const FilterTable& table, int row,
                         const PoseFilter& pose) {
  return HWY_DYNAMIC_DISPATCH(ask_voters)(voters, filter, table, row, pose);
}

}  // namespace corral
#endif
