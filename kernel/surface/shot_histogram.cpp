// SPDX-License-Identifier: MIT
// The votes of a support. Bins are decided by comparing coordinates, so that a vertex at a border is never on the wrong side
// of it; angles only say how much is shared.
#include <algorithm>
#include <cmath>

#include "kernel/surface/shot.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/surface/shot_histogram.cpp"
#include <hwy/foreach_target.h>

#include "kernel/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

constexpr int kCosines = 11;
// While votes are counted a volume has 16 places, so that the index of the neighbouring bin along an axis differs by one bit.
constexpr int kVolume = 16, kAbove = kVolume, kShell = 2 * kAbove, kSector = 2 * kShell, kPlaces = 8 * kSector;

/// Some vertices: the bin that each lies in, those beside it where a bit does not tell, and what each of them gets.
struct Votes {
  static constexpr int kAxes = 4, kMost = 128;
  enum Axis { kCosine, kRadius, kElevation, kAzimuth };
  alignas(64) std::int32_t own[kMost];
  alignas(64) std::int32_t beside_cosine[kMost];
  alignas(64) std::int32_t beside_azimuth[kMost];
  alignas(64) double share[kAxes][kMost];  // share of the neighbouring bin
  alignas(64) double rest[kMost];          // share of the vertex's own bin over the four axes
  alignas(64) double kept[kAxes][kMost];   // its share of each (only for products)

  void silence(std::size_t i) {
    rest[i] = 0;
    for (int axis = 0; axis < kAxes; ++axis) share[axis][i] = kept[axis][i] = 0;
  }
  std::size_t home(std::size_t i) const { return static_cast<unsigned>(own[i]); }
  std::size_t beside(int axis, std::size_t i) const {
    switch (axis) {
      case kCosine:
        return static_cast<unsigned>(beside_cosine[i]);
      case kRadius:
        return home(i) ^ kShell;
      case kElevation:
        return home(i) ^ kAbove;
      default:
        return static_cast<unsigned>(beside_azimuth[i]) & (kPlaces - 1);
    }
  }
};

constexpr double kSlope = 0.41421356237309503;  // tan(22.5 degrees) = 1 / tan(67.5 degrees)

/// The angle of a tangent within kSlope, in units of 45 degrees: directions are measured from 22.5 degrees, where
/// tan(angle - 22.5 degrees) = (y - x kSlope) / (x + y kSlope), so that there are no cases.
HWY_INLINE Lanes octants(const Lanes& ratio) {
  // Eight terms of a polynomial, interpolated at the Chebyshev nodes of the square, are within 1e-12 of the angle.
  constexpr double c[] = {1.2732395447342011,  -0.42441318086014196, 0.25464782050210991,  -0.18188719071878606,
                          0.14137360416332489, -0.11449673936626147, 0.088798241426864804, -0.047943967449120126};
  const auto fill = [](double number) HWY_ATTR { return Lanes::fill(number); };
  const Lanes square = ratio * ratio, fourth = square * square;
  const Lanes low = (fill(c[0]) + fill(c[1]) * square) + (fill(c[2]) + fill(c[3]) * square) * fourth;
  const Lanes high = (fill(c[4]) + fill(c[5]) * square) + (fill(c[6]) + fill(c[7]) * square) * fourth;
  return ratio * (low + high * (fourth * fourth));
}

/// To the nearest whole number, halves to the even one; for small numbers.
HWY_INLINE Lanes rounded(const Lanes& number) {
  constexpr double kWhole = 6755399441055744;  // 1.5 * 2^52: beside it there are whole numbers only
  return (number + Lanes::fill(kWhole)) - Lanes::fill(kWhole);
}

/// Turns places on the surface around a point into votes.
class Voter {
 public:
  HWY_INLINE Voter(const Support& support, const LocalReferenceFrame& frame, double radius, ShotForm form)
      : support_(support),
        halves_(fill(2 / radius)),
        half_radius_(fill(radius / 2)),
        after_nine_(fill(form == ShotForm::PclBug ? -9 : 1)),
        is_product_(form == ShotForm::Product) {
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) axes_[row][column] = fill(frame(row, column));
  }

  /// Eight vertices from the i-th on, into the places from `at` on.
  HWY_INLINE void vote(std::size_t i, std::size_t at, Votes& votes) const {
    const Lanes zero = fill(0), one = fill(1), half = fill(0.5);
    const Lanes nx = Lanes::load(&support_.nx[i]), ny = Lanes::load(&support_.ny[i]), nz = Lanes::load(&support_.nz[i]);
    Lanes share[Votes::kAxes], given[Votes::kAxes];

    // Cosine: bins centred on 0 .. 10; none lies beyond the outer centres.
    const Lanes position = (one + larger(smaller(along(2, nx, ny, nz), one), fill(-1))) * fill(5);
    const Lanes whole = rounded(position), cosine = select(whole + half <= position, whole + one, whole);  // halves up
    const Lanes delta = position - cosine;
    share[Votes::kCosine] = given[Votes::kCosine] = magnitude(delta);

    // Radius and elevation: two bins each, centred in their halves; outside the centres a share is lost.
    const Lanes distance = Lanes::load(&support_.distance[i]);
    const Lanes from_border = magnitude(distance * halves_ - one);  // 0 .. 1
    share[Votes::kRadius] = magnitude(from_border - half);
    given[Votes::kRadius] = select(from_border < half, share[Votes::kRadius], zero);

    const Lanes dx = Lanes::load(&support_.x[i]), dy = Lanes::load(&support_.y[i]), dz = Lanes::load(&support_.z[i]);
    const Lanes x = along(0, dx, dy, dz), y = along(1, dx, dy, dz), z = along(2, dx, dy, dz);
    const Lanes flat = square_root(x * x + y * y), height = magnitude(z), slope = fill(kSlope);
    const Lanes less = smaller(flat, height), more = larger(flat, height);
    const Lanes aslant = octants((less - more * slope) / (more + less * slope));  // 0.5 half way between plane and axis
    share[Votes::kElevation] = fill(0.25) - half * aslant;  // not negative: the polynomial ends below 0.5
    given[Votes::kElevation] = select(height < flat, share[Votes::kElevation], zero);

    // Azimuth: sectors of 45 degrees from -180, each with its upper border. Half a turn brings the lower four of them
    // onto the upper four, and a quarter the last two onto the first two.
    const auto on_axis = magnitude(x) + magnitude(y) == zero;
    const auto is_upper = zero < select(y == zero, zero - x, y);
    const Lanes turned = select(is_upper, x, zero - x), ax = magnitude(x), ay = magnitude(y);
    const auto is_last = turned < zero;
    const Lanes a = select(is_last, ay, ax), b = select(is_last, ax, ay);
    const auto is_steep = a < b;  // measured from 67.5 degrees
    const Lanes aside = octants(select(is_steep, b * slope - a, b - a * slope) /
                                select(is_steep, a * slope + b, a + b * slope));  // from the middle of the sector
    share[Votes::kAzimuth] = select(on_axis, one, magnitude(aside));
    given[Votes::kAzimuth] = select(on_axis, zero, magnitude(aside));

    Lanes own = cosine;
    own = select(half_radius_ < distance, own + fill(kShell), own);
    own = select(zero < z, own + fill(kAbove), own);
    own = select(is_upper, own + fill(4 * kSector), own);
    own = select(is_last, own + fill(2 * kSector), own);
    own = select(is_steep, own + fill(kSector), own);
    own.store(&votes.own[at]);
    select(delta < zero, own - one, own + select(cosine == fill(9), after_nine_, one)).store(&votes.beside_cosine[at]);
    select(aside < zero, own - fill(kSector), own + fill(kSector)).store(&votes.beside_azimuth[at]);

    store_shares(share, given, at, votes);
    unsigned without_normal = bits(nx == zero) & bits(ny == zero) & bits(nz == zero);
    for (; without_normal != 0; without_normal &= without_normal - 1)
      votes.silence(at + hwy::Num0BitsBelowLS1Bit_Nonzero32(without_normal));
  }

 private:
  static HWY_INLINE Lanes fill(double number) { return Lanes::fill(number); }
  HWY_INLINE Lanes along(int axis, const Lanes& x, const Lanes& y, const Lanes& z) const {
    return axes_[axis][0] * x + axes_[axis][1] * y + axes_[axis][2] * z;
  }
  /// `share`: what each axis takes from the vertex's own bin, `given`: the part that the neighbouring bin gets.
  HWY_INLINE void store_shares(const Lanes (&share)[Votes::kAxes], const Lanes (&given)[Votes::kAxes], std::size_t at,
                               Votes& votes) const {
    for (int axis = 0; axis < Votes::kAxes; ++axis) given[axis].store(&votes.share[axis][at]);
    (fill(4) - ((share[0] + share[1]) + (share[2] + share[3]))).store(&votes.rest[at]);
    if (!is_product_) return;
    for (int axis = 0; axis < Votes::kAxes; ++axis)  // on the z axis the whole vote stays
      (fill(1) - (axis == Votes::kAzimuth ? given : share)[axis]).store(&votes.kept[axis][at]);
  }

  const Support& support_;
  Lanes axes_[3][3], halves_, half_radius_, after_nine_;
  bool is_product_;
};

constexpr std::size_t kCopies = 4;
static_assert(sizeof(ShotBins) == sizeof(double) * kCopies * kPlaces);

void add_one_axis_at_a_time(const Votes& votes, std::size_t count, ShotBins& bins) {
  for (std::size_t first = 0; first < count; first += kCopies)
    for (std::size_t copy = 0; copy < kCopies; ++copy) {
      const std::size_t i = first + copy;
      double* const own = bins.votes[copy];
      own[votes.home(i)] += votes.rest[i];
      for (int axis = 0; axis < Votes::kAxes; ++axis) own[votes.beside(axis, i)] += votes.share[axis][i];
    }
}

void add_products(const Votes& votes, std::size_t count, ShotBins& bins) {
  for (std::size_t i = 0; i < count; ++i)
    for (int corner = 0; corner < 1 << Votes::kAxes; ++corner) {
      double weight = 1;
      std::size_t bin = votes.home(i);
      for (int axis = 0; axis < Votes::kAxes; ++axis) {
        const bool aside = corner >> axis & 1;
        weight *= aside ? votes.share[axis][i] : votes.kept[axis][i];
        if (aside) bin += votes.beside(axis, i) - votes.home(i);
      }
      bins.votes[i % kCopies][bin] += weight;
    }
}

/// The copies added, each volume at its place, at length one; nothing if that is impossible. Empties them.
HWY_INLINE std::optional<Eigen::VectorXd> normalized(ShotBins& bins) {
  double values[kShotSize + kVolume];
  for (int volume = 0; volume < kPlaces / kVolume; ++volume)
    for (int i = 0; i < kVolume; i += kLanes) {  // the excess of a volume is overwritten by the next one
      const auto load = [&](int copy) HWY_ATTR { return Lanes::load(&bins.votes[copy][volume * kVolume + i]); };
      ((load(0) + load(1)) + (load(2) + load(3))).store(&values[volume * kCosines + i]);
      for (auto& copy : bins.votes) Lanes::fill(0).store(&copy[volume * kVolume + i]);
    }
  Lanes squares = Lanes::fill(0);
  for (int i = 0; i < kShotSize; i += kLanes) {
    const Lanes value = Lanes::load(values + i);
    squares = squares + value * value;
  }
  const double norm = std::sqrt(sum(squares));
  if (!(norm > 0)) return std::nullopt;
  Eigen::VectorXd result(kShotSize);
  for (int i = 0; i < kShotSize; i += kLanes) (Lanes::load(values + i) * Lanes::fill(1 / norm)).store(&result[i]);
  return result;
}

HWY_FLATTEN std::optional<Eigen::VectorXd> shot_histogram(const Support& support, const LocalReferenceFrame& frame,
                                                          double radius, ShotForm form, ShotBins& bins) {
  const auto add = form == ShotForm::Product ? add_products : add_one_axis_at_a_time;
  Votes votes;
  const Voter voter(support, frame, radius, form);
  const auto end = static_cast<std::size_t>(padded(support.count));  // without a normal the padding has no votes
  for (std::size_t first = 0; first < end; first += Votes::kMost) {
    const std::size_t count = std::min<std::size_t>(Votes::kMost, end - first);
    for (std::size_t i = 0; i < count; i += kLanes) voter.vote(first + i, i, votes);
    add(votes, count, bins);
  }
  return normalized(bins);
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(shot_histogram);

std::optional<Eigen::VectorXd> shot_histogram(const Support& support, const LocalReferenceFrame& frame, double radius,
                                              ShotForm form, ShotBins& bins) {
  return HWY_DYNAMIC_DISPATCH(shot_histogram)(support, frame, radius, form, bins);
}

}  // namespace corral
#endif
