// SPDX-License-Identifier: MIT
#include "kernel/surface/harris.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernel/error.h"
#include "kernel/surface/crowd_limit.h"
#include "kernel/surface/local_maxima.h"
#include "kernel/surface/plane_fit.h"
#include "kernel/surface/search/point_grid.h"

namespace corral {
namespace {

constexpr double kSmallestResponse = 1e-9;
constexpr int kCellsPerBlock = 256;

int block_count(const PointGrid& grid) { return (grid.cells() + kCellsPerBlock - 1) / kCellsPerBlock; }

/// The response of every slot, in two passes over the neighbourhoods of all of them.
class HarrisOperator {
 public:
  HarrisOperator(const PointGrid& grid, const CellNeighborhoods& around, double radius)
      : grid_(grid),
        around_(around),
        squared_(radius * radius),
        crowd_({"detect_harris", "keypoint radius", radius, 500, 30}, grid.size()),
        fits_(grid.size()),
        response_(grid.x().size(), 0.0) {}

  AlignedColumn run(const ParallelFor& parallel) {
    parallel(block_count(grid_), [this](int block) {
      vectorized([&](auto kind) { fit<typename decltype(kind)::Lanes>(block_of(block)); });
    });
    fits_.solve_all(parallel);
    parallel(block_count(grid_), [this](int block) {
      vectorized([&](auto kind) { respond<typename decltype(kind)::Lanes>(block_of(block)); });
    });
    return std::move(response_);
  }

 private:
  struct Block {
    int first_cell, last_cell;
  };
  Block block_of(int block) const {
    const int first = block * kCellsPerBlock, last = std::min(grid_.cells(), first + kCellsPerBlock);
    return {first, last};
  }

  template <class Lanes>
  CORRAL_INLINE void fit(const Block& block) {
    std::int64_t neighbors = 0;
    PackedSlots<3> places;
    for (int cell = block.first_cell; cell < block.last_cell; ++cell) {
      places.collect<Lanes>({&grid_.x(), &grid_.y(), &grid_.z()}, around_.begin(cell), around_.end(cell));
      for (int slot = grid_.begin(cell); slot < grid_.end(cell); ++slot) {
        neighbors += fits_.fit<Lanes>(static_cast<std::size_t>(slot), grid_, places, squared_);
        if (crowd_.is_exceeded_by(neighbors)) crowd_.add(neighbors);  // to the end of a crowd it would take long
      }
    }
    crowd_.add(neighbors);
  }

  template <class Lanes>
  CORRAL_INLINE void respond(const Block& block) {
    PackedSlots<6> places;  // and normals
    for (int cell = block.first_cell; cell < block.last_cell; ++cell) {
      places.collect<Lanes>({&grid_.x(), &grid_.y(), &grid_.z(), &fits_.nx, &fits_.ny, &fits_.nz}, around_.begin(cell),
                            around_.end(cell));
      for (int i = grid_.begin(cell); i < grid_.end(cell); ++i) {
        const auto slot = static_cast<std::size_t>(i);
        const Lanes zero = Lanes::fill(0);
        Lanes xx = zero, xy = zero, xz = zero, yy = zero, yz = zero, zz = zero;
        const double *nx = places[3], *ny = places[4], *nz = places[5];
        visit_within<Lanes>(places, grid_.x()[slot], grid_.y()[slot], grid_.z()[slot], squared_,
                            [&](auto inside, Lanes, Lanes, Lanes, int other) {
                              const Lanes a = select(inside, Lanes::load(nx + other), zero),
                                          b = select(inside, Lanes::load(ny + other), zero),
                                          c = select(inside, Lanes::load(nz + other), zero);
                              xx = xx + a * a, xy = xy + a * b, xz = xz + a * c;
                              yy = yy + b * b, yz = yz + b * c, zz = zz + c * c;
                            });
        response_[slot] = determinant({sum(xx), sum(xy), sum(xz), sum(yy), sum(yz), sum(zz)});
      }
    }
  }

  /// det of the mean: unit vectors have as many in the sum as its trace says.
  static double determinant(const Moments<double>& m) {
    const double trace = m.xx + m.yy + m.zz;
    if (!(trace > 0)) return 0;
    return (m.xx * (m.yy * m.zz - m.yz * m.yz) - m.xy * (m.xy * m.zz - m.yz * m.xz) +
            m.xz * (m.xy * m.yz - m.yy * m.xz)) /
           (trace * trace * trace);
  }

  const PointGrid& grid_;
  const CellNeighborhoods& around_;
  double squared_;
  CrowdLimit crowd_;
  PlaneFits fits_;
  AlignedColumn response_;
};

}  // namespace

Eigen::VectorXd harris_response(const Points& vertices, double radius, const ParallelFor& parallel) {
  require_positive("harris_response", "radius", radius);
  const PointGrid grid = PointGrid::for_radius(vertices, radius, 1);
  const CellNeighborhoods around(grid, 1);
  const AlignedColumn by_slot = HarrisOperator(grid, around, radius).run(parallel);
  Eigen::VectorXd response(vertices.rows());
  for (int slot = 0; slot < grid.size(); ++slot) response(grid.row(slot)) = by_slot[static_cast<std::size_t>(slot)];
  return response;
}

Keypoints detect_harris(const Points& vertices, double resolution, const HarrisOptions& options,
                        const ParallelFor& parallel) {
  require_positive("detect_harris", "resolution", resolution);
  validate_options(options, "detect_harris");
  const double radius = options.radius_pr * resolution;
  const PointGrid grid = PointGrid::for_radius(vertices, radius, 1);
  const CellNeighborhoods around(grid, 1);
  Keypoints keypoints;
  const AlignedColumn response = HarrisOperator(grid, around, radius).run(parallel);
  keypoints.vertices = sorted_rows(grid, local_maxima(grid, around, response, {radius * radius, kSmallestResponse}));
  keypoints.candidates = static_cast<int>(keypoints.vertices.size());
  return keypoints;
}

}  // namespace corral
