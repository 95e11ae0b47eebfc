// SPDX-License-Identifier: MIT
#include "kernel/surface/normals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kernel/error.h"
#include "kernel/surface/plane_fit.h"
#include "kernel/surface/search/nearest_sweep.h"

namespace corral {
namespace {

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

  template <class Lanes>
  CORRAL_INLINE void collect(const PointGrid& grid, const SlotRange* first, const SlotRange* last) {
    places.collect<Lanes>({&grid.x(), &grid.y(), &grid.z()}, first, last);
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
    std::fill_n(&near[0][static_cast<std::size_t>(count)], room - static_cast<std::size_t>(count),
                std::numeric_limits<float>::infinity());
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
  template <class Floats>
  CORRAL_INLINE void fill(const Crowd& crowd, const float (&at)[3], float squared) {
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
      const int found = __builtin_popcount(inside);
      to_places += found, to_squares += found;
    }
    count = static_cast<int>(to_places - places.data());
  }

  /// The k-th smallest squared distance: of each the smaller ones are counted.
  template <class Floats>
  CORRAL_INLINE float nth(int k) {
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
        if (found != 0) return all[i + __builtin_ctz(found)];
      }
  }

  template <class Floats>
  CORRAL_INLINE void keep_within(float squared) {
    const Floats limit = Floats::fill(squared);
    const float *from = places.data(), *judged = squares.data();
    float* to = places.data();
    for (int i = 0; i < count; i += kFloatLanes) {
      const unsigned inside = bits(Floats::load(judged + i) <= limit);
      Floats::load(from + i).pack(inside, to);
      to += __builtin_popcount(inside);
    }
    count = static_cast<int>(to - from);
  }
};

/// By slot: planes through the k nearest, and the squared distance of the nearest in another place (infinite if the k nearest
/// are in one).
struct NearestFits {
  PlaneFits planes;
  AlignedColumn squares;
};

/// Fits a plane to the k nearest of every point.
class NearestPlanes {
 public:
  NearestPlanes(const Points& points, const PointGrid& grid, int k)
      : points_(points),
        grid_(grid),
        k_(std::min(k, grid.size())),
        fits_{PlaneFits(grid.size()), AlignedColumn(grid.x().size())} {}

  NearestFits run(const ParallelFor& parallel) {
    const auto left = NearestSweep(grid_).run(parallel, [this](int slot, const SlotRange* first, const SlotRange* last,
                                                               bool are_new, double sure_squared, auto kind) {
      return fit(kind, static_cast<std::size_t>(slot), first, last, are_new, sure_squared);
    });
    if (!left.empty()) fit_with_tree(left, parallel);
    fits_.planes.solve_all(parallel);
    return std::move(fits_);
  }

 private:
  struct Candidate {
    double squared;
    int row, place;
  };

  /// What a thread works with.
  struct Scratch {
    Crowd crowd;
    Shortlist shortlist;
    Indices chosen;         // places in the crowd, ascending
    AlignedColumn x, y, z;  // of those
    std::vector<Candidate> candidates;
    float hint = 1;  // where to look first, in sides of a cell; what is found does not depend on it
  };

  template <class Kind>
  CORRAL_INLINE bool fit(Kind, std::size_t slot, const SlotRange* first, const SlotRange* last, bool are_new,
                         double sure_squared) {
    using Lanes = typename Kind::Lanes;
    thread_local Scratch scratch;
    const Crowd& crowd = scratch.crowd;
    if (are_new) {
      scratch.crowd.collect<Lanes>(grid_, first, last);
      scratch.shortlist.make_room(crowd.size());
      scratch.chosen.resize(static_cast<std::size_t>(crowd.size()));
      for (AlignedColumn* column : {&scratch.x, &scratch.y, &scratch.z})
        column->resize(static_cast<std::size_t>(padded(k_)));
    }
    const double x = grid_.x()[slot], y = grid_.y()[slot], z = grid_.z()[slot];
    if (!choose<Kind>(slot, first, sure_squared, scratch)) return false;
    const int* const chosen = scratch.chosen.data();
    const double *from_x = crowd.places[0], *from_y = crowd.places[1], *from_z = crowd.places[2];
    double *to_x = scratch.x.data(), *to_y = scratch.y.data(), *to_z = scratch.z.data();
    for (int i = 0; i < k_; ++i) to_x[i] = from_x[chosen[i]], to_y[i] = from_y[chosen[i]], to_z[i] = from_z[chosen[i]];
    for (int i = k_; i < padded(k_); ++i) to_x[i] = x, to_y[i] = y, to_z[i] = z;
    fits_.squares[slot] = fits_.planes.fit_chosen<Lanes>(slot, to_x, to_y, to_z, k_, x, y, z);
    return true;
  }

  template <class Kind>
  CORRAL_INLINE bool choose(std::size_t slot, const SlotRange* first, double sure_squared, Scratch& scratch) const {
    const Crowd& crowd = scratch.crowd;
    Shortlist& shortlist = scratch.shortlist;
    if (crowd.size() < k_) return false;
    const auto most = static_cast<float>(sure_squared / (grid_.cell_side() * grid_.cell_side()) * (1 - 0x1p-22));
    if (!shorten<typename Kind::Floats>(crowd, slot, most, shortlist, scratch.hint)) return false;
    const bool is_short = shortlist.count >= k_;
    const int count = is_short ? shortlist.count : crowd.size();
    for (int i = 0; i < count; ++i)
      scratch.chosen[static_cast<std::size_t>(i)] =
          is_short ? static_cast<int>(shortlist.places[static_cast<std::size_t>(i)]) : i;
    return (is_short && count == k_) || choose_exactly(slot, first, count, sure_squared, scratch);
  }

  /// Lists the k nearest, and others only if floats cannot tell them apart; nothing where that fails. Returns whether the k
  /// nearest may be sure to be there.
  template <class Floats>
  CORRAL_INLINE bool shorten(const Crowd& crowd, std::size_t slot, float most, Shortlist& shortlist,
                             float& hint) const {
    constexpr int kTries = 8;
    constexpr float kLeastLimit = 1e-6F;  // a crowd in one place must not be where all later ones begin
    const float at[] = {crowd.near_to(grid_.x()[slot], 0), crowd.near_to(grid_.y()[slot], 1),
                        crowd.near_to(grid_.z()[slot], 2)};
    const float wanted = 1.3F * static_cast<float>(k_);
    // Neighbours have neighbours about as far away, and on a surface the points within a distance grow as its square.
    float limit = std::min(std::max(1.3F * hint, kLeastLimit), most);
    if (crowd.size() < kMostPlaces)
      for (int tries = 0; tries < kTries; ++tries) {
        shortlist.fill<Floats>(crowd, at, limit);
        if (shortlist.count >= k_ && shortlist.count <= 2 * k_) {
          const float nth = shortlist.nth<Floats>(k_), reach = crowd.reach(nth);
          if (reach > most) return false;
          if (reach <= limit) {
            hint = nth;
            shortlist.keep_within<Floats>(reach);
            return true;
          }
          limit = std::min(most, 1.1F * reach);
        } else {
          if (shortlist.count < k_ && !(limit < most)) return false;
          limit = std::min(most, limit * wanted / (static_cast<float>(shortlist.count) + 0.5F));
        }
      }
    shortlist.count = 0;
    return true;
  }

  /// Keeps the k nearest of so many chosen, among equals those with the lower rows; returns whether they are sure to be the
  /// nearest of all.
  bool choose_exactly(std::size_t slot, const SlotRange* first, int count, double sure_squared,
                      Scratch& scratch) const {
    auto& candidates = scratch.candidates;
    candidates.clear();
    const SlotRange* range = first;
    int begin = 0;  // place of the range
    for (int i = 0; i < count; ++i) {
      const int place = scratch.chosen[static_cast<std::size_t>(i)];
      while (place - begin >= range->end - range->begin) begin += range->end - range->begin, ++range;
      const auto other = static_cast<std::size_t>(range->begin + place - begin);
      const double dx = grid_.x()[other] - grid_.x()[slot], dy = grid_.y()[other] - grid_.y()[slot],
                   dz = grid_.z()[other] - grid_.z()[slot];
      candidates.push_back({dx * dx + dy * dy + dz * dz, grid_.row(static_cast<int>(other)), place});
    }
    const auto end = candidates.begin() + k_;
    std::nth_element(candidates.begin(), end - 1, candidates.end(), [](const Candidate& a, const Candidate& b) {
      return a.squared < b.squared || (a.squared == b.squared && a.row < b.row);
    });
    if (!((end - 1)->squared <= sure_squared)) return false;
    std::transform(candidates.begin(), end, scratch.chosen.begin(), [](const Candidate& each) { return each.place; });
    std::sort(scratch.chosen.begin(), scratch.chosen.begin() + k_);
    return true;
  }

  /// Adds up in the order of the slots, as everywhere: how the nearest were found leaves no trace.
  void fit_with_tree(const std::vector<int>& slots, const ParallelFor& parallel) {
    const PointIndex index(points_);
    Indices slot_of(static_cast<std::size_t>(grid_.size()));
    for (int slot = 0; slot < grid_.size(); ++slot) slot_of[static_cast<std::size_t>(grid_.row(slot))] = slot;
    parallel(static_cast<int>(slots.size()), [&](int i) {
      const auto own = static_cast<std::size_t>(slots[static_cast<std::size_t>(i)]);
      const double x = grid_.x()[own], y = grid_.y()[own], z = grid_.z()[own];
      Indices chosen;
      for (const Neighbor& neighbor : index.nearest({x, y, z}, k_))
        chosen.push_back(slot_of[static_cast<std::size_t>(neighbor.index)]);
      std::sort(chosen.begin(), chosen.end());
      chosen.resize(static_cast<std::size_t>(padded(k_)), static_cast<int>(own));
      AlignedColumn xs, ys, zs;
      for (const int slot : chosen) {
        const auto other = static_cast<std::size_t>(slot);
        xs.push_back(grid_.x()[other]), ys.push_back(grid_.y()[other]), zs.push_back(grid_.z()[other]);
      }
      vectorized([&](auto kind) {
        fits_.squares[own] =
            fits_.planes.fit_chosen<typename decltype(kind)::Lanes>(own, xs.data(), ys.data(), zs.data(), k_, x, y, z);
      });
    });
  }

  static constexpr int kMostPlaces = 1 << 24;  // that floats can count

  const Points& points_;
  const PointGrid& grid_;
  int k_;
  NearestFits fits_;
};

/// The grid for a search for so many.
PointGrid grid_for(const Points& points, int k) {
  if (k < 3) throw InvalidInput("estimate_normals", "neighbors", std::to_string(k), "at least 3");
  // Cells a little wider than the k nearest reach, so that the next cells around nearly always hold them.
  return PointGrid::with_occupancy(points, 0.65 * k);
}

/// By row, each to its side.
Points turned(const PlaneFits& fits, const Mesh& mesh, const PointGrid& grid, const NormalOptions& options) {
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

}  // namespace

Points estimate_normals(const Mesh& mesh, const NormalOptions& options, const ParallelFor& parallel) {
  const PointGrid grid = grid_for(mesh.vertices, options.neighbors);
  const NearestFits fits = NearestPlanes(mesh.vertices, grid, options.neighbors).run(parallel);
  return turned(fits.planes, mesh, grid, options);
}

NormalsAndResolution estimate_normals_and_resolution(const Mesh& mesh, const NormalOptions& options,
                                                     const ParallelFor& parallel) {
  const PointGrid grid = grid_for(mesh.vertices, options.neighbors);
  NearestFits fits = NearestPlanes(mesh.vertices, grid, options.neighbors).run(parallel);
  const double resolution = mean_nearest(grid, mesh.vertices, std::move(fits.squares));
  return {turned(fits.planes, mesh, grid, options), resolution};
}

}  // namespace corral
