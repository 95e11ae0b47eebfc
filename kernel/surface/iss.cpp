// SPDX-License-Identifier: MIT
#include "kernel/surface/iss.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/surface/crowd_limit.h"
#include "kernel/surface/local_maxima.h"
#include "kernel/surface/plane_fit.h"
#include "kernel/surface/search/point_grid.h"

namespace corral {
namespace {

constexpr char kWho[] = "detect_iss";
constexpr double kFlat = 1e-9;  // of the largest eigenvalue
constexpr int kCellsPerBlock = 256;

/// "Nearer than", for comparisons that include the limit.
double squared_below(double radius) { return std::nextafter(radius * radius, 0.0); }

/// Calls visit(first cell, last cell) for all cells in blocks.
template <class Visit>
void visit_cells(const PointGrid& grid, const ParallelFor& parallel, const Visit& visit) {
  parallel((grid.cells() + kCellsPerBlock - 1) / kCellsPerBlock, [&](int block) {
    const int first = block * kCellsPerBlock;
    visit(first, std::min(grid.cells(), first + kCellsPerBlock));
  });
}

/// w_j of every vertex.
Eigen::VectorXd density_weights(const Points& vertices, double radius, const ParallelFor& parallel) {
  const PointGrid grid = PointGrid::for_radius(vertices, radius, 1);
  const CellNeighborhoods around(grid, 1);
  CrowdLimit crowd({kWho, "density radius", radius, 2000, 12}, grid.size());
  Eigen::VectorXd weights(vertices.rows());
  visit_cells(grid, parallel, [&](int first, int last) {
    std::int64_t neighbors = 0;
    vectorized([&](auto kind) {
      using Lanes = typename decltype(kind)::Lanes;
      const Lanes zero = Lanes::fill(0), one = Lanes::fill(1);
      PackedSlots<3> places;
      for (int cell = first; cell < last; ++cell) {
        places.collect<Lanes>({&grid.x(), &grid.y(), &grid.z()}, around.begin(cell), around.end(cell));
        for (int slot = grid.begin(cell); slot < grid.end(cell); ++slot) {
          const auto at = static_cast<std::size_t>(slot);
          Lanes count = zero;
          visit_within<Lanes>(
              places, grid.x()[at], grid.y()[at], grid.z()[at], squared_below(radius),
              [&](auto inside, Lanes, Lanes, Lanes, int) { count = count + select(inside, one, zero); });
          const double found = sum(count);
          weights(grid.row(slot)) = 1 / found;
          neighbors += static_cast<std::int64_t>(found);
          if (crowd.is_exceeded_by(neighbors)) crowd.add(neighbors);
        }
      }
    });
    crowd.add(neighbors);
  });
  return weights;
}

/// Saliencies, in two passes: the scatter of every slot, then the eigenvalues of eight at a time.
class SaliencyOperator {
 public:
  SaliencyOperator(const Points& vertices, double resolution, const IssOptions& options)
      : vertices_(vertices),
        options_(options),
        density_(options.density_radius_pr * resolution),
        salient_(options.salient_radius_pr * resolution),
        non_max_(options.non_max_radius_pr * resolution),
        grid_(PointGrid::for_radius(vertices, std::max(salient_, non_max_), kReach)),
        around_(grid_, kReach),
        crowd_({kWho, "salient or non-maximum radius", std::max(salient_, non_max_), 2000, 110}, grid_.size()),
        close_(grid_.x().size(), 0.0),
        saliency_(grid_.x().size(), 0.0) {
    for (AlignedColumn& moment : moments_) moment.assign(grid_.x().size(), 0.0);
  }

  void run(const ParallelFor& parallel) {
    const AlignedColumn weights =
        grid_.by_slot(options_.weights == IssWeights::None ? Eigen::VectorXd::Ones(vertices_.rows())
                                                           : density_weights(vertices_, density_, parallel));
    visit_cells(grid_, parallel, [&](int first, int last) {
      vectorized([&](auto kind) { scatter<typename decltype(kind)::Lanes>(first, last, weights); });
    });
    constexpr std::size_t kBlock = 4096;
    parallel(static_cast<int>((saliency_.size() + kBlock - 1) / kBlock), [&](int block) {
      const std::size_t first = static_cast<std::size_t>(block) * kBlock;
      vectorized(
          [&](auto kind) { solve<typename decltype(kind)::Lanes>(first, std::min(first + kBlock, saliency_.size())); });
    });
  }

  const PointGrid& grid() const { return grid_; }
  const AlignedColumn& saliency() const { return saliency_; }  ///< by slot

  /// The slots of the local maxima.
  Indices maxima() const {
    return local_maxima(grid_, around_, saliency_, {squared_below(non_max_), std::numeric_limits<double>::min()});
  }

  bool has_company(int slot) const {
    return close_[static_cast<std::size_t>(slot)] >= static_cast<double>(options_.minimum_neighbors);
  }

 private:
  static constexpr int kReach = 2;

  /// The moments of some cells' slots about their own places; none where too few are around.
  template <class Lanes>
  CORRAL_INLINE void scatter(int first_cell, int last_cell, const AlignedColumn& weights) {
    std::int64_t neighbors = 0;
    PackedSlots<4> places;  // and weights
    for (int cell = first_cell; cell < last_cell; ++cell) {
      places.collect<Lanes>({&grid_.x(), &grid_.y(), &grid_.z(), &weights}, around_.begin(cell), around_.end(cell));
      for (int slot = grid_.begin(cell); slot < grid_.end(cell); ++slot) {
        neighbors += scatter_around<Lanes>(static_cast<std::size_t>(slot), places);
        if (crowd_.is_exceeded_by(neighbors)) crowd_.add(neighbors);
      }
    }
    crowd_.add(neighbors);
  }

  /// Returns how many vertices are within the larger radius.
  template <class Lanes>
  CORRAL_INLINE std::int64_t scatter_around(std::size_t slot, const PackedSlots<4>& places) {
    const Lanes zero = Lanes::fill(0), one = Lanes::fill(1), non_max = Lanes::fill(squared_below(non_max_));
    Lanes n = zero, close = zero, w = zero, xx = zero, xy = zero, xz = zero, yy = zero, yz = zero, zz = zero;
    visit_within<Lanes>(places, grid_.x()[slot], grid_.y()[slot], grid_.z()[slot], squared_below(salient_),
                        [&](auto inside, Lanes dx, Lanes dy, Lanes dz, int other) {
                          close = close + select(dx * dx + dy * dy + dz * dz <= non_max, one, zero);
                          const Lanes weight = select(inside, Lanes::load(places[3] + other), zero);
                          dx = select(inside, dx, zero);  // infinite in the padding
                          const Lanes wx = weight * dx, wy = weight * dy, wz = weight * dz;
                          n = n + select(inside, one, zero), w = w + weight;
                          xx = xx + wx * dx, xy = xy + wx * dy, xz = xz + wx * dz;
                          yy = yy + wy * dy, yz = yz + wy * dz, zz = zz + wz * dz;
                        });
    close_[slot] = sum(close);
    const double count = sum(n);
    const auto most = static_cast<std::int64_t>(std::max(count, close_[slot]));
    if (!(count >= static_cast<double>(options_.minimum_neighbors))) return most;
    const double total = options_.weights == IssWeights::None ? 1 : sum(w);
    const Lanes* const sums[] = {&xx, &xy, &xz, &yy, &yz, &zz};
    for (std::size_t i = 0; i < moments_.size(); ++i) moments_[i][slot] = sum(*sums[i]) / total;
    return most;
  }

  template <class Lanes>
  CORRAL_INLINE void solve(std::size_t first, std::size_t last) {
    const Lanes zero = Lanes::fill(0), gamma_21 = Lanes::fill(options_.gamma_21),
                gamma_32 = Lanes::fill(options_.gamma_32), flat = Lanes::fill(kFlat);
    for (std::size_t i = first; i < last; i += kLanes) {
      const auto moment = [&](std::size_t which) { return Lanes::load(&moments_[which][i]); };
      const SymmetricEigen<Lanes> eigen({moment(0), moment(1), moment(2), moment(3), moment(4), moment(5)});
      const Lanes low = smaller(eigen.value[0], eigen.value[1]), high = larger(eigen.value[0], eigen.value[1]);
      const Lanes e1 = larger(high, eigen.value[2]), e3 = smaller(low, eigen.value[2]),
                  e2 = larger(low, smaller(high, eigen.value[2]));
      Lanes saliency = select(flat * e1 < e3, e3, zero);
      saliency = select(e2 < gamma_21 * e1, saliency, zero);
      select(e3 < gamma_32 * e2, saliency, zero).store(&saliency_[i]);
    }
  }

  const Points& vertices_;
  IssOptions options_;
  double density_, salient_, non_max_;
  PointGrid grid_;
  CellNeighborhoods around_;
  CrowdLimit crowd_;
  std::array<AlignedColumn, 6> moments_;  // xx, xy, xz, yy, yz, zz
  AlignedColumn close_;                   // vertices within the radius of suppression
  AlignedColumn saliency_;
};

void check(double resolution, const IssOptions& options) {
  require_positive(kWho, "resolution", resolution);
  validate_options(options, kWho);
}

}  // namespace

Eigen::VectorXd iss_saliency(const Mesh& mesh, double resolution, const IssOptions& options,
                             const ParallelFor& parallel) {
  check(resolution, options);
  SaliencyOperator found(mesh.vertices, resolution, options);
  found.run(parallel);
  Eigen::VectorXd saliency(mesh.vertices.rows());
  for (int slot = 0; slot < found.grid().size(); ++slot)
    saliency(found.grid().row(slot)) = found.saliency()[static_cast<std::size_t>(slot)];
  return saliency;
}

Keypoints detect_iss(const Mesh& mesh, double resolution, const IssOptions& options, const ParallelFor& parallel) {
  check(resolution, options);
  SaliencyOperator found(mesh.vertices, resolution, options);
  found.run(parallel);
  Indices slots = found.maxima();
  Keypoints keypoints;
  keypoints.candidates = static_cast<int>(slots.size());
  slots.erase(std::remove_if(slots.begin(), slots.end(), [&](int slot) { return !found.has_company(slot); }),
              slots.end());
  keypoints.vertices = sorted_rows(found.grid(), slots);
  return keypoints;
}

}  // namespace corral
