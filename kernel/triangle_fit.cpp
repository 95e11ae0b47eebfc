// SPDX-License-Identifier: MIT
#include "kernel/triangle_fit.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/triangle_fit.cpp"
#include <hwy/foreach_target.h>

#include "kernel/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

/// A point in every lane.
struct LanePoint {
  Lanes x, y, z;
};

HWY_INLINE LanePoint operator+(const LanePoint& a, const LanePoint& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
HWY_INLINE LanePoint operator-(const LanePoint& a, const LanePoint& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
HWY_INLINE LanePoint operator*(Lanes factor, const LanePoint& a) { return {factor * a.x, factor * a.y, factor * a.z}; }
HWY_INLINE LanePoint operator/(const LanePoint& a, Lanes divisor) {
  return {a.x / divisor, a.y / divisor, a.z / divisor};
}
HWY_INLINE Lanes dot(const LanePoint& a, const LanePoint& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
HWY_INLINE LanePoint cross(const LanePoint& a, const LanePoint& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// A triangle in coordinates of its own plane: corner 0 at the origin, corner 1 at (along, 0), corner 2 at (x, y), y >= 0.
struct FlatTriangle {
  LanePoint e1, e2, e3;  ///< right-handed; e3 is the normal
  Lanes along, x, y, area;

  static HWY_INLINE FlatTriangle of(const LanePoint (&corners)[3]) {
    FlatTriangle flat;
    const LanePoint a = corners[1] - corners[0], b = corners[2] - corners[0], normal = cross(a, b);
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
struct LaneMotion {
  LanePoint rows[3], translation;
  Lanes usable;  ///< 1, or 0 for a degenerate triangle, whose motion means nothing
};

HWY_INLINE LaneMotion fit_corners(const LanePoint (&source)[3], const LanePoint (&target)[3], double smallest_area) {
  const Lanes three = Lanes::fill(3), zero = Lanes::fill(0), one = Lanes::fill(1);
  const auto p = FlatTriangle::of(source), q = FlatTriangle::of(target);
  const Lanes p_sum = p.along + p.x, q_sum = q.along + q.x;
  const Lanes m11 = p.along * q.along + p.x * q.x - p_sum * q_sum / three;
  const Lanes m12 = p.x * q.y - p_sum * q.y / three;
  const Lanes m21 = p.y * q.x - p.y * q_sum / three;
  const Lanes m22 = p.y * q.y - p.y * q.y / three;
  const Lanes c = m11 + m22, s = m12 - m21, sum = square_root(c * c + s * s);
  const Lanes product = p.along * p.y * q.along * q.y / three;
  const Lanes spread = sum * sum - Lanes::fill(4) * product;
  const Lanes first = Lanes::fill(0.5) * (sum + square_root(larger(spread, zero)));

  const LanePoint f1 = (c / sum) * q.e1 + (s / sum) * q.e2, f2 = (c / sum) * q.e2 - (s / sum) * q.e1;
  LaneMotion motion;
  motion.rows[0] = f1.x * p.e1 + f2.x * p.e2 + q.e3.x * p.e3;
  motion.rows[1] = f1.y * p.e1 + f2.y * p.e2 + q.e3.y * p.e3;
  motion.rows[2] = f1.z * p.e1 + f2.z * p.e2 + q.e3.z * p.e3;
  const LanePoint p_mean = (source[0] + source[1] + source[2]) / three;
  const LanePoint q_mean = (target[0] + target[1] + target[2]) / three;
  motion.translation =
      q_mean - LanePoint{dot(motion.rows[0], p_mean), dot(motion.rows[1], p_mean), dot(motion.rows[2], p_mean)};
  const Lanes limit = Lanes::fill(smallest_area), ratio = Lanes::fill(1e-6);
  motion.usable =
      select(limit < p.area, select(limit < q.area, select(ratio * first * first < product, one, zero), zero), zero);
  return motion;
}

HWY_INLINE void load(const LaneTriangles& triangles, LanePoint (&corners)[3]) {
  for (int corner = 0; corner < 3; ++corner)
    corners[corner] = {Lanes::load(triangles.numbers[corner][0]), Lanes::load(triangles.numbers[corner][1]),
                       Lanes::load(triangles.numbers[corner][2])};
}

HWY_FLATTEN void fit_triangles(const LaneTriangles& source, const LaneTriangles& target, double smallest_area,
                               LaneMotions& motions) {
  LanePoint p[3], q[3];
  load(source, p);
  load(target, q);
  const LaneMotion motion = fit_corners(p, q, smallest_area);
  const LanePoint points[4] = {motion.rows[0], motion.rows[1], motion.rows[2], motion.translation};
  for (int i = 0; i < 4; ++i) {
    points[i].x.store(motions.numbers[3 * i]);
    points[i].y.store(motions.numbers[3 * i + 1]);
    points[i].z.store(motions.numbers[3 * i + 2]);
  }
  motion.usable.store(motions.numbers[12]);
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(fit_triangles);

void fit_triangles(const LaneTriangles& source, const LaneTriangles& target, double smallest_area,
                   LaneMotions& motions) {
  HWY_DYNAMIC_DISPATCH(fit_triangles)(source, target, smallest_area, motions);
}

}  // namespace corral
#endif
