// SPDX-License-Identifier: MIT
// Compiled with contraction: a multiplication and an addition may be one instruction.
#include "grouping/pose/triple_filter.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "grouping/pose/triple_filter.cpp"
#include <hwy/foreach_target.h>

#include "kernel/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

HWY_INLINE Lanes all(double number) { return Lanes::fill(number); }

struct Vector {
  Lanes x, y, z;

  HWY_INLINE Lanes on(int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
};
HWY_INLINE Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
HWY_INLINE Vector operator*(const Vector& a, Lanes factor) { return {a.x * factor, a.y * factor, a.z * factor}; }
HWY_INLINE Lanes dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
HWY_INLINE Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// As FlatTriangle in kernel/triangle_fit.cpp.
struct Flat {
  Vector e1, e2, e3, mean;
  Lanes along, x, y;

  static HWY_INLINE Flat of(const LaneTriangles& triangles) {
    Vector corners[3];
    for (int corner = 0; corner < 3; ++corner)
      corners[corner] = {Lanes::load(triangles.numbers[corner][0]), Lanes::load(triangles.numbers[corner][1]),
                         Lanes::load(triangles.numbers[corner][2])};
    const Vector a = corners[1] - corners[0], b = corners[2] - corners[0], normal = cross(a, b);
    const Lanes length = square_root(dot(normal, normal)), third = all(1.0 / 3);
    Flat flat;
    flat.along = square_root(dot(a, a));
    const Lanes per_length = all(1) / flat.along;
    flat.e1 = a * per_length;
    flat.e3 = normal * (all(1) / length);
    flat.e2 = cross(flat.e3, flat.e1);
    flat.x = dot(b, flat.e1);
    flat.y = length * per_length;
    flat.mean = {(corners[0].x + corners[1].x + corners[2].x) * third,
                 (corners[0].y + corners[1].y + corners[2].y) * third,
                 (corners[0].z + corners[1].z + corners[2].z) * third};
    return flat;
  }
};

HWY_FLATTEN void set_planes(const LaneTriangles& source, const LaneTriangles& target, const double (&origin)[4],
                            int axis, double per_unit, int first, TripleFilter::Planes& planes) {
  const auto p = Flat::of(source), q = Flat::of(target);
  const Lanes q1 = q.e1.on(axis), q2 = q.e2.on(axis), q3 = q.e3.on(axis);
  const Lanes third = all(1.0 / 3);
  const Lanes p_sum = p.along + p.x, q_sum = (q.along + q.x) * third;
  const Lanes c = p.along * q.along + p.x * q.x - p_sum * q_sum + p.y * q.y * all(2.0 / 3);
  const Lanes s = p.x * q.y - p_sum * q.y * third - p.y * q.x + p.y * q_sum;
  const Lanes per_sum = all(1) / square_root(c * c + s * s), cosine = c * per_sum, sine = s * per_sum;
  const Lanes f1 = cosine * q1 + sine * q2, f2 = cosine * q2 - sine * q1;
  const Vector normal = {f1 * p.e1.x + f2 * p.e2.x + q3 * p.e3.x, f1 * p.e1.y + f2 * p.e2.y + q3 * p.e3.y,
                         f1 * p.e1.z + f2 * p.e2.z + q3 * p.e3.z};
  const Vector mean = p.mean - Vector{all(origin[0]), all(origin[1]), all(origin[2])};
  normal.x.store(planes.normal[0] + first);
  normal.y.store(planes.normal[1] + first);
  normal.z.store(planes.normal[2] + first);
  ((q.mean.on(axis) - all(origin[3]) - dot(normal, mean)) * all(per_unit)).store(planes.offset + first);
}

HWY_FLATTEN unsigned possible(const FilterTable& table, float reach, int hopeless, int looked_at,
                              TripleFilter::Planes& planes) {
  constexpr int kStretch = 16;  // rows between two looks at the counts
  const Floats one = Floats::fill(1), most = Floats::fill(static_cast<float>(table.rows() - 1 - hopeless));
  const Floats near = Floats::fill(reach), offset = Floats::load(planes.offset);
  const Floats n[3] = {Floats::load(planes.normal[0]), Floats::load(planes.normal[1]), Floats::load(planes.normal[2])};
  const float *x = table.source(0), *y = table.source(1), *z = table.source(2), *to = table.target(planes.axis);
  const auto counted = [&](Floats missed, int row) HWY_ATTR {
    const Floats residual = n[0] * Floats::fill(x[row]) + n[1] * Floats::fill(y[row]) + n[2] * Floats::fill(z[row]) +
                            (offset - Floats::fill(to[row]));
    return select(magnitude(residual) <= near, missed, missed + one);
  };
  Floats missed = Floats::fill(0), missed_too = missed;  // of every second row: neither addition waits for the other
  unsigned can = bits(missed <= most);
  const int end = std::min(looked_at, table.rows()) / 2 * 2;
  for (int first = 0; first < end && can != 0; first += kStretch) {
    const int last = std::min(first + kStretch, end);
    for (int row = first; row < last; row += 2) {
      missed = counted(missed, row);
      missed_too = counted(missed_too, row + 1);
    }
    can = bits(missed + missed_too <= most);
  }
  (Floats::fill(static_cast<float>(table.rows())) - (missed + missed_too)).store(planes.most);
  return can;
}

HWY_FLATTEN void set_filters(const FilterTable& table, double tolerance, const LaneMotions& motions,
                             LaneFilters& poses) {
  const auto number = [&](int i) HWY_ATTR { return Lanes::load(motions.numbers[i]); };
  const auto reach = [](Lanes x, Lanes y, Lanes z) HWY_ATTR { return magnitude(x) + magnitude(y) + magnitude(z); };
  const Eigen::Vector3d &p = table.source_origin(), &q = table.target_origin();
  const Lanes per_unit = all(1 / table.unit()), zero = all(0);
  Lanes moved[3];
  for (int axis = 0; axis < 3; ++axis)
    moved[axis] = (number(3 * axis) * all(p(0)) + number(3 * axis + 1) * all(p(1)) + number(3 * axis + 2) * all(p(2)) +
                   number(9 + axis) - all(q(axis))) *
                  per_unit;
  const Lanes far = (reach(number(9), number(10), number(11)) + all(p.lpNorm<1>() + q.lpNorm<1>())) * per_unit;
  const Lanes error =
      all(0x1p-24) * (all(64) + all(16) * reach(moved[0], moved[1], moved[2])) + all(0x1p-48) * (far + all(4));
  const Lanes most = all(table.is_blind() ? 0 : 0x1p10);
  const auto or_blind = [&](Lanes lanes) HWY_ATTR { return select(error < most, lanes, zero); };
  for (int i = 0; i < 9; ++i) or_blind(number(i)).store(poses.rotation[i]);
  for (int axis = 0; axis < 3; ++axis) or_blind(moved[axis]).store(poses.translation[axis]);
  (select(error < most, all(std::min(tolerance / table.unit(), 8.0)) - error, all(-1)) * all(1 - 0x1p-20))
      .store(poses.within);
  const Lanes limit = select(error < most, all(std::min(tolerance / table.unit(), 0x1p40)) + error, all(0x1p40));
  (limit * all(1 + 0x1p-20)).store(poses.reach);
  (limit * limit * all(1 + 0x1p-20)).store(poses.possible);
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(set_planes);
HWY_EXPORT(possible);
HWY_EXPORT(set_filters);

TripleFilter::TripleFilter(const FilterTable& table, double tolerance, double smallest_area)
    : source_origin_(table.source_origin()), target_origin_(table.target_origin()), unit_(table.unit()), planes_{} {
  std::fill_n(planes_.most, kFloatLanes, 0x1p29F);  // before the first call nothing is known
  const double far = table.source_origin().lpNorm<1>() + table.target_origin().lpNorm<1>();
  const double error = 0x1p-16 + 0x1p-45 * (far / unit_ + 4) + 0x1p-40 * unit_ * (unit_ / smallest_area);
  reach_ = static_cast<float>((std::min(tolerance / unit_, 8.0) + error) * (1 + 0x1p-20));
  is_sharp_ = !table.is_blind() && unit_ > 0x1p-200 && unit_ < 0x1p200 && error < 0x1p-4;
}

void TripleFilter::set(const LaneTriangles& source, const LaneTriangles& target, int first) {
  const double origin[4] = {source_origin_(0), source_origin_(1), source_origin_(2), target_origin_(axis_)};
  planes_.axis = axis_;
  HWY_DYNAMIC_DISPATCH(set_planes)(source, target, origin, axis_, 1 / unit_, first, planes_);
}

unsigned TripleFilter::possible(const FilterTable& rows, int hopeless, int looked_at) {
  const unsigned left = HWY_DYNAMIC_DISPATCH(possible)(rows, reach_, hopeless, looked_at, planes_);
  if (trials_ < kTrials) {
    left_on_[planes_.axis] += hwy::PopCount(left);
    axis_ = ++trials_ < kTrials ? trials_ % 3 : static_cast<int>(std::min_element(left_on_, left_on_ + 3) - left_on_);
  }
  return left;
}

LaneFilters::LaneFilters(const FilterTable& table, const LaneMotions& motions, double tolerance) {
  HWY_DYNAMIC_DISPATCH(set_filters)(table, tolerance, motions, *this);
}

PoseFilter LaneFilters::get(int lane) const {
  PoseFilter pose;
  for (int i = 0; i < 9; ++i) pose.rotation[i] = rotation[i][lane];
  for (int axis = 0; axis < 3; ++axis) pose.translation[axis] = translation[axis][lane];
  pose.reach = reach[lane], pose.possible = possible[lane], pose.certain = 0;
  return pose;
}

}  // namespace corral
#endif
