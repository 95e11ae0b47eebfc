// SPDX-License-Identifier: MIT
#include "grouping/consistency_voting.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "grouping/columns/canonical_order.h"
#include "grouping/columns/compatibility.h"
#include "kernel/elementary.h"

namespace corral {
namespace {

class Vote {
 public:
  Vote(const CorrespondenceSet& matches, const ConsistencyVotingOptions& options)
      : matches_(matches),
        scale_(options.scale_pr * matches.resolution),
        scale_rad_(options.scale_deg * std::acos(-1.0) / 180),
        optional_(options.frames == FrameNeed::Optional) {
    has_frames_.resize(static_cast<std::size_t>(matches.size()));
    if (matches.source_frames.empty() || matches.target_frames.empty()) return;
    for (std::size_t i = 0; i < has_frames_.size(); ++i)
      has_frames_[i] = is_valid_frame(matches.source_frames[i]) && is_valid_frame(matches.target_frames[i]);
  }

  double operator()(int i, int j) const {
    const PairDistances lengths = pair_distances(matches_, i, j);
    const double stretch = (lengths.source - lengths.target) / scale_;
    if (has_frames_[static_cast<std::size_t>(i)] && has_frames_[static_cast<std::size_t>(j)]) {
      const double turn = angle(static_cast<std::size_t>(i), static_cast<std::size_t>(j)) / scale_rad_;
      return exponential(-stretch * stretch - turn * turn);
    }
    return optional_ ? exponential(-stretch * stretch) : 0;
  }

 private:
  /// Of the rotation that carries the relative frame in the source to that in the target; accurate for small angles. Of j and i the
  /// same to the last bit, on every machine: that is why sums are written out.
  double angle(std::size_t i, std::size_t j) const {
    const auto square = [&](int a, int b) {
      const double change = relative(matches_.target_frames, i, j, a, b) - relative(matches_.source_frames, i, j, a, b);
      return change * change;
    };
    const double sum = square(0, 0) + square(1, 1) + square(2, 2) + (square(0, 1) + square(1, 0)) +
                       (square(0, 2) + square(2, 0)) + (square(1, 2) + square(2, 1));
    const double half = std::min(1.0, std::sqrt(sum / 8));  // sine of half the angle
    return 2 * arc_sine(half);
  }

  /// Entry of F_i F_j^T.
  static double relative(const LocalReferenceFrames& frames, std::size_t i, std::size_t j, int a, int b) {
    return frames[i](a, 0) * frames[j](b, 0) + frames[i](a, 1) * frames[j](b, 1) + frames[i](a, 2) * frames[j](b, 2);
  }

  const CorrespondenceSet& matches_;
  const double scale_, scale_rad_;
  const bool optional_;
  std::vector<char> has_frames_;
};

Indices voters_of(const CorrespondenceSet& matches, int count) {
  const std::vector<double> scores = ratio_scores(feature_ratios(matches));
  Indices rows(scores.size());
  std::iota(rows.begin(), rows.end(), 0);
  std::stable_sort(rows.begin(), rows.end(), [&](int a, int b) {
    return scores[static_cast<std::size_t>(a)] > scores[static_cast<std::size_t>(b)];
  });
  rows.resize(std::min(rows.size(), static_cast<std::size_t>(count)));
  return rows;
}

GroupingResult group_in_order(const CorrespondenceSet& matches, const ConsistencyVotingOptions& options) {
  const Indices voters = voters_of(matches, options.voters);
  const Vote vote(matches, options);
  GroupingResult result;
  for (int row = 0; row < matches.size(); ++row) {
    double sum = 0;
    int asked = 0;
    for (const int voter : voters) {
      if (voter == row) continue;
      sum += vote(row, voter);
      ++asked;
    }
    result.scores.push_back(asked > 0 ? sum / asked : 0);
  }
  result.selected = select_by_otsu(result.scores, options.otsu);
  return result;
}

}  // namespace

GroupingResult group_by_consistency_voting(const CorrespondenceSet& matches, const ConsistencyVotingOptions& options) {
  validate_options(options, "cv");
  if (options.frames == FrameNeed::Required)
    require_columns(
        matches, "cv",
        {Column::SourceFrames, Column::TargetFrames, Column::FeatureDistance, Column::SecondFeatureDistance});
  else
    require_columns(matches, "cv", {Column::FeatureDistance, Column::SecondFeatureDistance});
  return group_in_canonical_order(matches,
                                  [&](const CorrespondenceSet& sorted) { return group_in_order(sorted, options); });
}

double working_memory(int matches, const ConsistencyVotingOptions& options) {
  return canonical_order_memory(matches) + 60.0 * matches + otsu_memory(matches, options.otsu);
}

}  // namespace corral
