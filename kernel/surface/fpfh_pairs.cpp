// SPDX-License-Identifier: MIT
// Bins are decided by comparisons of products, never by an angle: so they are the same on every machine, and cheap.
#include "kernel/surface/fpfh_pairs.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/surface/fpfh_pairs.cpp"
#include <hwy/foreach_target.h>

#include "kernel/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

constexpr int kMiddle = 5, kNoBin = 11;
constexpr double kParallel = 1e-12;  // squared sine of the angle below which a line has no side of a normal

// What lies beyond the m-th of these is m + 1 bins away from the middle one.
constexpr double kBorder[] = {1.0 / 11, 3.0 / 11, 5.0 / 11, 7.0 / 11, 9.0 / 11};
// Cosines and sines of kBorder times pi.
constexpr double kCosine[] = {0.9594929736144974, 0.6548607339452851, 0.14231483827328512, -0.4154150130018863,
                              -0.8412535328311811};
constexpr double kSine[] = {0.28173255684142967, 0.7557495743542583, 0.9898214418809327, 0.9096319953545186,
                            0.5406408174555978};

/// The bins of some pairs. kNoBin where there is none.
struct PairBins {
  static constexpr std::size_t kMost = 128;
  alignas(64) std::int32_t theta[kMost];
  alignas(64) std::int32_t alpha[kMost];
  alignas(64) std::int32_t phi[kMost];
};

/// Bins of the pairs of one vertex.
class PairBinner {
 public:
  HWY_INLINE PairBinner(const Support& support, const Eigen::Vector3d& normal, FpfhForm form)
      : support_(support),
        nx_(Lanes::fill(normal.x())),
        ny_(Lanes::fill(normal.y())),
        nz_(Lanes::fill(normal.z())),
        without_side_(Lanes::fill(form == FpfhForm::Pcl ? kMiddle : kNoBin)) {}

  /// Eight pairs from the i-th neighbour on, into the places from `at` on.
  HWY_INLINE void bin(std::size_t i, std::size_t at, PairBins& bins) const {
    const Lanes zero = Lanes::fill(0);
    const Lanes x = Lanes::load(&support_.x[i]), y = Lanes::load(&support_.y[i]), z = Lanes::load(&support_.z[i]);
    const Lanes mx = Lanes::load(&support_.nx[i]), my = Lanes::load(&support_.ny[i]), mz = Lanes::load(&support_.nz[i]);
    const Lanes distance = Lanes::load(&support_.distance[i]);
    const Lanes here = nx_ * x + ny_ * y + nz_ * z, there = mx * x + my * y + mz * z;
    const auto is_turned = magnitude(here) < magnitude(there);  // the neighbour is s
    const Lanes rise = select(is_turned, zero - there, here);   // u . (t - s)
    const Lanes other = select(is_turned, zero - here, there);  // n_t . (t - s)
    const Lanes cosine = nx_ * mx + ny_ * my + nz_ * mz;        // u . n_t
    const Lanes triple = (y * nz_ - z * ny_) * mx + (z * nx_ - x * nz_) * my + (x * ny_ - y * nx_) * mz;
    const Lanes squared = distance * distance, side = squared - rise * rise;  // |(t - s) x u|^2
    const Lanes length = square_root(larger(side, zero));

    // With w = ((t - s) - (u . (t - s)) u) / |(t - s) x u|.
    const Lanes theta = sector(other - rise * cosine, length * cosine);
    const Lanes alpha = interval(triple, length), phi = interval(rise, distance);

    const auto has_side = Lanes::fill(kParallel) * squared < side;
    const auto has_normal = zero < mx * mx + my * my + mz * mz;
    const Lanes none = Lanes::fill(kNoBin);
    const auto store = [&](const Lanes& value, std::int32_t* to) HWY_ATTR {
      select(has_normal, select(has_side, value, without_side_), none).store(to + at);
    };
    store(theta, bins.theta), store(alpha, bins.alpha), store(phi, bins.phi);
  }

 private:
  /// The middle bin and some more, on the side of a value.
  static HWY_INLINE Lanes from_middle(const Lanes& value, const Lanes& steps) {
    const Lanes middle = Lanes::fill(kMiddle);
    return select(value < Lanes::fill(0), middle - steps, middle + steps);
  }

  /// The bin of value / unit in -1 .. 1.
  static HWY_INLINE Lanes interval(const Lanes& value, const Lanes& unit) {
    const Lanes size = magnitude(value), one = Lanes::fill(1);
    Lanes steps = Lanes::fill(0);
    for (const double border : kBorder) steps = select(Lanes::fill(border) * unit < size, steps + one, steps);
    return from_middle(value, steps);
  }

  /// The bin of atan2(y, x) in -pi .. pi: |y| cos(b) - x sin(b) is above 0 where |angle| is above b.
  static HWY_INLINE Lanes sector(const Lanes& y, const Lanes& x) {
    const Lanes size = magnitude(y), one = Lanes::fill(1);
    Lanes steps = Lanes::fill(0);
    for (int i = 0; i < kMiddle; ++i)
      steps = select(Lanes::fill(kSine[i]) * x < Lanes::fill(kCosine[i]) * size, steps + one, steps);
    return from_middle(y, steps);
  }

  const Support& support_;
  Lanes nx_, ny_, nz_, without_side_;
};

/// Vertices side by side fall into the same bins, and need not wait for each other.
constexpr std::size_t kCopies = 4;

constexpr int kPlaces = 16;  // 11 bins, and one for pairs without

HWY_FLATTEN PairHistogram count(const Support& support, const Eigen::Vector3d& normal, FpfhForm form) {
  std::int32_t places[kCopies][3][kPlaces] = {};
  const PairBinner binner(support, normal, form);
  PairBins bins;
  const auto end = static_cast<std::size_t>(padded(support.count));  // without a normal the padding has no bins
  for (std::size_t first = 0; first < end; first += PairBins::kMost) {
    const std::size_t many = std::min(PairBins::kMost, end - first);
    for (std::size_t i = 0; i < many; i += kLanes) binner.bin(first + i, i, bins);
    for (std::size_t i = 0; i < many; i += kCopies)
      for (std::size_t copy = 0; copy < kCopies; ++copy) {
        ++places[copy][0][bins.theta[i + copy]];
        ++places[copy][1][bins.alpha[i + copy]];
        ++places[copy][2][bins.phi[i + copy]];
      }
  }
  PairHistogram counts;
  for (int bin = 0; bin < kFpfhSize; ++bin)
    for (const auto& copy : places) counts.bins[bin] += copy[bin / kFpfhBins][bin % kFpfhBins];
  for (int bin = 0; bin < kFpfhBins; ++bin) counts.pairs += counts.bins[bin];
  return counts;
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(count);

PairHistogram count_pairs(const Support& support, const Eigen::Vector3d& normal, FpfhForm form) {
  return normal.isZero(0) ? PairHistogram() : HWY_DYNAMIC_DISPATCH(count)(support, normal, form);
}

}  // namespace corral
#endif
