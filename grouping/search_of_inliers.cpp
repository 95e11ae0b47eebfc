// SPDX-License-Identifier: MIT
#include "grouping/search_of_inliers.h"

#include <algorithm>
#include <numeric>

#include "grouping/compatibility.h"

namespace corral {
namespace {

constexpr double kMaximumRatio = 0.8;  // a local voter passes the ratio test of NNSR

struct Votes {
  int positive = 0;
  int asked = 0;
  double score() const { return asked > 0 ? static_cast<double>(positive) / asked : 0; }
};

/// The `count` best of all rows by `better`, ties to the lower row.
template <class Better>
Indices best_rows(int rows, int count, Better better) {
  Indices order(static_cast<std::size_t>(rows));
  std::iota(order.begin(), order.end(), 0);
  const auto end = order.begin() + std::min(count, rows);
  const auto first = [&](int a, int b) { return better(a, b) || (!better(b, a) && a < b); };
  std::nth_element(order.begin(), end == order.end() ? end - 1 : end, order.end(), first);
  order.erase(end, order.end());
  return order;
}

class Voting {
 public:
  Voting(const CorrespondenceSet& matches, const SearchOfInliersOptions& options)
      : matches_(matches), options_(options), tolerance_(options.tolerance_pr * matches.resolution) {
    for (int row = 0; row < matches.size(); ++row) trusted_.push_back(is_trusted(row));
  }

  Votes local_votes(int row) const {
    const Eigen::ArrayXd squared =
        (matches_.source_points.rowwise() - matches_.source_points.row(row)).rowwise().squaredNorm();
    const auto nearer = [&](int a, int b) {
      if ((a == row) != (b == row)) return a == row;  // the match itself comes first and is dropped below
      return squared(a) < squared(b);
    };
    Votes votes;
    for (const int voter : best_rows(matches_.size(), std::min(options_.voters, matches_.size()) + 1, nearer)) {
      if (voter == row || !trusted_[static_cast<std::size_t>(voter)]) continue;
      ++votes.asked;
      votes.positive += agrees(row, voter);
    }
    return votes;
  }

  Votes global_votes(int row, const Indices& voters) const {
    const auto i = static_cast<std::size_t>(row);
    const bool has_pose = is_valid_frame(matches_.source_frames[i]) && is_valid_frame(matches_.target_frames[i]);
    RigidTransform pose = transform_from_frames(matches_, row);
    if (options_.form == VotingForm::Rotation) pose.translation.setZero();
    Votes votes;
    for (const int voter : voters) {
      if (voter == row) continue;
      ++votes.asked;
      if (!has_pose || !agrees(row, voter)) continue;
      const Eigen::Vector3d moved = pose * matches_.source_points.row(voter).transpose();
      votes.positive += (moved - matches_.target_points.row(voter).transpose()).norm() < tolerance_;
    }
    return votes;
  }

 private:
  bool is_trusted(int row) const {
    const double d1 = matches_.feature_distance(row), d2 = matches_.second_feature_distance(row);
    if (options_.form == VotingForm::Covis) return d2 > 0 && d1 / d2 < kMaximumRatio;
    return passes_ratio_test(d1, d2, kMaximumRatio);
  }

  bool agrees(int i, int j) const {
    const PairDistances distances = pair_distances(matches_, i, j);
    const double ratio = rigidity_ratio(distances.source, distances.target);
    return options_.form == VotingForm::Covis ? ratio >= options_.similarity : ratio > options_.similarity;
  }

  const CorrespondenceSet& matches_;
  const SearchOfInliersOptions& options_;
  const double tolerance_;
  std::vector<bool> trusted_;
};

}  // namespace

GroupingResult group_by_search_of_inliers(const CorrespondenceSet& matches, const SearchOfInliersOptions& options) {
  validate_options(options, "si");
  require_columns(matches, "si",
                  {Column::SourceFrames, Column::TargetFrames, Column::FeatureDistance, Column::SecondFeatureDistance});
  GroupingResult result;
  if (matches.size() <= 2) {
    for (int row = 0; row < matches.size(); ++row) result.selected.push_back(row);
    return result;
  }

  const Voting voting(matches, options);
  std::vector<Votes> local;
  std::vector<double> rank = ratio_scores(matches);  // by which the global voters are chosen
  for (int row = 0; row < matches.size(); ++row) local.push_back(voting.local_votes(row));
  if (options.form == VotingForm::Covis)
    std::transform(local.begin(), local.end(), rank.begin(), [](const Votes& votes) { return votes.score(); });
  const Indices global_voters = best_rows(matches.size(), options.voters, [&](int a, int b) {
    return rank[static_cast<std::size_t>(a)] > rank[static_cast<std::size_t>(b)];
  });

  for (int row = 0; row < matches.size(); ++row) {
    const Votes& near = local[static_cast<std::size_t>(row)];
    const Votes all = voting.global_votes(row, global_voters);
    result.scores.push_back(Votes{near.positive + all.positive, near.asked + all.asked}.score());
  }
  result.selected = select_by_otsu(result.scores, options.otsu);
  return result;
}

}  // namespace corral
