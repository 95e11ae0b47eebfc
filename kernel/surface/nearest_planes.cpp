// SPDX-License-Identifier: MIT
#include "kernel/surface/nearest_planes.h"

#include <algorithm>
#include <utility>

#include "kernel/surface/search/neighborhood.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/surface/nearest_planes.cpp"
#include <hwy/foreach_target.h>

#include "kernel/surface/plane_fit-inl.h"
#include "kernel/surface/search/nearest_sweep-inl.h"
#include "kernel/surface/shortlist-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

/// By slot.
struct Fits {
  PlaneFits planes;
  AlignedColumn squares;  ///< distances of the nearest in another place
};

/// Chooses the k nearest of slots that follow each other, and adds up their moments.
class Worker {
 public:
  Worker(const PointGrid& grid, int k, Fits& fits)
      : grid_(grid), k_(k), fits_(fits), x_(room()), y_(room()), z_(room()) {}

  HWY_INLINE bool attempt(int slot, const SlotRange* first, const SlotRange* last, bool are_new, double sure_squared) {
    if (are_new) {
      crowd_.collect(grid_, first, last);
      shortlist_.make_room(crowd_.size());
      chosen_.resize(static_cast<std::size_t>(crowd_.size()));
    }
    const auto own = static_cast<std::size_t>(slot);
    const double x = grid_.x()[own], y = grid_.y()[own], z = grid_.z()[own];
    if (!choose(own, first, sure_squared)) return false;
    const int* const chosen = chosen_.data();
    const double *from_x = crowd_.places[0], *from_y = crowd_.places[1], *from_z = crowd_.places[2];
    double *to_x = x_.data(), *to_y = y_.data(), *to_z = z_.data();
    for (int i = 0; i < k_; ++i) to_x[i] = from_x[chosen[i]], to_y[i] = from_y[chosen[i]], to_z[i] = from_z[chosen[i]];
    for (int i = k_; i < padded(k_); ++i) to_x[i] = x, to_y[i] = y, to_z[i] = z;
    fits_.squares[own] = fits_.planes.fit_chosen(own, to_x, to_y, to_z, k_, x, y, z);
    return true;
  }

 private:
  struct Candidate {
    double squared;
    int row, place;
  };
  std::size_t room() const { return static_cast<std::size_t>(padded(k_)); }

  HWY_INLINE bool choose(std::size_t slot, const SlotRange* first, double sure_squared) {
    if (crowd_.size() < k_) return false;
    const auto most = static_cast<float>(sure_squared / (grid_.cell_side() * grid_.cell_side()) * (1 - 0x1p-22));
    if (!shorten(slot, most)) return false;
    const bool is_short = shortlist_.count >= k_;
    const int count = is_short ? shortlist_.count : crowd_.size();
    for (int i = 0; i < count; ++i)
      chosen_[static_cast<std::size_t>(i)] =
          is_short ? static_cast<int>(shortlist_.places[static_cast<std::size_t>(i)]) : i;
    return (is_short && count == k_) || choose_exactly(slot, first, count, sure_squared);
  }

  /// Lists the k nearest, and others only if floats cannot tell them apart; nothing where that fails. Returns whether the k
  /// nearest may be sure to be there.
  HWY_INLINE bool shorten(std::size_t slot, float most) {
    constexpr int kTries = 8;
    constexpr float kLeastLimit = 1e-6F;  // a crowd in one place must not be where all later ones begin
    const float at[] = {crowd_.near_to(grid_.x()[slot], 0), crowd_.near_to(grid_.y()[slot], 1),
                        crowd_.near_to(grid_.z()[slot], 2)};
    const float wanted = 1.3F * static_cast<float>(k_);
    // Neighbours have neighbours about as far away, and on a surface the points within a distance grow as its square.
    float limit = std::min(std::max(1.3F * hint_, kLeastLimit), most);
    if (crowd_.size() < kMostPlaces)
      for (int tries = 0; tries < kTries; ++tries) {
        shortlist_.fill(crowd_, at, limit);
        if (shortlist_.count >= k_ && shortlist_.count <= 2 * k_) {
          const float nth = shortlist_.nth(k_), reach = crowd_.reach(nth);
          if (reach > most) return false;
          if (reach <= limit) {
            hint_ = nth;
            shortlist_.keep_within(reach);
            return true;
          }
          limit = std::min(most, 1.1F * reach);
        } else {
          if (shortlist_.count < k_ && !(limit < most)) return false;
          limit = std::min(most, limit * wanted / (static_cast<float>(shortlist_.count) + 0.5F));
        }
      }
    shortlist_.count = 0;
    return true;
  }

  /// Keeps the k nearest of so many chosen, among equals those with the lower rows; returns whether they are sure to be the
  /// nearest of all.
  bool choose_exactly(std::size_t slot, const SlotRange* first, int count, double sure_squared) {
    candidates_.clear();
    const SlotRange* range = first;
    int begin = 0;  // place of the range
    for (int i = 0; i < count; ++i) {
      const int place = chosen_[static_cast<std::size_t>(i)];
      while (place - begin >= range->end - range->begin) begin += range->end - range->begin, ++range;
      const auto other = static_cast<std::size_t>(range->begin + place - begin);
      const double dx = grid_.x()[other] - grid_.x()[slot], dy = grid_.y()[other] - grid_.y()[slot],
                   dz = grid_.z()[other] - grid_.z()[slot];
      candidates_.push_back({dx * dx + dy * dy + dz * dz, grid_.row(static_cast<int>(other)), place});
    }
    const auto end = candidates_.begin() + k_;
    std::nth_element(candidates_.begin(), end - 1, candidates_.end(), [](const Candidate& a, const Candidate& b) {
      return a.squared < b.squared || (a.squared == b.squared && a.row < b.row);
    });
    if (!((end - 1)->squared <= sure_squared)) return false;
    std::transform(candidates_.begin(), end, chosen_.begin(), [](const Candidate& each) { return each.place; });
    std::sort(chosen_.begin(), chosen_.begin() + k_);
    return true;
  }

  static constexpr int kMostPlaces = 1 << 24;  // that floats can count

  const PointGrid& grid_;
  int k_;
  Fits& fits_;
  Crowd crowd_;
  Shortlist shortlist_;
  Indices chosen_;           // places in the crowd, ascending
  AlignedColumn x_, y_, z_;  // of those
  std::vector<Candidate> candidates_;
  float hint_ = 1;  // where to look first, in sides of a cell; what is found does not depend on it
};

/// Adds up in the order of the slots, as everywhere: how the nearest were found leaves no trace.
void fit_with_tree(const Points& points, const PointGrid& grid, int k, const std::vector<int>& slots,
                   const ParallelFor& parallel, Fits& fits) {
  const PointIndex index(points);
  Indices slot_of(static_cast<std::size_t>(grid.size()));
  for (int slot = 0; slot < grid.size(); ++slot) slot_of[static_cast<std::size_t>(grid.row(slot))] = slot;
  parallel(static_cast<int>(slots.size()), [&](int i) HWY_ATTR {
    const auto own = static_cast<std::size_t>(slots[static_cast<std::size_t>(i)]);
    const double x = grid.x()[own], y = grid.y()[own], z = grid.z()[own];
    Indices chosen;
    for (const Neighbor& neighbor : index.nearest({x, y, z}, k))
      chosen.push_back(slot_of[static_cast<std::size_t>(neighbor.index)]);
    std::sort(chosen.begin(), chosen.end());
    chosen.resize(static_cast<std::size_t>(padded(k)), static_cast<int>(own));
    AlignedColumn xs, ys, zs;
    for (const int slot : chosen) {
      const auto other = static_cast<std::size_t>(slot);
      xs.push_back(grid.x()[other]), ys.push_back(grid.y()[other]), zs.push_back(grid.z()[other]);
    }
    fits.squares[own] = fits.planes.fit_chosen(own, xs.data(), ys.data(), zs.data(), k, x, y, z);
  });
}

NearestPlanes fit_nearest_planes(const Points& points, const PointGrid& grid, int k, const ParallelFor& parallel) {
  const int count = std::min(k, grid.size());
  Fits fits{PlaneFits(grid.size()), AlignedColumn(grid.x().size())};
  const auto left = NearestSweep(grid).run(parallel, [&] { return Worker(grid, count, fits); });
  if (!left.empty()) fit_with_tree(points, grid, count, left, parallel, fits);
  PlaneFits& planes = fits.planes;
  planes.solve_all(parallel);
  return {std::move(planes.nx), std::move(planes.ny), std::move(planes.nz), std::move(fits.squares)};
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(fit_nearest_planes);

NearestPlanes fit_nearest_planes(const Points& points, const PointGrid& grid, int k, const ParallelFor& parallel) {
  return HWY_DYNAMIC_DISPATCH(fit_nearest_planes)(points, grid, k, parallel);
}

}  // namespace corral
#endif
