// SPDX-License-Identifier: MIT
#include "kernel/surface/fpfh.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "kernel/surface/crowd_limit.h"
#include "kernel/surface/fpfh_pairs.h"
#include "kernel/surface/keep_described.h"

namespace corral {
namespace {

constexpr char kWho[] = "describe_fpfh";
constexpr std::size_t kBlock = 64;

/// Adds a share of S(p).
void add_share(const PairHistogram& counts, double share, double* sums) {
  const double weight = share / counts.pairs;
  for (int bin = 0; bin < kFpfhSize; ++bin) sums[bin] += weight * counts.bins[bin];
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
    std::vector<KeypointOutcome> outcomes(keypoints.size(), KeypointOutcome::SmallSupport);
    walk(keypoints, &SupportFinder::find_rows, parallel, [&](std::size_t i, const Support& support) {
      if (support.count < options_.minimum_support) return;
      outcomes[i] = KeypointOutcome::NoHistogram;
      mark(keypoints[i]);
      for (int j = 0; j < support.count; ++j) mark(row(support, j));
    });
    count_needed(parallel);
    Descriptors descriptors;
    descriptors.features.resize(kFpfhSize, static_cast<Eigen::Index>(keypoints.size()));
    walk(keypoints, &SupportFinder::find_rows, parallel, [&](std::size_t i, const Support& support) {
      if (outcomes[i] == KeypointOutcome::NoHistogram &&
          weigh(keypoints[i], support, descriptors.features.col(static_cast<Eigen::Index>(i)).data()))
        outcomes[i] = KeypointOutcome::Described;
    });
    keep_described(keypoints, outcomes, descriptors);
    return descriptors;
  }

 private:
  static int row(const Support& support, int j) { return static_cast<int>(support.rows[static_cast<std::size_t>(j)]); }
  void mark(int vertex) { needed_[static_cast<std::size_t>(vertex)].store(true, std::memory_order_relaxed); }
  std::size_t place_of(int vertex) const { return static_cast<std::size_t>(places_[static_cast<std::size_t>(vertex)]); }
  const PairHistogram& counts_of(int vertex) const { return counts_[place_of(vertex)]; }

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
    for (std::size_t vertex = 0; vertex < needed_.size(); ++vertex)
      if (needed_[vertex]) vertices.push_back(static_cast<int>(vertex));
    const auto order = finder_.walk(vertices);
    for (std::size_t i = 0; i < order.size(); ++i)  // neighbours stand side by side
      places_[static_cast<std::size_t>(vertices[order[i]])] = static_cast<int>(i);
    counts_.resize(vertices.size());
    walk(vertices, &SupportFinder::find, parallel, [&](std::size_t i, const Support& support) {
      counts_[place_of(vertices[i])] = count_pairs(support, normals_.row(vertices[i]).transpose(), options_.form);
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
  std::vector<PairHistogram> counts_;
};

bool Describer::weigh(int keypoint, const Support& support, double* feature) const {
  const bool is_pcl = options_.form == FpfhForm::Pcl;
  double sums[kFpfhSize] = {};
  int with_histogram = 0;
  for (int j = 0; j < support.count; ++j) {
    const PairHistogram& counts = counts_of(row(support, j));
    if (counts.pairs == 0) continue;
    const double distance = support.distance[static_cast<std::size_t>(j)];
    add_share(counts, is_pcl ? 1 / (distance * distance) : radius_ / distance, sums);
    ++with_histogram;
  }
  if (!is_pcl) {
    for (double& sum : sums) sum /= std::max(with_histogram, 1);
    if (counts_of(keypoint).pairs > 0) add_share(counts_of(keypoint), 1, sums);
  }
  for (int first = 0; first < kFpfhSize; first += kFpfhBins) {
    double total = 0;
    for (int bin = first; bin < first + kFpfhBins; ++bin) total += sums[bin];
    if (!(total > 0)) return false;
    for (int bin = first; bin < first + kFpfhBins; ++bin) feature[bin] = sums[bin] * (100 / total);
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
