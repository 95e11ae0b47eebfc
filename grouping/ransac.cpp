// SPDX-License-Identifier: MIT
#include "grouping/ransac.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "grouping/columns/filter_loops.h"
#include "kernel/random.h"
#include "kernel/triangle_fit.h"

namespace corral {
namespace {

/// Smallest usable area of a sampled triangle in pr^2; below it the pose is decided by noise.
constexpr double kDegenerateAreaPr2 = 1e-3;

constexpr int kBatch = 128;  ///< iterations that are drawn and fitted together

using Triple = std::array<int, 3>;

/// Three distinct rows, every ordered triple equally likely.
Triple draw_triple(RandomStream& random, int rows) {
  const auto count = static_cast<std::uint64_t>(rows);
  const int first = static_cast<int>(random.below(count));
  int second = static_cast<int>(random.below(count - 1));
  second += second >= first;
  int third = static_cast<int>(random.below(count - 2));
  third += third >= std::min(first, second);
  third += third >= std::max(first, second);
  return {first, second, third};
}

/// The motion through one of the triples drawn.
struct Hypothesis {
  int iteration;
  RigidTransform target_from_source;
};

class Search {
 public:
  Search(const CorrespondenceSet& matches, const RansacOptions& options)
      : matches_(matches),
        options_(options),
        tolerance_(options.tolerance_pr * matches.resolution),
        smallest_area_(kDegenerateAreaPr2 * matches.resolution * matches.resolution),
        table_(matches),
        last_iteration_(options.iterations) {
    hypotheses_.reserve(kBatch);
  }

  GroupingResult run() {
    RandomStream random(options_.seed);
    for (int first = 0; first < last_iteration_; first += kBatch) {
      draw(random, first, std::min(kBatch, last_iteration_ - first));
      judge();
    }
    GroupingResult result;
    if (best_count_ == 0) return result;
    for (int row = 0; row < matches_.size(); ++row)
      if (agrees(best_, row)) result.selected.push_back(row);
    result.target_from_source = best_;
    return result;
  }

 private:
  /// The usable hypotheses of the next iterations, in order.
  void draw(RandomStream& random, int first, int count) {
    hypotheses_.clear();
    for (int group = 0; group < count; group += kLanes) {
      const int lanes_used = std::min(kLanes, count - group);
      for (int lane = 0; lane < kLanes; ++lane) {
        if (lane < lanes_used)
          triple_ = draw_triple(random, matches_.size());  // the lanes left over repeat the last one
        source_.set(lane, matches_.source_points, triple_);
        target_.set(lane, matches_.target_points, triple_);
      }
      fit_triangles(source_, target_, smallest_area_, motions_);
      for (int lane = 0; lane < lanes_used; ++lane)
        if (motions_.is_usable(lane)) hypotheses_.push_back({first + group + lane, motions_.get(lane)});
    }
  }

  /// Keeps the best hypothesis. Floats count the matches that possibly agree, first in one direction, then in all: most
  /// hypotheses have too few of them and are never counted exactly.
  void judge() {
    const int count = static_cast<int>(hypotheses_.size());
    for (int first = 0; first < count; first += kPoseTile) {
      PoseFilter poses[kPoseTile];
      int near_plane[kPoseTile];
      for (int k = 0; k < kPoseTile; ++k)  // those left over repeat the last one
        poses[k] = PoseFilter(table_, at(std::min(first + k, count - 1)).target_from_source, tolerance_);
      count_near_first_plane(table_, poses, near_plane);
      for (int k = 0; k < kPoseTile && first + k < count; ++k) {
        const Hypothesis& hypothesis = at(first + k);
        if (hypothesis.iteration >= last_iteration_) return;
        if (near_plane[k] <= best_count_ || count_near(table_, poses[k], near_plane[k], best_count_) <= best_count_)
          continue;
        keep_if_better(hypothesis);
      }
    }
  }

  void keep_if_better(const Hypothesis& hypothesis) {
    int agreeing = 0;
    for (int row = 0; row < matches_.size(); ++row) agreeing += agrees(hypothesis.target_from_source, row);
    if (agreeing <= best_count_) return;
    best_count_ = agreeing;
    best_ = hypothesis.target_from_source;
    if (options_.confidence > 0) stop_when_confident(hypothesis.iteration);
  }

  /// The number of triples of which, with this probability, one holds only correct matches, if the best count is their number.
  void stop_when_confident(int iteration) {
    const double all_right = std::pow(static_cast<double>(best_count_) / matches_.size(), 3);
    const double needed = std::log1p(-options_.confidence) / std::log1p(-all_right);
    if (needed < last_iteration_) last_iteration_ = std::max(iteration + 1, static_cast<int>(std::ceil(needed)));
  }

  bool agrees(const RigidTransform& motion, int row) const {
    const Points& p = matches_.source_points;
    const Points& q = matches_.target_points;
    const Eigen::Matrix3d& r = motion.rotation;
    const Eigen::Vector3d& t = motion.translation;
    const double x = r(0, 0) * p(row, 0) + r(0, 1) * p(row, 1) + r(0, 2) * p(row, 2) + t(0) - q(row, 0);
    const double y = r(1, 0) * p(row, 0) + r(1, 1) * p(row, 1) + r(1, 2) * p(row, 2) + t(1) - q(row, 1);
    const double z = r(2, 0) * p(row, 0) + r(2, 1) * p(row, 1) + r(2, 2) * p(row, 2) + t(2) - q(row, 2);
    return std::sqrt(x * x + y * y + z * z) < tolerance_;
  }

  const Hypothesis& at(int index) const { return hypotheses_[static_cast<std::size_t>(index)]; }

  const CorrespondenceSet& matches_;
  const RansacOptions& options_;
  const double tolerance_, smallest_area_;
  const FilterTable table_;
  std::vector<Hypothesis> hypotheses_;
  Triple triple_{};
  LaneTriangles source_, target_;
  LaneMotions motions_;
  int best_count_ = 0;
  int last_iteration_;
  RigidTransform best_;
};

}  // namespace

GroupingResult group_by_ransac(const CorrespondenceSet& matches, const RansacOptions& options) {
  validate_options(options, "ransac");
  matches.validate();
  if (matches.size() < 3) return {};
  return Search(matches, options).run();
}

double working_memory(int matches, const RansacOptions&) {
  return FilterTable::memory(matches) + 12.0 * matches + 200.0 * kBatch;  // the selection as it grows, the hypotheses
}

}  // namespace corral
