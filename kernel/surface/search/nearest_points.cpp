// SPDX-License-Identifier: MIT
#include "kernel/surface/search/nearest_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kernel/spatial_order.h"

namespace corral {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLargest = std::numeric_limits<double>::max();
constexpr double kRounding = 1e-11;   // of a few sums and roots, generously
constexpr double kSlack = 1.25;       // of the limit, so that queries just beyond it can move without a search
constexpr std::size_t kShare = 4096;  // places that one thread takes at a time
constexpr int kDeepest = 12;          // levels of eight entries: more than there are row numbers

/// Calls visit(lane) for the lanes whose bits are set.
template <class Visit>
CORRAL_INLINE void visit_lanes(unsigned bits, const Visit& visit) {
  for (; bits != 0; bits &= bits - 1) visit(static_cast<std::size_t>(__builtin_ctz(bits)));
}

}  // namespace

struct PointTree::Box {
  double low[3] = {kInfinity, kInfinity, kInfinity}, high[3] = {-kInfinity, -kInfinity, -kInfinity};
  int number = kNothing;  // of what it holds

  void add(int axis, double from, double to) {
    low[axis] = std::min(low[axis], from);
    high[axis] = std::max(high[axis], to);
  }
  double longest_side() const { return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]}); }
};

/// The points in their spatial order make the leaves, eight by eight; these make nodes, and so on.
PointTree::PointTree(const Points& points, const ParallelFor& parallel) {
  Indices order = spatial_order(points, parallel);
  while (!order.empty() && !points.row(order.back()).allFinite()) order.pop_back();
  leaves_.resize((order.size() + kLanes - 1) / kLanes);
  std::vector<Box> boxes(leaves_.size());
  for (std::size_t index = 0; index < leaves_.size(); ++index) {
    Leaf& leaf = leaves_[index];
    boxes[index].number = leaf_number(index);
    for (std::size_t i = 0; i < kLanes; ++i) {
      const std::size_t at = kLanes * index + i;
      const bool is_there = at < order.size();
      leaf.row[i] = is_there ? order[at] : kInfinity;
      for (int axis = 0; axis < 3; ++axis) {
        leaf.place[axis][i] = is_there ? points(order[at], axis) : kInfinity;
        if (is_there) boxes[index].add(axis, leaf.place[axis][i], leaf.place[axis][i]);
      }
    }
  }
  for (const Box& box : boxes) spacing_ += box.longest_side() / (std::sqrt(kLanes) * static_cast<double>(boxes.size()));
  while (boxes.size() > 1) boxes = gather(boxes);
  if (!boxes.empty()) root_ = boxes.front().number;
}

/// Makes nodes of eight boxes each.
std::vector<PointTree::Box> PointTree::gather(const std::vector<Box>& boxes) {
  std::vector<Box> larger;
  for (std::size_t first = 0; first < boxes.size(); first += kLanes) {
    Node node;
    Box whole;
    whole.number = static_cast<int>(nodes_.size());
    for (std::size_t i = 0; i < kLanes; ++i) {
      const bool is_there = first + i < boxes.size();
      node.child[i] = is_there ? boxes[first + i].number : kNothing;
      for (int axis = 0; axis < 3; ++axis) {
        node.low[axis][i] = is_there ? boxes[first + i].low[axis] : kInfinity;
        node.high[axis][i] = is_there ? boxes[first + i].high[axis] : kInfinity;
        if (is_there) whole.add(axis, node.low[axis][i], node.high[axis][i]);
      }
    }
    nodes_.push_back(node);
    larger.push_back(whole);
  }
  return larger;
}

/// Has the first lines of a node or leaf brought near; they are needed soon.
CORRAL_INLINE void PointTree::fetch(int number) const {
  const void* const from = number < 0 ? static_cast<const void*>(&leaves_[leaf_index(number)])
                                      : static_cast<const void*>(&nodes_[static_cast<std::size_t>(number)]);
  for (int line = 0; line < 4; ++line) __builtin_prefetch(static_cast<const char*>(from) + 64 * line);
}

/// The queries, and what was found for each where it was searched last; `target` is infinite where nothing was near enough.
struct NearestTracker::Followed : PointPairs {
  AlignedColumn was[3];     // where the query was searched
  AlignedColumn row;        // of the nearest point
  AlignedColumn second;     // distance of the next nearest that was met; infinite if none was near enough
  AlignedColumn clearance;  // all points but the nearest are at least this far away; 0: nothing is known
  Indices order, nearest;   // of those who ask by row

  explicit Followed(std::size_t size) : row(size, kInfinity), second(size, kInfinity), clearance(size, 0) {
    target_rows.resize(size);
    for (int axis = 0; axis < 3; ++axis) {
      source[axis].assign(size, kInfinity);
      target[axis].assign(size, kInfinity);
      was[axis].assign(size, 0);
    }
  }
};

NearestTracker::NearestTracker(const PointTree& tree, ParallelFor parallel)
    : tree_(tree), parallel_(std::move(parallel)) {}
NearestTracker::~NearestTracker() = default;

NearestTracker::Followed& NearestTracker::follow(Eigen::Index count) {
  const auto size = static_cast<std::size_t>(padded(static_cast<int>(count)));
  return followed_.try_emplace(count, size).first->second;
}

/// The nearest of eight queries; lanes whose bound is negative are left alone.
template <class Lanes>
struct NearestTracker::Search {
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
  CORRAL_INLINE void look_at(const PointTree& tree, std::size_t index) {
    const PointTree::Leaf& points = tree.leaves_[index];
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
  CORRAL_INLINE Lanes bounds() const { return smaller(smaller(best + beyond, second), bound_squared); }
  CORRAL_INLINE double bound() const { return largest(bounds()); }

  /// Puts the entries of a node that are near enough on top of those that wait, the nearest last.
  CORRAL_INLINE void unfold(const PointTree& tree, const PointTree::Node& node, const Lanes (&low)[3],
                            const Lanes (&high)[3], double limit, Visit* waiting, int& size) const {
    // Rounding is monotonic: the computed distance of two boxes is never above that of points in them.
    const auto gap = [&](int axis) {
      return larger(Lanes::fill(0),
                    larger(Lanes::load(node.low[axis]) - high[axis], low[axis] - Lanes::load(node.high[axis])));
    };
    const Lanes dx = gap(0), dy = gap(1), dz = gap(2), squared = dx * dx + dy * dy + dz * dz;
    double squares[kLanes];
    squared.store(squares);
    const int before = size;
    visit_lanes(bits(squared <= Lanes::fill(std::min(limit, kLargest))), [&](std::size_t i) {
      waiting[size] = {squares[i], node.child[i]};
      tree.fetch(node.child[i]);
      if (size > before && waiting[size - 1].squared < squares[i]) std::swap(waiting[size - 1], waiting[size]);
      ++size;
    });
  }

  /// The box holds the lanes that are searched.
  template <bool kWithTies>
  CORRAL_INLINE void run(const PointTree& tree, const double* box_low, const double* box_high) {
    best = second = row = Lanes::fill(kInfinity);
    const Lanes low[3] = {Lanes::fill(box_low[0]), Lanes::fill(box_low[1]), Lanes::fill(box_low[2])},
                high[3] = {Lanes::fill(box_high[0]), Lanes::fill(box_high[1]), Lanes::fill(box_high[2])};
    Visit waiting[kDeepest * kLanes];
    int size = 0;
    if (tree.root_ != PointTree::kNothing) waiting[size++] = {0, tree.root_};
    double limit = bound();
    while (size > 0) {
      const Visit visit = waiting[--size];
      if (visit.squared > limit) continue;
      if (visit.number < 0) {
        look_at<kWithTies>(tree, PointTree::leaf_index(visit.number));
        limit = bound();
      } else {
        unfold(tree, tree.nodes_[static_cast<std::size_t>(visit.number)], low, high, limit, waiting, size);
      }
    }
  }
};

/// Finds the partners of some places, in whole registers.
template <class Kind>
void NearestTracker::search(Kind, Followed& f, std::size_t first, std::size_t last, double limit) const {
  using Lanes = typename Kind::Lanes;
  const Lanes zero = Lanes::fill(0), one = Lanes::fill(1), none = Lanes::fill(kInfinity), most = Lanes::fill(kLargest),
              limit_squared = Lanes::fill(limit * limit), farthest = Lanes::fill(kSlack * limit);
  for (std::size_t place = first; place < last; place += kLanes) {
    const Lanes x = Lanes::load(&f.source[0][place]), y = Lanes::load(&f.source[1][place]),
                z = Lanes::load(&f.source[2][place]);
    const auto squared_from = [&](const AlignedColumn(&other)[3]) {
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
    visit_lanes(unsure, [&](std::size_t lane) {
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
      const Lanes beyond = select(Lanes::fill(tree_.spacing_) < motion, zero, none);
      const Lanes bound_squared = select(zero < is_unsure, reach * reach, Lanes::fill(-1));
      Search<Lanes> search{x, y, z, bound_squared, beyond, none, none, none, none};
      search.template run<false>(tree_, low, high);
      // Ties are rare, but where points are doubled; to heed them always would double the time of the loop.
      if (bits(search.second <= smaller(search.best, most)) != 0) search.template run<true>(tree_, low, high);

      const auto keep = [&](const Lanes& found, AlignedColumn& column) {
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
      visit_lanes(unsure, [&](std::size_t lane) {
        const std::size_t at = place + lane;
        for (AlignedColumn& column : f.target) column[at] = kInfinity;
        if (f.row[at] == kInfinity) return;
        const PointTree::Leaf& leaf = tree_.leaves_[static_cast<std::size_t>(leaves[lane])];
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

const PointPairs& NearestTracker::pair(const Points& queries, double limit) {
  Followed& followed = follow(queries.rows());
  for (int axis = 0; axis < 3; ++axis)
    std::copy_n(queries.col(axis).data(), queries.rows(), followed.source[axis].data());
  const std::size_t size = followed.target_rows.size();
  parallel_(static_cast<int>((size + kShare - 1) / kShare), [&](int share) {
    const std::size_t first = static_cast<std::size_t>(share) * kShare;
    vectorized([&](auto kind) { search(kind, followed, first, std::min(size, first + kShare), limit); });
  });
  return followed;
}

const Indices& NearestTracker::nearest(const Points& queries, double limit) {
  Followed& followed = follow(queries.rows());
  if (followed.order.empty()) followed.order = spatial_order(queries, parallel_);
  const PointPairs& pairs = pair(queries(followed.order, Eigen::all), limit);
  followed.nearest.resize(followed.order.size());
  for (std::size_t i = 0; i < followed.order.size(); ++i)
    followed.nearest[static_cast<std::size_t>(followed.order[i])] = pairs.target_rows[i];
  return followed.nearest;
}

}  // namespace corral
