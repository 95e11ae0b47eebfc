// SPDX-License-Identifier: MIT
#include "kernel/surface/normals.h"

#include <algorithm>
#include <limits>

#include "kernel/error.h"
#include "kernel/surface/nearest_sweep.h"
#include "kernel/surface/plane_fit.h"

namespace corral {
namespace {

/// Fits a plane to the k nearest of every point.
class NearestPlanes {
 public:
  NearestPlanes(const Points& points, const PointGrid& grid, int k)
      : points_(points), grid_(grid), k_(std::min(k, grid.size())), fits_(grid.size()) {}

  PlaneFits run(const ParallelFor& parallel) {
    const auto left = NearestSweep(grid_).run(
        parallel, [this](int slot, const SlotRange* first, const SlotRange* last, double sure_squared, auto kind) {
          return fit<typename decltype(kind)::Lanes>(static_cast<std::size_t>(slot), first, last, sure_squared);
        });
    if (!left.empty()) fit_with_tree(left, parallel);
    fits_.solve_all(parallel);
    return std::move(fits_);
  }

 private:
  /// The squared distances of all slots of some ranges, infinite in the padding behind each.
  template <class Lanes>
  CORRAL_INLINE void measure(const SlotRange* first, const SlotRange* last, std::size_t slot, Column& squares) const {
    std::size_t size = 0;
    for (const SlotRange* range = first; range != last; ++range)
      size += static_cast<std::size_t>(padded(range->end - range->begin));
    squares.resize(size);
    double* next = squares.data();
    visit_within<Lanes>(grid_, first, last, grid_.x()[slot], grid_.y()[slot], grid_.z()[slot], kInfinity,
                        [&](auto inside, Lanes dx, Lanes dy, Lanes dz, std::size_t) {
                          select(inside, dx * dx + dy * dy + dz * dz, Lanes::fill(kInfinity)).store(next);
                          next += kLanes;
                        });
  }

  template <class Lanes>
  static CORRAL_INLINE int count_within(const Column& squares, double squared) {
    const Lanes limit = Lanes::fill(squared), one = Lanes::fill(1), zero = Lanes::fill(0);
    Lanes count = zero;
    for (std::size_t i = 0; i < squares.size(); i += kLanes)
      count = count + select(Lanes::load(&squares[i]) <= limit, one, zero);
    return static_cast<int>(sum(count));
  }

  /// The smallest of some squared distances above another; infinite if there is none.
  template <class Lanes>
  static CORRAL_INLINE double next_above(const Column& squares, double squared) {
    const Lanes limit = Lanes::fill(squared), none = Lanes::fill(kInfinity);
    Lanes next = none;
    for (std::size_t i = 0; i < squares.size(); i += kLanes) {
      const Lanes value = Lanes::load(&squares[i]);
      next = smaller(next, select(limit < value, value, none));
    }
    return smallest(next);
  }

  template <class Lanes>
  CORRAL_INLINE bool fit(std::size_t slot, const SlotRange* first, const SlotRange* last, double sure_squared) {
    thread_local Column squares;
    measure<Lanes>(first, last, slot, squares);
    double low = -1, high = std::min(sure_squared, std::numeric_limits<double>::max());
    int at_high = count_within<Lanes>(squares, high), at_low = 0;
    if (at_high < k_) return false;
    // On a surface the points within a distance grow as its square: a few guesses part the k nearest from the others.
    for (int guess = 0; guess < kGuesses && at_high != k_; ++guess) {
      const double from = std::max(low, 0.0);
      const double limit = from + (high - from) * (k_ + 0.5 - at_low) / (at_high - at_low + 1);
      const int count = count_within<Lanes>(squares, limit);
      if (count < k_)
        low = limit, at_low = count;
      else
        high = limit, at_high = count;
    }
    // What is left goes from one distance to the next.
    while (at_high != k_ && at_low < k_) {
      const double next = next_above<Lanes>(squares, low);
      const int count = count_within<Lanes>(squares, next);
      if (count > k_) {
        fits_.fit<Lanes>(slot, grid_, first, last, slot, low, tied(slot, first, last, next, k_ - at_low));
        return true;
      }
      low = next, at_low = count;
    }
    fits_.fit<Lanes>(slot, grid_, first, last, slot, at_high == k_ ? high : low);
    return true;
  }

  /// Of the slots at exactly a squared distance those with the lowest rows, ascending.
  std::vector<std::size_t> tied(std::size_t slot, const SlotRange* first, const SlotRange* last, double squared,
                                int count) const {
    std::vector<std::size_t> slots;
    for (const SlotRange* range = first; range != last; ++range)
      for (auto other = static_cast<std::size_t>(range->begin); other < static_cast<std::size_t>(range->end); ++other) {
        const double dx = grid_.x()[other] - grid_.x()[slot], dy = grid_.y()[other] - grid_.y()[slot],
                     dz = grid_.z()[other] - grid_.z()[slot];
        if (dx * dx + dy * dy + dz * dz == squared) slots.push_back(other);
      }
    const auto row = [&](std::size_t other) { return grid_.row(static_cast<int>(other)); };
    std::sort(slots.begin(), slots.end(), [&](std::size_t a, std::size_t b) { return row(a) < row(b); });
    slots.resize(static_cast<std::size_t>(count));
    std::sort(slots.begin(), slots.end());
    return slots;
  }

  void fit_with_tree(const std::vector<int>& slots, const ParallelFor& parallel) {
    const PointIndex index(points_);
    parallel(static_cast<int>(slots.size()), [&](int i) {
      const int slot = slots[static_cast<std::size_t>(i)];
      const Eigen::RowVector3d center = points_.row(grid_.row(slot));
      Indices rows;
      for (const Neighbor& neighbor : index.nearest(center.transpose(), k_)) rows.push_back(neighbor.index);
      fits_.fit_rows(static_cast<std::size_t>(slot), points_, center, std::move(rows));
    });
  }

  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr int kGuesses = 5;

  const Points& points_;
  const PointGrid& grid_;
  int k_;
  PlaneFits fits_;
};

}  // namespace

Points estimate_normals(const Mesh& mesh, const NormalOptions& options, const ParallelFor& parallel) {
  const int k = options.neighbors;
  if (k < 3) throw InvalidInput("estimate_normals", "neighbors", std::to_string(k), "at least 3");
  // Cells a little wider than the k nearest reach, so that the next cells around nearly always hold them.
  const PointGrid grid = PointGrid::with_occupancy(mesh.vertices, 0.45 * k);
  const PlaneFits fits = NearestPlanes(mesh.vertices, grid, k).run(parallel);
  const Points sides = options.side_of_faces ? area_weighted_normals(mesh) : Points();
  Points normals(mesh.vertices.rows(), 3);
  for (int slot = 0; slot < grid.size(); ++slot) {
    const int row = grid.row(slot);
    const auto i = static_cast<std::size_t>(slot);
    const Eigen::RowVector3d normal(fits.nx[i], fits.ny[i], fits.nz[i]);
    Eigen::RowVector3d outside = options.sensor.transpose() - mesh.vertices.row(row);
    if (options.side_of_faces && !sides.row(row).isZero(0)) outside = sides.row(row);
    normals.row(row) = normal.dot(outside) < 0 ? Eigen::RowVector3d(-normal) : normal;
  }
  return normals;
}

}  // namespace corral
