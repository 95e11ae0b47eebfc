// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/vectorized.h"

namespace corral {

/// A point in every lane.
template <class Lanes>
struct LanePoint {
  Lanes x, y, z;
};

template <class Lanes>
CORRAL_INLINE LanePoint<Lanes> operator+(const LanePoint<Lanes>& a, const LanePoint<Lanes>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Lanes>
CORRAL_INLINE LanePoint<Lanes> operator-(const LanePoint<Lanes>& a, const LanePoint<Lanes>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Lanes>
CORRAL_INLINE LanePoint<Lanes> operator*(Lanes factor, const LanePoint<Lanes>& a) {
  return {factor * a.x, factor * a.y, factor * a.z};
}
template <class Lanes>
CORRAL_INLINE LanePoint<Lanes> operator/(const LanePoint<Lanes>& a, Lanes divisor) {
  return {a.x / divisor, a.y / divisor, a.z / divisor};
}
template <class Lanes>
CORRAL_INLINE Lanes dot(const LanePoint<Lanes>& a, const LanePoint<Lanes>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Lanes>
CORRAL_INLINE LanePoint<Lanes> cross(const LanePoint<Lanes>& a, const LanePoint<Lanes>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// A triangle in coordinates of its own plane: corner 0 at the origin, corner 1 at (along, 0), corner 2 at (x, y), y >= 0.
template <class Lanes>
struct FlatTriangle {
  LanePoint<Lanes> e1, e2, e3;  ///< right-handed; e3 is the normal
  Lanes along, x, y, area;

  static CORRAL_INLINE FlatTriangle of(const LanePoint<Lanes> (&corners)[3]) {
    FlatTriangle flat;
    const LanePoint<Lanes> a = corners[1] - corners[0], b = corners[2] - corners[0], normal = cross(a, b);
    const Lanes length = square_root(dot(normal, normal));
    flat.along = square_root(dot(a, a));
    flat.e1 = a / flat.along;
    flat.e3 = normal / length;
    flat.e2 = cross(flat.e3, flat.e1);
    flat.x = dot(b, flat.e1);
    flat.y = dot(b, flat.e2);
    flat.area = Lanes::fill(0.5) * length;
    return flat;
  }
};

/// The rigid motion q = R p + t of each lane.
template <class Lanes>
struct LaneMotion {
  LanePoint<Lanes> rows[3], translation;
  Lanes usable;  ///< 1, or 0 for a degenerate triangle, whose motion is meaningless
};

/// Least-squares rigid motion of one triangle to another: the result of fit_rigid_transform() in closed form.
///
/// The best motion lays plane on plane, normal on normal, centroid on centroid. In the planes, with corners P_i and Q_i
/// about their centroids and M = sum P_i Q_i^T, what is left is one angle: (cos, sin) ~ (M11 + M22, M12 - M21). Since
/// det M = 4/3 area area' >= 0, no mirrored motion is better. The singular values of M have the sum |(cos, sin)| and the
/// product det M.
///
/// Degenerate: an area of at most `smallest_area` on either side, the second singular value at most 1e-6 of the first, or
/// anything that is not finite.
/// Source    [kabsch1976solution], specialised.
template <class Lanes>
CORRAL_INLINE LaneMotion<Lanes> fit_triangle(const LanePoint<Lanes> (&source)[3], const LanePoint<Lanes> (&target)[3],
                                             double smallest_area) {
  const Lanes three = Lanes::fill(3), zero = Lanes::fill(0), one = Lanes::fill(1);
  const auto p = FlatTriangle<Lanes>::of(source), q = FlatTriangle<Lanes>::of(target);
  const Lanes p_sum = p.along + p.x, q_sum = q.along + q.x;
  const Lanes m11 = p.along * q.along + p.x * q.x - p_sum * q_sum / three;
  const Lanes m12 = p.x * q.y - p_sum * q.y / three;
  const Lanes m21 = p.y * q.x - p.y * q_sum / three;
  const Lanes m22 = p.y * q.y - p.y * q.y / three;
  const Lanes c = m11 + m22, s = m12 - m21, sum = square_root(c * c + s * s);
  const Lanes product = p.along * p.y * q.along * q.y / three;
  const Lanes spread = sum * sum - Lanes::fill(4) * product;
  const Lanes first = Lanes::fill(0.5) * (sum + square_root(larger(spread, zero)));

  const LanePoint<Lanes> f1 = (c / sum) * q.e1 + (s / sum) * q.e2, f2 = (c / sum) * q.e2 - (s / sum) * q.e1;
  LaneMotion<Lanes> motion;
  motion.rows[0] = f1.x * p.e1 + f2.x * p.e2 + q.e3.x * p.e3;
  motion.rows[1] = f1.y * p.e1 + f2.y * p.e2 + q.e3.y * p.e3;
  motion.rows[2] = f1.z * p.e1 + f2.z * p.e2 + q.e3.z * p.e3;
  const LanePoint<Lanes> p_mean = (source[0] + source[1] + source[2]) / three;
  const LanePoint<Lanes> q_mean = (target[0] + target[1] + target[2]) / three;
  motion.translation =
      q_mean - LanePoint<Lanes>{dot(motion.rows[0], p_mean), dot(motion.rows[1], p_mean), dot(motion.rows[2], p_mean)};
  const Lanes limit = Lanes::fill(smallest_area), ratio = Lanes::fill(1e-6);
  motion.usable =
      select(limit < p.area, select(limit < q.area, select(ratio * first * first < product, one, zero), zero), zero);
  return motion;
}

}  // namespace corral
