// SPDX-License-Identifier: MIT
#include "grouping/ransac.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "grouping/columns/compatibility.h"
#include "grouping/columns/filter_loops.h"
#include "grouping/pose/pose_choice.h"
#include "grouping/pose/triple_sampler.h"
#include "kernel/triangle_fit.h"

namespace corral {
namespace {

/// Smallest usable area of a sampled triangle in pr^2; below it the pose is decided by noise.
constexpr double kDegenerateAreaPr2 = 1e-3;

constexpr int kBatch = 128;  ///< iterations that are drawn and fitted together

/// The motion through one of the triples drawn.
struct Hypothesis {
  int iteration;
  RigidTransform target_from_source;
};

PoseRule rule_of(const RansacOptions& options) {
  PoseRule rule;
  rule.score = options.score;
  rule.tolerance_pr = options.tolerance_pr;
  rule.keep = options.keep;
  rule.first_wins = true;
  rule.fewest = 1;
  return rule;
}

class Search {
 public:
  Search(const CorrespondenceSet& matches, const RansacOptions& options)
      : matches_(matches),
        options_(options),
        tolerance_(options.tolerance_pr * matches.resolution),
        smallest_area_(kDegenerateAreaPr2 * matches.resolution * matches.resolution),
        table_(matches),
        scorer_(matches, options.score, tolerance_),
        choice_(matches, rule_of(options)),
        last_iteration_(options.iterations) {
    hypotheses_.reserve(kBatch);
    if (options.sampling == TripleSampling::Prosac) progressive_.emplace(matches, options.iterations);
  }

  GroupingResult run() {
    RandomStream random(options_.seed);
    for (int first = 0; first < last_iteration_; first += kBatch) {
      draw(random, first, std::min(kBatch, last_iteration_ - first));
      judge();
    }
    return choice_.finish();
  }

 private:
  Triple draw_one(RandomStream& random) {
    if (progressive_) return progressive_->draw(random);
    return options_.sampling == TripleSampling::Compatible ? draw_compatible_triple(random, matches_, tolerance_)
                                                           : draw_triple(random, matches_.size());
  }

  /// Whether every edge has the same length on both sides, as far as the option asks for it.
  bool is_rigid(const Triple& triple) const {
    if (options_.edge_similarity == 0) return true;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const PairDistances edge = pair_distances(matches_, triple[corner], triple[(corner + 1) % 3]);
      if (!(rigidity_ratio(edge.source, edge.target) >= options_.edge_similarity)) return false;
    }
    return true;
  }

  /// The usable hypotheses of the next iterations, in order.
  void draw(RandomStream& random, int first, int count) {
    hypotheses_.clear();
    int iterations[kLanes];
    int filled = 0;
    const auto fit = [&] {
      for (int lane = filled; lane < kLanes; ++lane) set(lane);  // the lanes left over repeat the last one
      fit_triangles(source_, target_, smallest_area_, motions_);
      for (int lane = 0; lane < filled; ++lane)
        if (motions_.is_usable(lane)) hypotheses_.push_back({iterations[lane], motions_.get(lane)});
      filled = 0;
    };
    for (int iteration = first; iteration < first + count; ++iteration) {
      const Triple triple = draw_one(random);
      if (!is_rigid(triple)) continue;
      triple_ = triple;
      set(filled);
      iterations[filled] = iteration;
      if (++filled == kLanes) fit();
    }
    if (filled > 0) fit();
  }
  void set(int lane) {
    source_.set(lane, matches_.source_points, triple_);
    target_.set(lane, matches_.target_points, triple_);
  }

  /// Keeps the best hypothesis. Floats count the matches that possibly agree, first in one direction, then in all; no score
  /// exceeds their number. Most hypotheses have too few of them and are never judged exactly.
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
        const int hopeless =
            choice_.needs_all() ? -1 : static_cast<int>(std::floor(std::max(choice_.best_score(), 0.0)));
        if (near_plane[k] <= hopeless || count_near(table_, poses[k], near_plane[k], hopeless) <= hopeless) continue;
        offer(hypothesis);
      }
    }
  }

  void offer(const Hypothesis& hypothesis) {
    if (!choice_.offer(hypothesis.target_from_source)) return;
    RigidTransform best = hypothesis.target_from_source;
    if (options_.local_rounds > 0) {
      best = refit(matches_, best, scorer_, tolerance_, options_.local_rounds);
      choice_.offer(best);
    }
    if (options_.confidence > 0) stop_when_confident(best, hypothesis.iteration);
  }

  /// The number of triples of which, with this probability, one holds only correct matches, if those that agree with the
  /// best pose are correct.
  void stop_when_confident(const RigidTransform& best, int iteration) {
    measure_residuals(matches_, best, residuals_);
    const auto agreeing = static_cast<double>(rows_within(residuals_, tolerance_).size());
    const double all_right = std::pow(agreeing / matches_.size(), 3);
    const double needed = std::log1p(-options_.confidence) / std::log1p(-all_right);
    if (needed < last_iteration_) last_iteration_ = std::max(iteration + 1, static_cast<int>(std::ceil(needed)));
  }

  const Hypothesis& at(int index) const { return hypotheses_[static_cast<std::size_t>(index)]; }

  const CorrespondenceSet& matches_;
  const RansacOptions& options_;
  const double tolerance_, smallest_area_;
  const FilterTable table_;
  const PoseScorer scorer_;
  PoseChoice choice_;
  std::optional<ProgressiveSampler> progressive_;
  std::vector<Hypothesis> hypotheses_;
  std::vector<double> residuals_;
  Triple triple_{};
  LaneTriangles source_, target_;
  LaneMotions motions_;
  int last_iteration_;
};

}  // namespace

GroupingResult group_by_ransac(const CorrespondenceSet& matches, const RansacOptions& options) {
  validate_options(options, "ransac");
  if (options.sampling == TripleSampling::Prosac)
    require_columns(matches, "ransac", {Column::FeatureDistance, Column::SecondFeatureDistance});
  else
    matches.validate();
  if (matches.size() < 3) return {};
  return Search(matches, options).run();
}

double working_memory(int matches, const RansacOptions& options) {
  const bool is_progressive = options.sampling == TripleSampling::Prosac;
  return FilterTable::memory(matches) +
         PoseChoice::memory(matches, (options.local_rounds > 0 ? 2.0 : 1.0) * options.iterations, rule_of(options)) +
         (is_progressive ? ProgressiveSampler::memory(matches) : 0) + 200.0 * kBatch;
}

}  // namespace corral
