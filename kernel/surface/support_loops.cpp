// SPDX-License-Identifier: MIT
#include "kernel/surface/support_loops.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/surface/support_loops.cpp"
#include <hwy/foreach_target.h>

#include "kernel/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

HWY_FLATTEN void collect_support(const SlotColumns& columns, std::size_t slot, double squared,
                                 const std::vector<SlotRange>& ranges, Support& support) {
  const double* const* const from = columns.column;
  const Lanes x = Lanes::fill(from[0][slot]), y = Lanes::fill(from[1][slot]), z = Lanes::fill(from[2][slot]),
              limit = Lanes::fill(squared), zero = Lanes::fill(0);
  double* const to[] = {support.x.data(),  support.y.data(),  support.z.data(),   support.nx.data(),
                        support.ny.data(), support.nz.data(), support.rows.data()};
  const int last = from[6] ? 7 : 6;
  std::size_t count = 0;
  int at = 0;
  // By whole cache lines: what else stands in them lies beyond the radius, or in the next range, which goes on behind.
  for (const SlotRange& range : ranges)
    for (at = std::max(at, range.begin / kLanes * kLanes); at < range.end; at += kLanes) {
      const Lanes dx = Lanes::load(from[0] + at) - x, dy = Lanes::load(from[1] + at) - y,
                  dz = Lanes::load(from[2] + at) - z, away = dx * dx + dy * dy + dz * dz;
      const unsigned chosen = bits(away <= limit) & bits(zero < away);
      if (chosen == 0) continue;
      dx.pack(chosen, to[0] + count), dy.pack(chosen, to[1] + count), dz.pack(chosen, to[2] + count);
      for (int i = 3; i < last; ++i) Lanes::load(from[i] + at).pack(chosen, to[i] + count);
      count += hwy::PopCount(chosen);
    }
  support.count = static_cast<int>(count);
}

HWY_FLATTEN void measure_support(Support& support) {
  const auto end = static_cast<std::size_t>(padded(support.count));
  for (std::size_t i = 0; i < end; i += kLanes) {
    const Lanes x = Lanes::load(&support.x[i]), y = Lanes::load(&support.y[i]), z = Lanes::load(&support.z[i]);
    square_root(x * x + y * y + z * z).store(&support.distance[i]);
  }
}

HWY_FLATTEN WeightedMoments sum_moments(const Support& support, double radius) {
  const Lanes limit = Lanes::fill(radius), zero = Lanes::fill(0);
  Lanes w = zero, xx = zero, xy = zero, xz = zero, yy = zero, yz = zero, zz = zero;
  for (std::size_t i = 0; i < static_cast<std::size_t>(support.count); i += kLanes) {
    const Lanes x = Lanes::load(&support.x[i]), y = Lanes::load(&support.y[i]), z = Lanes::load(&support.z[i]),
                distance = Lanes::load(&support.distance[i]);
    const Lanes weight = select(zero < distance, limit - distance, zero);
    const Lanes wx = weight * x, wy = weight * y, wz = weight * z;
    w = w + weight;
    xx = xx + wx * x, xy = xy + wx * y, xz = xz + wx * z, yy = yy + wy * y, yz = yz + wy * z, zz = zz + wz * z;
  }
  return {sum(w), sum(xx), sum(xy), sum(xz), sum(yy), sum(yz), sum(zz)};
}

HWY_FLATTEN std::array<int, 2> count_ahead(const std::array<Eigen::Vector3d, 2>& axes, const Support& support) {
  const Lanes zero = Lanes::fill(0), one = Lanes::fill(1);
  Lanes count[2] = {zero, zero}, axis[2][3];
  for (std::size_t which : {0, 1})
    for (int i = 0; i < 3; ++i) axis[which][i] = Lanes::fill(axes[which](i));
  for (std::size_t i = 0; i < static_cast<std::size_t>(support.count); i += kLanes) {
    const Lanes x = Lanes::load(&support.x[i]), y = Lanes::load(&support.y[i]), z = Lanes::load(&support.z[i]);
    for (std::size_t which : {0, 1}) {
      const Lanes along = x * axis[which][0] + y * axis[which][1] + z * axis[which][2];
      count[which] = select(zero <= along, count[which] + one, count[which]);
    }
  }
  const int padding = padded(support.count) - support.count;  // lies at the point: ahead
  return {static_cast<int>(sum(count[0])) - padding, static_cast<int>(sum(count[1])) - padding};
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(collect_support);
HWY_EXPORT(measure_support);
HWY_EXPORT(sum_moments);
HWY_EXPORT(count_ahead);

void collect_support(const SlotColumns& from, std::size_t slot, double squared, const std::vector<SlotRange>& ranges,
                     Support& support) {
  HWY_DYNAMIC_DISPATCH(collect_support)(from, slot, squared, ranges, support);
}

void measure_support(Support& support) { HWY_DYNAMIC_DISPATCH(measure_support)(support); }

WeightedMoments sum_moments(const Support& support, double radius) {
  return HWY_DYNAMIC_DISPATCH(sum_moments)(support, radius);
}

std::array<int, 2> count_ahead(const std::array<Eigen::Vector3d, 2>& axes, const Support& support) {
  return HWY_DYNAMIC_DISPATCH(count_ahead)(axes, support);
}

}  // namespace corral
#endif
