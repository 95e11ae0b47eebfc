// SPDX-License-Identifier: MIT
#include "kernel/surface/search/nearest_search.h"

#include <hwy/cache_control.h>

#include <algorithm>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/surface/search/nearest_search.cpp"
#include <hwy/foreach_target.h>

#include "kernel/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLargest = std::numeric_limits<double>::max();
constexpr double kRounding = 1e-11;  // of a few sums and roots, generously
constexpr double kSlack = 1.25;      // of the limit, so that queries just beyond it can move without a search
constexpr int kDeepest = 12;         // levels of eight entries: more than there are row numbers

/// Calls visit(lane) for the lanes whose bits are set.
template <class Visit>
HWY_INLINE void visit_lanes(unsigned bits, const Visit& visit) {
  for (; bits != 0; bits &= bits - 1) visit(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits));
}

/// Has the first lines of a node or leaf brought near; they are needed soon.
HWY_INLINE void fetch(const PointTree& tree, int number) {
  const void* const from = number < 0 ? static_cast<const void*>(tree.leaves() + PointTree::leaf_index(number))
                                      : static_cast<const void*>(tree.nodes() + number);
  for (int line = 0; line < 4; ++line) hwy::Prefetch(static_cast<const char*>(from) + 64 * line);
}

/// The nearest of eight queries; lanes whose bound is negative are left alone.
struct Search {
  Lanes x, y, z, bound_squared;
  Lanes beyond;             // 0 where the nearest is enough, infinite where the second is wanted too
  Lanes best, second, row;  // infinite at first
  Lanes leaf;               // that holds the nearest, by its place among the leaves

  struct Visit {
    double squared;
    int number;
  };

  /// Of equally near points the one that was met first stays, or with ties the one of the lowest row.
  template <bool kWithTies>
  HWY_INLINE void look_at(const PointTree& tree, std::size_t index) {
    const PointTree::Leaf& points = tree.leaves()[index];
    const Lanes row_before = row;
    for (int i = 0; i < kLanes; ++i) {
      const Lanes dx = x - Lanes::fill(points.place[0][i]), dy = y - Lanes::fill(points.place[1][i]),
                  dz = z - Lanes::fill(points.place[2][i]), number = Lanes::fill(points.row[i]);
      const Lanes squared = dx * dx + dy * dy + dz * dz;
      second = smaller(second, larger(best, squared));
      if constexpr (kWithTies) {
        const Lanes rank = select(squared == best, number, select(squared < best, Lanes::fill(-1), row));
        row = select(rank < row, number, row);
      } else {
        row = select(squared < best, number, row);
      }
      best = smaller(best, squared);
    }
    leaf = select(row == row_before, leaf, Lanes::fill(static_cast<double>(index)));
  }

  /// Beyond the roots of these nothing is looked at, and nothing but the nearest is nearer.
  HWY_INLINE Lanes bounds() const { return smaller(smaller(best + beyond, second), bound_squared); }
  HWY_INLINE double bound() const { return largest(bounds()); }

  /// Puts the entries of a node that are near enough on top of those that wait, the nearest last.
  HWY_INLINE void unfold(const PointTree& tree, const PointTree::Node& node, const Lanes (&low)[3],
                         const Lanes (&high)[3], double limit, Visit* waiting, int& size) const {
    // Rounding is monotonic: the computed distance of two boxes is never above that of points in them.
    const auto gap = [&](int axis) HWY_ATTR {
      return larger(Lanes::fill(0),
                    larger(Lanes::load(node.low[axis]) - high[axis], low[axis] - Lanes::load(node.high[axis])));
    };
    const Lanes dx = gap(0), dy = gap(1), dz = gap(2), squared = dx * dx + dy * dy + dz * dz;
    double squares[kLanes];
    squared.store(squares);
    const int before = size;
    visit_lanes(bits(squared <= Lanes::fill(std::min(limit, kLargest))), [&](std::size_t i) HWY_ATTR {
      waiting[size] = {squares[i], node.child[i]};
      fetch(tree, node.child[i]);
      if (size > before && waiting[size - 1].squared < squares[i]) std::swap(waiting[size - 1], waiting[size]);
      ++size;
    });
  }

  /// The box holds the lanes that are searched.
  template <bool kWithTies>
  HWY_INLINE void run(const PointTree& tree, const double* box_low, const double* box_high) {
    best = second = row = Lanes::fill(kInfinity);
    const Lanes low[3] = {Lanes::fill(box_low[0]), Lanes::fill(box_low[1]), Lanes::fill(box_low[2])},
                high[3] = {Lanes::fill(box_high[0]), Lanes::fill(box_high[1]), Lanes::fill(box_high[2])};
    Visit waiting[kDeepest * kLanes];
    int size = 0;
    if (tree.root() != PointTree::kNothing) waiting[size++] = {0, tree.root()};
    double limit = bound();
    while (size > 0) {
      const Visit visit = waiting[--size];
      if (visit.squared > limit) continue;
      if (visit.number < 0) {
        look_at<kWithTies>(tree, PointTree::leaf_index(visit.number));
        limit = bound();
      } else {
        unfold(tree, tree.nodes()[visit.number], low, high, limit, waiting, size);
      }
    }
  }
};

/// Finds the partners of some places, in whole registers.
HWY_FLATTEN void search_partners(const PointTree& tree, FollowedPoints& f, std::size_t first, std::size_t last,
                                 double limit) {
  const Lanes zero = Lanes::fill(0), one = Lanes::fill(1), none = Lanes::fill(kInfinity), most = Lanes::fill(kLargest),
              limit_squared = Lanes::fill(limit * limit), farthest = Lanes::fill(kSlack * limit);
  for (std::size_t place = first; place < last; place += kLanes) {
    const Lanes x = Lanes::load(&f.source[0][place]), y = Lanes::load(&f.source[1][place]),
                z = Lanes::load(&f.source[2][place]);
    const auto squared_from = [&](const AlignedColumn(&other)[3]) HWY_ATTR {
      const Lanes dx = x - Lanes::load(&other[0][place]), dy = y - Lanes::load(&other[1][place]),
                  dz = z - Lanes::load(&other[2][place]);
      return dx * dx + dy * dy + dz * dz;
    };
    const Lanes moved = square_root(squared_from(f.was));
    const Lanes sure = larger(zero, Lanes::load(&f.clearance[place]) * Lanes::fill(1 - kRounding) - moved);
    const Lanes is_finite = select(magnitude(x + y + z) <= most, one, zero);
    const Lanes is_unsure = select(smaller(squared_from(f.target), limit_squared) < sure * sure, zero, is_finite);
    const unsigned unsure = bits(zero < is_unsure);
    double low[3] = {kInfinity, kInfinity, kInfinity}, high[3] = {-kInfinity, -kInfinity, -kInfinity};
    visit_lanes(unsure, [&](std::size_t lane) HWY_ATTR {
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], f.source[axis][place + lane]);
        high[axis] = std::max(high[axis], f.source[axis][place + lane]);
      }
    });
    if (unsure != 0) {
      // The second nearest is not farther than before by more than the motion.
      const Lanes reach = smaller(farthest, (Lanes::load(&f.second[place]) + moved) * Lanes::fill(1 + kRounding));
      // The second tells how far a query may move before it is searched again: not worth it where queries move that far.
      const Lanes motion = select(zero < Lanes::load(&f.clearance[place]), moved, zero);
      const Lanes beyond = select(Lanes::fill(tree.spacing()) < motion, zero, none);
      const Lanes bound_squared = select(zero < is_unsure, reach * reach, Lanes::fill(-1));
      Search search{x, y, z, bound_squared, beyond, none, none, none, none};
      search.run<false>(tree, low, high);
      // Ties are rare, but where points are doubled; to heed them always would double the time of the loop.
      if (bits(search.second <= smaller(search.best, most)) != 0) search.run<true>(tree, low, high);

      const auto keep = [&](const Lanes& found, AlignedColumn& column) HWY_ATTR {
        select(zero < is_unsure, found, Lanes::load(&column[place])).store(&column[place]);
      };
      keep(x, f.was[0]);
      keep(y, f.was[1]);
      keep(z, f.was[2]);
      keep(search.row, f.row);
      keep(square_root(search.second), f.second);
      keep(square_root(larger(search.bounds(), zero)), f.clearance);
      double leaves[kLanes];
      search.leaf.store(leaves);
      visit_lanes(unsure, [&](std::size_t lane) HWY_ATTR {
        const std::size_t at = place + lane;
        for (AlignedColumn& column : f.target) column[at] = kInfinity;
        if (f.row[at] == kInfinity) return;
        const PointTree::Leaf& leaf = tree.leaves()[static_cast<std::size_t>(leaves[lane])];
        const auto i = std::find(leaf.row, leaf.row + kLanes - 1, f.row[at]) - leaf.row;
        for (int axis = 0; axis < 3; ++axis) f.target[axis][at] = leaf.place[axis][i];
      });
    }
    // Comparisons with a limit that is NaN fail.
    select(squared_from(f.target) <= Lanes::fill(std::min(limit * limit, kLargest)), Lanes::load(&f.row[place]),
           Lanes::fill(-1))
        .store(&f.target_rows[place]);
  }
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(search_partners);

void search_partners(const PointTree& tree, FollowedPoints& followed, std::size_t first, std::size_t last,
                     double limit) {
  HWY_DYNAMIC_DISPATCH(search_partners)(tree, followed, first, last, limit);
}

}  // namespace corral
#endif
