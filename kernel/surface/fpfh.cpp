// SPDX-License-Identifier: MIT
// Bins are decided by comparisons of products, never by an angle: so they are the same on every machine, and cheap.
#include "kernel/surface/fpfh.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "kernel/surface/crowd_limit.h"
#include "kernel/surface/keep_described.h"

namespace corral {
namespace {

constexpr char kWho[] = "describe_fpfh";
constexpr int kBins = 11, kMiddle = 5, kNoBin = 11;
constexpr std::size_t kBlock = 64;
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
template <class Lanes>
class PairBinner {
 public:
  CORRAL_INLINE PairBinner(const Support& support, const Eigen::Vector3d& normal, FpfhForm form)
      : support_(support),
        nx_(Lanes::fill(normal.x())),
        ny_(Lanes::fill(normal.y())),
        nz_(Lanes::fill(normal.z())),
        without_side_(Lanes::fill(form == FpfhForm::Pcl ? kMiddle : kNoBin)) {}

  /// Eight pairs from the i-th neighbour on, into the places from `at` on.
  CORRAL_INLINE void bin(std::size_t i, std::size_t at, PairBins& bins) const {
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
    const auto store = [&](const Lanes& value, std::int32_t* to) {
      select(has_normal, select(has_side, value, without_side_), none).store(to + at);
    };
    store(theta, bins.theta), store(alpha, bins.alpha), store(phi, bins.phi);
  }

 private:
  /// The middle bin and some more, on the side of a value.
  static CORRAL_INLINE Lanes from_middle(const Lanes& value, const Lanes& steps) {
    const Lanes middle = Lanes::fill(kMiddle);
    return select(value < Lanes::fill(0), middle - steps, middle + steps);
  }

  /// The bin of value / unit in -1 .. 1.
  static CORRAL_INLINE Lanes interval(const Lanes& value, const Lanes& unit) {
    const Lanes size = magnitude(value), one = Lanes::fill(1);
    Lanes steps = Lanes::fill(0);
    for (const double border : kBorder) steps = select(Lanes::fill(border) * unit < size, steps + one, steps);
    return from_middle(value, steps);
  }

  /// The bin of atan2(y, x) in -pi .. pi: |y| cos(b) - x sin(b) is above 0 where |angle| is above b.
  static CORRAL_INLINE Lanes sector(const Lanes& y, const Lanes& x) {
    const Lanes size = magnitude(y), one = Lanes::fill(1);
    Lanes steps = Lanes::fill(0);
    for (int i = 0; i < kMiddle; ++i)
      steps = select(Lanes::fill(kSine[i]) * x < Lanes::fill(kCosine[i]) * size, steps + one, steps);
    return from_middle(y, steps);
  }

  const Support& support_;
  Lanes nx_, ny_, nz_, without_side_;
};

/// S(p), as numbers of pairs.
struct PairCounts {
  std::int32_t bins[kFpfhSize] = {};
  std::int32_t pairs = 0;
};

/// Adds a share of S(p).
CORRAL_INLINE void add_share(const PairCounts& counts, double share, double* sums) {
  const double weight = share / counts.pairs;
  for (int bin = 0; bin < kFpfhSize; ++bin) sums[bin] += weight * counts.bins[bin];
}

/// Vertices side by side fall into the same bins, and need not wait for each other.
constexpr std::size_t kCopies = 4;

PairCounts count_pairs(const Support& support, const Eigen::Vector3d& normal, FpfhForm form) {
  PairCounts counts;
  if (normal.isZero(0)) return counts;
  constexpr int kPlaces = 16;  // 11 bins, and one for pairs without
  std::int32_t places[kCopies][3][kPlaces] = {};
  vectorized([&](auto kind) {
    using Lanes = typename decltype(kind)::Lanes;
    const PairBinner<Lanes> binner(support, normal, form);
    PairBins bins;
    const auto end = static_cast<std::size_t>(padded(support.count));  // without a normal the padding has no bins
    for (std::size_t first = 0; first < end; first += PairBins::kMost) {
      const std::size_t count = std::min(PairBins::kMost, end - first);
      for (std::size_t i = 0; i < count; i += kLanes) binner.bin(first + i, i, bins);
      for (std::size_t i = 0; i < count; i += kCopies)
        for (std::size_t copy = 0; copy < kCopies; ++copy) {
          ++places[copy][0][bins.theta[i + copy]];
          ++places[copy][1][bins.alpha[i + copy]];
          ++places[copy][2][bins.phi[i + copy]];
        }
    }
  });
  for (int bin = 0; bin < kFpfhSize; ++bin)
    for (const auto& copy : places) counts.bins[bin] += copy[bin / kBins][bin % kBins];
  for (int bin = 0; bin < kBins; ++bin) counts.pairs += counts.bins[bin];
  return counts;
}

class Describer {
 public:
  Describer(const Points& vertices, const Points& normals, double radius, const FpfhOptions& options)
      : normals_(normals),
        options_(options),
        radius_(radius),
        finder_(vertices, normals, radius, options.form == FpfhForm::Paper ? Rim::Inside : Rim::Outside),
        needed_(static_cast<std::size_t>(vertices.rows())),
        places_(static_cast<std::size_t>(vertices.rows())) {}

  Descriptors run(const Indices& keypoints, const ParallelFor& parallel) {
    std::vector<Outcome> outcomes(keypoints.size(), Outcome::SmallSupport);
    walk(keypoints, &SupportFinder::find_rows, parallel, [&](std::size_t i, const Support& support) {
      if (support.count < options_.minimum_support) return;
      outcomes[i] = Outcome::NoHistogram;
      mark(keypoints[i]);
      for (int j = 0; j < support.count; ++j) mark(row(support, j));
    });
    count_needed(parallel);
    Descriptors descriptors;
    descriptors.features.resize(kFpfhSize, static_cast<Eigen::Index>(keypoints.size()));
    walk(keypoints, &SupportFinder::find_rows, parallel, [&](std::size_t i, const Support& support) {
      if (outcomes[i] == Outcome::NoHistogram &&
          weigh(keypoints[i], support, descriptors.features.col(static_cast<Eigen::Index>(i)).data()))
        outcomes[i] = Outcome::Described;
    });
    keep_described(keypoints, outcomes, descriptors);
    return descriptors;
  }

 private:
  static int row(const Support& support, int j) { return static_cast<int>(support.rows[static_cast<std::size_t>(j)]); }
  void mark(int vertex) { needed_[static_cast<std::size_t>(vertex)].store(true, std::memory_order_relaxed); }
  const PairCounts& counts_of(int vertex) const {
    return counts_[static_cast<std::size_t>(places_[static_cast<std::size_t>(vertex)])];
  }

  /// Calls visit(i, support) for the support of the i-th vertex.
  template <class Find, class Visit>
  void walk(const Indices& vertices, Find find, const ParallelFor& parallel, const Visit& visit) const {
    const auto order = finder_.walk(vertices);
    CrowdLimit crowd({kWho, "descriptor radius", radius_, 10000, 700}, static_cast<std::int64_t>(order.size()));
    parallel(static_cast<int>((order.size() + kBlock - 1) / kBlock), [&](int block) {
      auto place = finder_.start();
      Support support;
      const std::size_t first = static_cast<std::size_t>(block) * kBlock;
      for (std::size_t at = first; at < std::min(order.size(), first + kBlock); ++at) {
        (finder_.*find)(vertices[order[at]], place, support);
        crowd.add(support.count);
        visit(order[at], support);
      }
    });
  }

  /// S(p) of every vertex that was marked.
  void count_needed(const ParallelFor& parallel) {
    Indices vertices;
    for (std::size_t vertex = 0; vertex < needed_.size(); ++vertex) {
      if (!needed_[vertex]) continue;
      places_[vertex] = static_cast<int>(vertices.size());
      vertices.push_back(static_cast<int>(vertex));
    }
    counts_.resize(vertices.size());
    walk(vertices, &SupportFinder::find, parallel, [&](std::size_t i, const Support& support) {
      counts_[i] = count_pairs(support, normals_.row(vertices[i]).transpose(), options_.form);
    });
  }

  /// Writes the feature of a keypoint; false if nothing around it has a histogram.
  bool weigh(int keypoint, const Support& support, double* feature) const;

  const Points& normals_;
  const FpfhOptions& options_;
  double radius_;
  SupportFinder finder_;
  std::vector<std::atomic<bool>> needed_;  // by vertex
  std::vector<int> places_;                // of vertices among the counts
  std::vector<PairCounts> counts_;
};

bool Describer::weigh(int keypoint, const Support& support, double* feature) const {
  double sums[kFpfhSize] = {};
  vectorized([&](auto) {
    int with_histogram = 0;
    for (int j = 0; j < support.count; ++j) {
      const PairCounts& counts = counts_of(row(support, j));
      if (counts.pairs == 0) continue;
      const double distance = support.distance[static_cast<std::size_t>(j)];
      add_share(counts, options_.form == FpfhForm::Pcl ? 1 / (distance * distance) : radius_ / distance, sums);
      ++with_histogram;
    }
    if (options_.form == FpfhForm::Pcl) return;
    for (double& sum : sums) sum /= std::max(with_histogram, 1);
    if (counts_of(keypoint).pairs > 0) add_share(counts_of(keypoint), 1, sums);
  });
  for (int first = 0; first < kFpfhSize; first += kBins) {
    double total = 0;
    for (int bin = first; bin < first + kBins; ++bin) total += sums[bin];
    if (!(total > 0)) return false;
    for (int bin = first; bin < first + kBins; ++bin) feature[bin] = sums[bin] * (100 / total);
  }
  return true;
}

}  // namespace

Descriptors describe_fpfh(const Points& vertices, const Points& normals, const Indices& keypoints, double resolution,
                          const FpfhOptions& options, const ParallelFor& parallel) {
  require_positive(kWho, "resolution", resolution);
  validate_options(options, kWho);
  require_keypoints(kWho, vertices, normals, keypoints);
  Points usable = normals;
  for (auto normal : usable.rowwise())
    if (!normal.allFinite()) normal.setZero();
  return Describer(vertices, usable, options.radius_pr * resolution, options).run(keypoints, parallel);
}

}  // namespace corral
