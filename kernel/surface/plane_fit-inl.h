// SPDX-License-Identifier: MIT
// The arithmetic of a plane through the points around a vertex, on lanes. Compiled once for each target; only sources with
// foreach_target.h include this.
#if defined(CORRAL_KERNEL_SURFACE_PLANE_FIT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef CORRAL_KERNEL_SURFACE_PLANE_FIT_INL_H
#undef CORRAL_KERNEL_SURFACE_PLANE_FIT_INL_H
#else
#define CORRAL_KERNEL_SURFACE_PLANE_FIT_INL_H
#endif

#include <algorithm>
#include <cstddef>
#include <limits>

#include "kernel/parallel.h"
#include "kernel/surface/search/packed_slots-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {

/// Second moments of some vectors: xx, xy, xz, yy, yz, zz.
template <class Number>
struct Moments {
  Number xx, xy, xz, yy, yz, zz;
};

/// Eight eigenproblems of symmetric 3 x 3 matrices at once: eigenvalues on the diagonal, in no order, and eigenvectors in
/// columns. Cyclic Jacobi rotations: accurate to rounding whatever the gaps between the eigenvalues.
template <class Lanes>
struct SymmetricEigen {
  Lanes value[3];
  Lanes vector[3][3];  ///< [component][which]

  HWY_INLINE explicit SymmetricEigen(const Moments<Lanes>& m) {
    Lanes a[3][3] = {{m.xx, m.xy, m.xz}, {m.xy, m.yy, m.yz}, {m.xz, m.yz, m.zz}};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) vector[i][j] = Lanes::fill(i == j ? 1 : 0);
    constexpr int kSweeps = 4;  // off-diagonals shrink quadratically: rounding is reached after four
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      rotate(a, 0, 1, 2);
      rotate(a, 0, 2, 1);
      rotate(a, 1, 2, 0);
    }
    for (int i = 0; i < 3; ++i) value[i] = a[i][i];
  }

 private:
  /// Makes a[p][q] zero; r is the third index.
  HWY_INLINE void rotate(Lanes (&a)[3][3], int p, int q, int r) {
    const Lanes zero = Lanes::fill(0), one = Lanes::fill(1);
    const auto is_zero = a[p][q] == zero;
    const Lanes theta = (a[q][q] - a[p][p]) / (a[p][q] + a[p][q]);
    const Lanes size = select(theta < zero, zero - theta, theta);
    const Lanes unsigned_tangent = one / (size + square_root(theta * theta + one));
    const Lanes tangent = select(is_zero, zero, select(theta < zero, zero - unsigned_tangent, unsigned_tangent));
    const Lanes cosine = one / square_root(tangent * tangent + one), sine = tangent * cosine;
    const Lanes shift = tangent * a[p][q];
    a[p][p] = a[p][p] - shift;
    a[q][q] = a[q][q] + shift;
    a[p][q] = a[q][p] = zero;
    const Lanes to_p = cosine * a[r][p] - sine * a[r][q], to_q = sine * a[r][p] + cosine * a[r][q];
    a[r][p] = a[p][r] = to_p;
    a[r][q] = a[q][r] = to_q;
    for (int i = 0; i < 3; ++i) {
      const Lanes vp = vector[i][p], vq = vector[i][q];
      vector[i][p] = cosine * vp - sine * vq;
      vector[i][q] = sine * vp + cosine * vq;
    }
  }
};

/// Columns of moments about the mean, one row per fitted vertex, and the normals that they become.
struct PlaneFits {
  AlignedColumn xx, xy, xz, yy, yz, zz;
  AlignedColumn nx, ny, nz;

  /// Room for so many and a load behind the last, filled up to the step of solve().
  explicit PlaneFits(int count) {
    for (AlignedColumn* column : {&xx, &xy, &xz, &yy, &yz, &zz, &nx, &ny, &nz})
      column->assign(static_cast<std::size_t>((count + kLanes + 31) / 32 * 32), 0.0);
  }

  /// The moments of the points around a slot within a squared distance; returns how many there are.
  HWY_INLINE int fit(std::size_t slot, const PointGrid& grid, const PackedSlots<3>& around, double squared) {
    const Lanes zero = Lanes::fill(0), one = Lanes::fill(1);
    Lanes n = zero, sx = zero, sy = zero, sz = zero, sxx = zero, sxy = zero, sxz = zero, syy = zero, syz = zero,
          szz = zero;
    visit_within(around, grid.x()[slot], grid.y()[slot], grid.z()[slot], squared,
                 [&](auto inside, Lanes dx, Lanes dy, Lanes dz, int) HWY_ATTR {
                   dx = select(inside, dx, zero), dy = select(inside, dy, zero), dz = select(inside, dz, zero);
                   n = n + select(inside, one, zero);
                   sx = sx + dx, sy = sy + dy, sz = sz + dz;
                   sxx = sxx + dx * dx, sxy = sxy + dx * dy, sxz = sxz + dx * dz;
                   syy = syy + dy * dy, syz = syz + dy * dz, szz = szz + dz * dz;
                 });
    const Sums sums{sum(n), sum(sx), sum(sy), sum(sz), {sum(sxx), sum(sxy), sum(sxz), sum(syy), sum(syz), sum(szz)}};
    put(slot, sums);
    return static_cast<int>(sums.count);
  }

  /// The moments of so many chosen points about one of them; the columns go on with that one up to a multiple of eight.
  /// Returns the squared distance of the nearest in another place, infinite if there is none.
  HWY_INLINE double fit_chosen(std::size_t at, const double* x, const double* y, const double* z, int count,
                               double own_x, double own_y, double own_z) {
    const Lanes zero = Lanes::fill(0), cx = Lanes::fill(own_x), cy = Lanes::fill(own_y), cz = Lanes::fill(own_z),
                none = Lanes::fill(std::numeric_limits<double>::infinity());
    Lanes sx = zero, sy = zero, sz = zero, sxx = zero, sxy = zero, sxz = zero, syy = zero, syz = zero, szz = zero,
          nearest = none;
    for (int i = 0; i < count; i += kLanes) {
      const Lanes dx = Lanes::load(x + i) - cx, dy = Lanes::load(y + i) - cy, dz = Lanes::load(z + i) - cz;
      const Lanes squared = dx * dx + dy * dy + dz * dz;
      nearest = smaller(nearest, select(zero < squared, squared, none));
      sx = sx + dx, sy = sy + dy, sz = sz + dz;
      sxx = sxx + dx * dx, sxy = sxy + dx * dy, sxz = sxz + dx * dz;
      syy = syy + dy * dy, syz = syz + dy * dz, szz = szz + dz * dz;
    }
    const Moments<double> moments{sum(sxx), sum(sxy), sum(sxz), sum(syy), sum(syz), sum(szz)};
    put(at, {static_cast<double>(count), sum(sx), sum(sy), sum(sz), moments});
    return smallest(nearest);
  }

  /// All normals, in blocks.
  void solve_all(const ParallelFor& parallel) {
    constexpr std::size_t kBlock = 4096;
    parallel(static_cast<int>((xx.size() + kBlock - 1) / kBlock), [this](int block) HWY_ATTR {
      const auto first = static_cast<std::size_t>(block) * kBlock;
      solve(first, std::min(first + kBlock, xx.size()));
    });
  }

 private:
  /// Over offsets from a vertex.
  struct Sums {
    double count, x, y, z;
    Moments<double> m;
  };

  /// Keeps the moments about the mean.
  void put(std::size_t at, const Sums& s) {
    const double share = s.count > 0 ? 1 / s.count : 0;
    xx[at] = s.m.xx - s.x * s.x * share, xy[at] = s.m.xy - s.x * s.y * share, xz[at] = s.m.xz - s.x * s.z * share;
    yy[at] = s.m.yy - s.y * s.y * share, yz[at] = s.m.yz - s.y * s.z * share, zz[at] = s.m.zz - s.z * s.z * share;
  }

  /// Normals from moments: the direction of least variance; zero where fewer than two directions have any (too few points,
  /// or all on one line).
  HWY_FLATTEN void solve(std::size_t first, std::size_t last) {
    using Four = Pair<Pair<Lanes>>;  // four chains of divisions and roots at once hide their latency
    for (std::size_t i = first; i < last; i += Four::kCount) {
      const SymmetricEigen<Four> eigen({Four::load(&xx[i]), Four::load(&xy[i]), Four::load(&xz[i]), Four::load(&yy[i]),
                                        Four::load(&yz[i]), Four::load(&zz[i])});
      const Four &a = eigen.value[0], &b = eigen.value[1], &c = eigen.value[2];
      const Four low_ab = select(a <= b, a, b), high_ab = select(a <= b, b, a);
      const Four largest = select(high_ab <= c, c, high_ab);
      const Four below = select(high_ab <= c, high_ab, c), middle = select(below <= low_ab, low_ab, below);
      const auto is_plane = Four::fill(1e-12) * largest < middle;
      const auto pick = [&](int component) HWY_ATTR {
        const Four(&v)[3] = eigen.vector[component];
        const Four of_low = select(a <= b, v[0], v[1]);
        return select(is_plane, select(low_ab <= c, of_low, v[2]), Four::fill(0));
      };
      pick(0).store(&nx[i]), pick(1).store(&ny[i]), pick(2).store(&nz[i]);
    }
  }
};

}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
