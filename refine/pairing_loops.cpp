// SPDX-License-Identifier: MIT
#include "refine/pairing_loops.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "refine/pairing_loops.cpp"
#include <hwy/foreach_target.h>

#include "kernel/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

HWY_FLATTEN void agree(const NormalColumns& normals, const Eigen::Matrix3d& rotation, double least_cosine) {
  const Lanes zero = Lanes::fill(0);
  Lanes turned[3], agreements = zero;
  const auto turn = [&](std::size_t i) HWY_ATTR {
    for (int axis = 0; axis < 3; ++axis) {
      turned[axis] = zero;
      for (int j = 0; j < 3; ++j)
        turned[axis] = turned[axis] + Lanes::fill(rotation(axis, j)) * Lanes::load(normals.source[j] + i);
    }
  };
  for (std::size_t i = 0; i < normals.size; i += kLanes) {
    turn(i);
    Lanes agreement = zero;
    for (int axis = 0; axis < 3; ++axis) agreement = agreement + turned[axis] * Lanes::load(normals.target[axis] + i);
    agreement.store(normals.agreement + i);
    agreements = agreements + agreement;
  }
  const Lanes side = Lanes::fill(sum(agreements) < 0 ? -1 : 1), least = Lanes::fill(least_cosine);
  for (std::size_t i = 0; i < normals.size; i += kLanes) {
    turn(i);
    select(least <= side * Lanes::load(normals.agreement + i), Lanes::load(normals.is_pair + i), zero)
        .store(normals.is_pair + i);
    Lanes mean[3], squared = zero;
    for (int axis = 0; axis < 3; ++axis) {
      mean[axis] = Lanes::load(normals.target[axis] + i) + side * turned[axis];
      squared = squared + mean[axis] * mean[axis];
    }
    const Lanes length = square_root(squared);
    for (int axis = 0; axis < 3; ++axis) (mean[axis] / length).store(normals.target[axis] + i);
  }
}

/// Eight pairs, or fewer: the moved points m in pr about a centre, d = m - q in pr, the normals n, and 1; all are zero where
/// there is no pair.
struct PairLanes {
  Lanes m[3], d[3], n[3], one;
};

/// The columns whose products make up the sums: of a plane pair the 13 of its residual, of a point pair those that its three
/// residuals share.
struct PlaneColumns {
  static constexpr int kWidth = 13;
  static constexpr bool kWithNormals = true;
  static HWY_INLINE void set(const PairLanes& pair, Lanes* columns) {
    for (int axis = 0; axis < 3; ++axis)
      for (int j = 0; j < 3; ++j) columns[3 * axis + j] = pair.m[axis] * pair.n[j];
    for (int j = 0; j < 3; ++j) columns[9 + j] = pair.n[j];
    columns[12] = pair.n[0] * pair.d[0] + pair.n[1] * pair.d[1] + pair.n[2] * pair.d[2];
  }
};

struct PointColumns {
  static constexpr int kWidth = 7;
  static constexpr bool kWithNormals = false;
  static HWY_INLINE void set(const PairLanes& pair, Lanes* columns) {
    for (int axis = 0; axis < 3; ++axis) columns[axis] = pair.m[axis];
    columns[3] = pair.one;
    for (int axis = 0; axis < 3; ++axis) columns[4 + axis] = pair.d[axis];
  }
};

/// The columns of the point-to-plane equations: arm x normal, normal. The arm stands in the place of m.
struct EquationColumns {
  static constexpr int kWidth = 6;
  static constexpr bool kWithNormals = true;
  static HWY_INLINE void set(const PairLanes& pair, Lanes* columns) {
    for (int axis = 0; axis < 3; ++axis) {
      const int next = (axis + 1) % 3, last = (axis + 2) % 3;
      columns[axis] = pair.m[next] * pair.n[last] - pair.m[last] * pair.n[next];
      columns[3 + axis] = pair.n[axis];
    }
  }
};

template <bool kWithNormals>
HWY_INLINE PairLanes eight_pairs(const PairColumns& columns, std::size_t first) {
  PairLanes pairs;
  const Lanes zero = Lanes::fill(0), scale = Lanes::fill(columns.scale);
  pairs.one = Lanes::load(columns.is_pair + first);
  for (int axis = 0; axis < 3; ++axis) {
    const Lanes m = Lanes::load(&columns.places[axis][first]) - Lanes::fill(columns.centre(axis)),
                d = Lanes::load(&columns.source[axis][first]) - Lanes::load(&columns.target[axis][first]);
    pairs.m[axis] = select(zero < pairs.one, m * scale, zero);
    pairs.d[axis] = select(zero < pairs.one, d * scale, zero);
    pairs.n[axis] = zero;
    if (kWithNormals) pairs.n[axis] = select(zero < pairs.one, Lanes::load(&columns.normals[axis][first]), zero);
  }
  return pairs;
}

template <class Columns>
HWY_FLATTEN void add(const PairColumns& pairs, std::size_t begin, std::size_t end, double* result) {
  constexpr int kWidth = Columns::kWidth;
  Lanes sums[kWidth][kWidth];
  for (int i = 0; i < kWidth; ++i)
    for (int j = 0; j <= i; ++j) sums[i][j] = Lanes::fill(0);
  for (std::size_t first = begin; first < end; first += kLanes) {
    Lanes columns[kWidth];
    Columns::set(eight_pairs<Columns::kWithNormals>(pairs, first), columns);
    for (int i = 0; i < kWidth; ++i)
      for (int j = 0; j <= i; ++j) sums[i][j] = sums[i][j] + columns[i] * columns[j];
  }
  for (int i = 0; i < kWidth; ++i)
    for (int j = 0; j <= i; ++j) result[i * kWidth + j] = result[j * kWidth + i] = sum(sums[i][j]);
}

void add_products(PairProducts products, const PairColumns& pairs, std::size_t begin, std::size_t end, double* result) {
  switch (products) {
    case PairProducts::OfPlanes:
      return add<PlaneColumns>(pairs, begin, end, result);
    case PairProducts::OfPoints:
      return add<PointColumns>(pairs, begin, end, result);
    case PairProducts::OfEquations:
      return add<EquationColumns>(pairs, begin, end, result);
  }
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(agree);
HWY_EXPORT(add_products);

void agree(const NormalColumns& normals, const Eigen::Matrix3d& rotation, double least_cosine) {
  HWY_DYNAMIC_DISPATCH(agree)(normals, rotation, least_cosine);
}

int width_of(PairProducts products) {
  return products == PairProducts::OfPlanes ? 13 : products == PairProducts::OfPoints ? 7 : 6;
}

Eigen::MatrixXd add_products(PairProducts products, const PairColumns& pairs, std::size_t begin, std::size_t end) {
  Eigen::MatrixXd sums(width_of(products), width_of(products));
  HWY_DYNAMIC_DISPATCH(add_products)(products, pairs, begin, end, sums.data());
  return sums;
}

}  // namespace corral
#endif
