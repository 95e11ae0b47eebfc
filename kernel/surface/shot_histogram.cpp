// SPDX-License-Identifier: MIT
// The votes of a support. Bins are decided by comparing coordinates, so that a vertex at a border is never on the wrong side
// of it; angles only say how much is shared.
#include <array>
#include <cmath>

#include "kernel/surface/descriptor.h"

namespace corral {
namespace {

constexpr int kCosines = 11;
constexpr int kAbove = kCosines, kShell = 2 * kAbove, kSector = 2 * kShell;  // steps in the order of the bins
constexpr int kLost = kShotSize;                                             // where shares go that nobody gets

/// Some vertices: the bin that each lies in, and per axis the bin beside and the share that it gets.
struct Votes {
  static constexpr int kAxes = 4, kMost = 128;
  alignas(64) std::int32_t own[kMost];
  alignas(64) std::int32_t beside[kAxes][kMost];
  alignas(64) double share[kAxes][kMost];
  alignas(64) double rest[kMost];    // what the own bin gets of the four axes
  alignas(64) double counts[kMost];  // 1, or 0 for a vertex without a normal
};

/// The angle whose tangent is small / big (0 <= small <= big), in units of 45 degrees; 0 where both are 0.
template <class Lanes>
CORRAL_INLINE Lanes octants(const Lanes& small, const Lanes& big) {
  // atan(q) = 45 degrees + atan((q - 1) / (q + 1)) brings every ratio within tan(22.5 degrees), where eight terms of a
  // polynomial, interpolated at the Chebyshev nodes of the square, are within 1e-12 of it.
  constexpr double c[] = {1.2732395447342011,  -0.42441318086014196, 0.25464782050210991,  -0.18188719071878606,
                          0.14137360416332489, -0.11449673936626147, 0.088798241426864804, -0.047943967449120126};
  const auto fill = [](double number) { return Lanes::fill(number); };
  const Lanes zero = fill(0), one = fill(1);
  const auto far = big * fill(0.41421356237309503) < small;
  const Lanes over = select(far, small - big, small), under = select(far, small + big, big);
  const Lanes ratio = select(zero < under, over / under, zero), square = ratio * ratio, fourth = square * square;
  const Lanes low = (fill(c[0]) + fill(c[1]) * square) + (fill(c[2]) + fill(c[3]) * square) * fourth;
  const Lanes high = (fill(c[4]) + fill(c[5]) * square) + (fill(c[6]) + fill(c[7]) * square) * fourth;
  return select(far, one, zero) + ratio * (low + high * (fourth * fourth));
}

/// To the nearest whole number, halves to the even one; for small numbers.
template <class Lanes>
CORRAL_INLINE Lanes rounded(const Lanes& number) {
  constexpr double kWhole = 6755399441055744;  // 1.5 * 2^52: beside it there are whole numbers only
  return (number + Lanes::fill(kWhole)) - Lanes::fill(kWhole);
}

/// Azimuth: sectors of 45 degrees from -180, each with its upper border.
template <class Lanes>
CORRAL_INLINE Lanes vote_azimuth(const Lanes& x, const Lanes& y, const Lanes& home_in_sector, Lanes& share,
                                 std::int32_t* beside) {
  const auto fill = [](double number) { return Lanes::fill(number); };
  const Lanes zero = fill(0), ax = magnitude(x), ay = magnitude(y), big = select(ax <= ay, ay, ax);
  const Lanes turned = octants(smaller(ax, ay), big);
  const Lanes first_quadrant = select(ay <= ax, turned, fill(2) - turned);  // 0 .. 2, of 45 degrees each
  const Lanes upper_half = select(x < zero, fill(4) - first_quadrant, first_quadrant);
  const Lanes angle = select(y < zero, zero - upper_half, upper_half);  // -4 .. 4

  const Lanes whole = rounded(angle), end = select(whole < angle, whole + fill(1), whole);  // of the sector
  const Lanes last = select(end <= fill(-4), fill(-3), end);
  const Lanes home = home_in_sector + (last + fill(3)) * fill(kSector);
  const Lanes aside = angle - last + fill(0.5);  // from the centre of the sector, -0.5 .. 0.5
  const Lanes down = select(last <= fill(-3), home + fill(7 * kSector), home - fill(kSector));
  const Lanes up = select(fill(4) <= last, home - fill(7 * kSector), home + fill(kSector));
  select(big == zero, fill(kLost), select(zero < aside, up, down)).store(beside);
  share = select(big == zero, fill(1), magnitude(aside));
  return select(big == zero, home_in_sector, home);
}

/// Radius and elevation: two bins each, centred in their halves; outside the centres a share is lost. Returns the share.
/// `position`: 0 .. 2 over the two halves; `upper`: 1 in the second, else 0.
template <class Lanes>
CORRAL_INLINE Lanes vote_half(const Lanes& position, const Lanes& upper, int step, const Lanes& home,
                              std::int32_t* beside) {
  const Lanes inwards = Lanes::fill(1) - upper - upper;  // the direction of the other half
  const Lanes away = position - upper - Lanes::fill(0.5);
  select(Lanes::fill(0) < away * inwards, home + inwards * Lanes::fill(step), Lanes::fill(kLost)).store(beside);
  return magnitude(away);
}

/// Eight vertices from the i-th on, into the places from `at` on.
template <class Lanes>
CORRAL_INLINE void vote(const Support& support, std::size_t i, const LocalReferenceFrame& frame, double radius,
                        bool wraps, std::size_t at, Votes& votes) {
  const auto fill = [](double number) { return Lanes::fill(number); };
  const Lanes zero = fill(0), one = fill(1);
  const Lanes dx = Lanes::load(&support.x[i]), dy = Lanes::load(&support.y[i]), dz = Lanes::load(&support.z[i]);
  const auto along = [&](int axis) {
    return fill(frame(axis, 0)) * dx + fill(frame(axis, 1)) * dy + fill(frame(axis, 2)) * dz;
  };
  const Lanes x = along(0), y = along(1), z = along(2), distance = Lanes::load(&support.distance[i]);
  const Lanes nx = Lanes::load(&support.nx[i]), ny = Lanes::load(&support.ny[i]), nz = Lanes::load(&support.nz[i]);
  const Lanes counts = select(magnitude(nx) + magnitude(ny) + magnitude(nz) == zero, zero, one);
  counts.store(&votes.counts[at]);

  // Cosine: bins centred on 0 .. 10; none lies beyond the outer centres.
  const Lanes dot = nx * fill(frame(2, 0)) + ny * fill(frame(2, 1)) + nz * fill(frame(2, 2));
  const Lanes clamped = select(dot < one, select(fill(-1) < dot, dot, fill(-1)), one);
  const Lanes position = (one + clamped) * fill(5);
  const Lanes whole = rounded(position),
              cosine = select(whole + fill(0.5) <= position, whole + one, whole);  // halves up

  const Lanes shell = select(fill(radius / 2) < distance, one, zero), above = select(zero < z, one, zero);
  Lanes share[Votes::kAxes];
  const Lanes home =
      vote_azimuth(x, y, cosine + above * fill(kAbove) + shell * fill(kShell), share[3], &votes.beside[3][at]);
  home.store(&votes.own[at]);

  const Lanes delta = position - cosine;
  const Lanes last = wraps ? fill(kCosines - 2) : fill(kCosines);
  const Lanes up = select(cosine == last, home - cosine, home + one);
  select(zero < delta, up, select(cosine == zero, home, home - one)).store(&votes.beside[0][at]);
  share[0] = magnitude(delta);
  share[1] = vote_half(distance * fill(2 / radius), shell, kShell, home, &votes.beside[1][at]);
  // Elevation from the plane up or down, 0 .. 2 over both halves, the lower first.
  const Lanes flat = square_root(x * x + y * y), height = magnitude(z);
  const Lanes angle = octants(smaller(flat, height), select(flat <= height, height, flat));
  const Lanes raised = select(height <= flat, angle, fill(2) - angle) * fill(0.5);  // 0 .. 1
  share[2] = vote_half(one + raised * (above + above - one), above, kAbove, home, &votes.beside[2][at]);

  for (int axis = 0; axis < Votes::kAxes; ++axis) (share[axis] * counts).store(&votes.share[axis][at]);
  (((one - share[0]) + (one - share[1]) + (one - share[2]) + (one - share[3])) * counts).store(&votes.rest[at]);
}

constexpr int kCopies = 4;  // of the histogram: vertices side by side fall into the same bins, and need not wait
using Histograms = std::array<std::array<double, kShotSize + 1>, kCopies>;  // the last bin takes what is lost

void add_one_axis_at_a_time(const Votes& votes, int count, Histograms& histograms) {
  for (int i = 0; i < count; ++i) {
    auto& histogram = histograms[static_cast<std::size_t>(i % kCopies)];
    for (int axis = 0; axis < Votes::kAxes; ++axis)
      histogram[static_cast<std::size_t>(votes.beside[axis][i])] += votes.share[axis][i];
    histogram[static_cast<std::size_t>(votes.own[i])] += votes.rest[i];
  }
}

void add_products(const Votes& votes, int count, Histograms& histograms) {
  for (int i = 0; i < count; ++i)
    for (int corner = 0; corner < 1 << Votes::kAxes; ++corner) {
      double weight = votes.counts[i];
      int bin = votes.own[i];
      for (int axis = 0; axis < Votes::kAxes; ++axis) {
        const int beside = votes.beside[axis][i];
        const bool has_azimuth = axis < 3 || beside != kLost;  // on the z axis the whole vote stays
        const double share = has_azimuth ? votes.share[axis][i] : 0;
        const bool aside = corner >> axis & 1;
        weight *= aside ? (beside == kLost ? 0 : share) : 1 - share;
        if (aside && beside != kLost) bin += beside - votes.own[i];
      }
      histograms[static_cast<std::size_t>(i % kCopies)][static_cast<std::size_t>(bin)] += weight;
    }
}

}  // namespace

std::optional<Eigen::VectorXd> shot_histogram(const Support& support, const LocalReferenceFrame& frame, double radius,
                                              const std::string& form) {
  Histograms histograms{};
  const auto add = form == "product" ? add_products : add_one_axis_at_a_time;
  const bool wraps = form == "pcl";
  Votes votes;
  for (int first = 0; first < support.count; first += Votes::kMost) {
    const int count = std::min(Votes::kMost, support.count - first);
    vectorized([&](auto kind) {
      for (int i = 0; i < count; i += kLanes)
        vote<typename decltype(kind)::Lanes>(support, static_cast<std::size_t>(first + i), frame, radius, wraps,
                                             static_cast<std::size_t>(i), votes);
    });
    add(votes, count, histograms);
  }
  Eigen::VectorXd values = Eigen::VectorXd::Zero(kShotSize);
  for (const auto& histogram : histograms) values += Eigen::Map<const Eigen::VectorXd>(histogram.data(), kShotSize);
  const double norm = values.norm();
  if (!(norm > 0)) return std::nullopt;
  values /= norm;
  return values;
}

}  // namespace corral
