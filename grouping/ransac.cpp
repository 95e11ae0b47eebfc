// SPDX-License-Identifier: MIT
#include "grouping/ransac.h"

#include <hwy/base.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "grouping/columns/compatibility.h"
#include "grouping/columns/filter_loops.h"
#include "grouping/pose/pose_choice.h"
#include "grouping/pose/possible_support.h"
#include "grouping/pose/triple_filter.h"
#include "grouping/pose/triple_sampler.h"
#include "kernel/triangle_fit.h"

namespace corral {
namespace {

/// Smallest usable area of a sampled triangle in pr^2; below it the pose is decided by noise.
constexpr double kDegenerateAreaPr2 = 1e-3;

PoseRule rule_of(const RansacOptions& options) {
  PoseRule rule;
  rule.score = options.score;
  rule.tolerance_pr = options.tolerance_pr;
  rule.keep = options.keep;
  rule.first_wins = true;
  rule.fewest = 1;
  return rule;
}

struct DrawnTriple {
  Triple rows{};
  int iteration = 0;
  Slab slab{};
};

class Search {
 public:
  Search(const CorrespondenceSet& matches, const RansacOptions& options)
      : matches_(matches),
        options_(options),
        tolerance_(options.tolerance_pr * matches.resolution),
        smallest_area_(kDegenerateAreaPr2 * matches.resolution * matches.resolution),
        uniform_(matches.size()),
        support_(matches, tolerance_, smallest_area_),
        filter_(support_.rows(), tolerance_, smallest_area_),
        scorer_(matches, options.score, tolerance_),
        choice_(matches, rule_of(options)),
        last_iteration_(options.iterations) {
    if (options.sampling == TripleSampling::Prosac) progressive_.emplace(matches, options.iterations);
  }

  GroupingResult run() {
    RandomStream random(options_.seed);
    while (iteration_ < last_iteration_ && support_.rows().rows() > hopeless()) {
      draw(random);
      sift();
    }
    judge();
    return choice_.finish();
  }

 private:
  Triple draw_one(RandomStream& random) {
    if (progressive_) return progressive_->draw(random);
    return options_.sampling == TripleSampling::Compatible ? draw_compatible_triple(random, matches_, tolerance_)
                                                           : uniform_.draw(random);
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

  /// The next triples.
  void draw(RandomStream& random) {
    drawn_ = 0;
    while (drawn_ < kFloatLanes && iteration_ < last_iteration_) {
      const Triple triple = draw_one(random);
      const int iteration = iteration_++;
      if (is_rigid(triple)) triples_[drawn_++] = {triple, iteration, {}};
    }
  }

  /// A pose needs more matches in agreement to be chosen; -1 where all poses are needed. No score exceeds their number.
  int hopeless() const {
    return choice_.needs_all() ? -1 : static_cast<int>(std::floor(std::max(choice_.best_score(), 0.0)));
  }

  /// Those of the triples drawn that can win are fitted, eight together.
  void sift() {
    for (unsigned possible = possible_triples() & ((1u << drawn_) - 1); possible != 0; possible &= possible - 1) {
      const auto lane = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(possible));
      sifted_[sifted_count_] = triples_[lane];
      sifted_[sifted_count_++].slab = filter_.slab(lane);
      if (sifted_count_ == kLanes) judge();
    }
  }

  unsigned possible_triples() {
    if (choice_.needs_all() || !filter_.is_sharp()) return ~0u;
    LaneTriangles source[2], target[2];
    for (int k = 0; k < kFloatLanes; ++k) {
      source[k / kLanes].set(k % kLanes, matches_.source_points, triples_[k].rows);
      target[k / kLanes].set(k % kLanes, matches_.target_points, triples_[k].rows);
    }
    for (int half = 0; half < 2; ++half) filter_.set(source[half], target[half], half * kLanes);
    const int spare = support_.rows().rows() - hopeless();  // a pose that misses so many is hopeless
    return filter_.possible(support_.rows(), hopeless(), spare + spare / 4 + 32);
  }

  void set(int lane, const DrawnTriple& drawn) {
    source_.set(lane, matches_.source_points, drawn.rows);
    target_.set(lane, matches_.target_points, drawn.rows);
  }

  /// Keeps the best pose. Floats count the matches that possibly agree: most poses have too few and are never judged exactly.
  void judge() {
    for (int lane = 0; lane < kLanes; ++lane) set(lane, sifted_[lane]);  // lanes left over hold earlier triples
    fit_triangles(source_, target_, smallest_area_, motions_);
    const LaneFilters filters(support_.rows(), motions_, tolerance_);
    const int best = hopeless();
    const int count = std::exchange(sifted_count_, 0);
    for (int lane = 0; lane < count; ++lane) {
      if (!motions_.is_usable(lane) || sifted_[lane].iteration >= last_iteration_) continue;
      if (!choice_.needs_all() && !can_win(filters, lane)) continue;
      offer(motions_.get(lane), sifted_[lane].iteration);
    }
    if (hopeless() > best && is_worth_pruning()) support_.exceed(hopeless(), choice_.best_residuals());
  }

  bool can_win(const LaneFilters& filters, int lane) const {
    Slab slab = sifted_[lane].slab;
    slab.within = filters.within[lane];
    return count_near(support_.rows(), filters.get(lane), slab, hopeless()) > hopeless();
  }

  /// Whether matches that few others keep their distance to are looked for: in time quadratic in their number.
  bool is_worth_pruning() const {
    return hopeless() >= matches_.size() / 8 && matches_.size() <= (last_iteration_ - iteration_) / 4;
  }

  void offer(const RigidTransform& pose, int iteration) {
    if (!choice_.offer(pose)) return;
    RigidTransform best = pose;
    if (options_.local_rounds > 0) {
      best = refit(matches_, best, scorer_, tolerance_, options_.local_rounds);
      choice_.offer(best);
    }
    if (options_.confidence > 0) stop_when_confident(best, iteration);
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

  const CorrespondenceSet& matches_;
  const RansacOptions& options_;
  const double tolerance_, smallest_area_;
  const UniformSampler uniform_;
  PossibleSupport support_;
  TripleFilter filter_;
  const PoseScorer scorer_;
  PoseChoice choice_;
  std::optional<ProgressiveSampler> progressive_;
  std::vector<double> residuals_;
  DrawnTriple triples_[kFloatLanes], sifted_[kLanes];
  LaneTriangles source_, target_;
  LaneMotions motions_;
  int drawn_ = 0, sifted_count_ = 0;
  int iteration_ = 0, last_iteration_;
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
  return PossibleSupport::memory(matches) +
         PoseChoice::memory(matches, (options.local_rounds > 0 ? 2.0 : 1.0) * options.iterations, rule_of(options)) +
         (is_progressive ? ProgressiveSampler::memory(matches) : 0) + 8192;
}

}  // namespace corral
