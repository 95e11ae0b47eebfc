// SPDX-License-Identifier: MIT
#include "grouping/search_of_inliers.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <utility>

#include "grouping/columns/compatibility.h"
#include "grouping/columns/filter_loops.h"

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

/// Calls visit(i) for every mark that is set; most are not. Their number is a multiple of 8.
template <class Visit>
void visit_marks(const std::vector<std::uint8_t>& marks, Visit visit) {
  for (std::size_t first = 0; first < marks.size(); first += 8) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, &marks[first], 8);
    for (std::size_t i = first; eight != 0 && i < first + 8; ++i)
      if (marks[i]) visit(static_cast<int>(i));
  }
}

class Voting {
 public:
  Voting(const CorrespondenceSet& matches, const SearchOfInliersOptions& options)
      : matches_(matches),
        options_(options),
        tolerance_(options.tolerance_pr * matches.resolution),
        table_(matches),
        filter_(options.similarity),
        squared_(static_cast<std::size_t>(table_.padded_rows())),
        trusted_(squared_.size(), 0),
        marks_(squared_.size(), 0) {
    for (int row = 0; row < matches.size(); ++row) trusted_[static_cast<std::size_t>(row)] = is_trusted(row);
  }

  Votes local_votes(int row) {
    measure_distances(table_, row, squared_.data());
    const int neighbours = std::min(options_.voters, matches_.size() - 1);
    const float nearer = part_neighbours(row, neighbours);
    FilteredVotes near = ask_near(table_, filter_, row, squared_.data(), nearer, trusted_.data());
    if (near.certain != near.possible) near.certain = count_near_votes(row, nearer);
    Votes votes{near.certain, near.asked};
    for (const auto& [distance, voter] : undecided_) {
      if (!is_trusted(voter)) continue;
      ++votes.asked;
      votes.positive += agrees(row, voter);
    }
    return votes;
  }

  /// Chooses the global voters.
  void set_global_voters(const Indices& rows) {
    global_voters_ = rows;
    voter_table_ = table_.subset(rows);
    voter_of_row_.assign(squared_.size(), -1);
    for (std::size_t i = 0; i < rows.size(); ++i)
      voter_of_row_[static_cast<std::size_t>(rows[i])] = static_cast<int>(i);
  }

  Votes global_votes(int row) {
    const auto i = static_cast<std::size_t>(row);
    const int own_vote = voter_of_row_[i];
    Votes votes{0, static_cast<int>(global_voters_.size()) - (own_vote >= 0 ? 1 : 0)};
    if (!is_valid_frame(matches_.source_frames[i]) || !is_valid_frame(matches_.target_frames[i])) return votes;
    RigidTransform pose = transform_from_frames(matches_, row);
    if (options_.form == VotingForm::Rotation) pose.translation.setZero();

    const float hidden = own_vote >= 0 ? voter_table_.hide(own_vote) : 0;
    const FilteredVotes found = ask_voters(voter_table_, filter_, table_, row, {table_, pose, tolerance_});
    if (own_vote >= 0) voter_table_.show(own_vote, hidden);
    votes.positive = found.certain == found.possible ? found.certain : count_global_votes(row, pose);
    return votes;
  }

 private:
  /// The `count` nearest of all other rows by distance in double, ties to the lower row: those whose squared float
  /// distance is below what this returns, and what it leaves in undecided_. Floats bracket the last neighbour between two
  /// distances; what is within twice their error of the bracket is sorted by its double.
  float part_neighbours(int row, int count) {
    const int size = static_cast<int>(squared_.size());
    float low = -1, high = 16;  // more than any squared distance in the table
    int below = 0, up_to = matches_.size() - 1;
    float limits[kLimits] = {0.6F * bracket_, 0.85F * bracket_, 1.2F * bracket_, 1.7F * bracket_};  // as the row before
    for (int step = 0; step < kMostSteps && up_to - below > kLastBracket; ++step) {
      int counts[kLimits];
      count_up_to(squared_.data(), size, limits, counts);
      for (int k = 0; k < kLimits; ++k) {
        if (counts[k] < count && limits[k] > low) low = limits[k], below = counts[k];
        if (counts[k] >= count && limits[k] < high) high = limits[k], up_to = counts[k];
      }
      const float start = std::max(low, 0.0F), width = (high - start) / (kLimits + 1);
      for (int k = 0; k < kLimits; ++k) limits[k] = start + static_cast<float>(k + 1) * width;
    }
    bracket_ = high;
    const double twice = 2 * kFilterDistanceError;
    const double first = std::sqrt(std::max<double>(low, 0)) - twice, last = std::sqrt(high) + twice;
    const float nearer = first > 0 ? static_cast<float>(first * first * (1 - 1e-6)) : 0;
    const auto end = static_cast<float>(last * last * (1 + 1e-6));
    const int certain = mark_between(squared_.data(), size, nearer, end, marks_.data());
    undecided_.clear();
    visit_marks(marks_,
                [&](int other) { undecided_.emplace_back(point_distance(matches_.source_points, row, other), other); });
    std::sort(undecided_.begin(), undecided_.end());
    undecided_.resize(static_cast<std::size_t>(count - certain));
    return nearer;
  }

  int count_near_votes(int row, float nearer) const {
    int positive = 0;
    for (int voter = 0; voter < matches_.size(); ++voter)
      if (squared_[static_cast<std::size_t>(voter)] < nearer && is_trusted(voter)) positive += agrees(row, voter);
    return positive;
  }

  int count_global_votes(int row, const RigidTransform& pose) const {
    int positive = 0;
    for (const int voter : global_voters_) {
      if (voter == row || !agrees(row, voter)) continue;
      const Eigen::Vector3d moved = pose * matches_.source_points.row(voter).transpose();
      positive += (moved - matches_.target_points.row(voter).transpose()).norm() < tolerance_;
    }
    return positive;
  }

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

  static constexpr int kLastBracket = 8;  ///< so few candidates are sorted
  static constexpr int kMostSteps = 16;   ///< of the search for them: rounding, or equal distances, may allow no fewer

  const CorrespondenceSet& matches_;
  const SearchOfInliersOptions& options_;
  const double tolerance_;
  const FilterTable table_;
  const SimilarityFilter filter_;
  FloatColumn squared_, trusted_;                  // of all rows
  std::vector<std::uint8_t> marks_;                // of all rows
  std::vector<std::pair<double, int>> undecided_;  // distance, row
  float bracket_ = 1;                              // where the search for the last neighbour begins
  Indices global_voters_, voter_of_row_;
  FilterTable voter_table_ = table_;
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

  Voting voting(matches, options);
  std::vector<Votes> local;
  std::vector<double> rank = ratio_scores(feature_ratios(matches));  // by which the global voters are chosen
  for (int row = 0; row < matches.size(); ++row) local.push_back(voting.local_votes(row));
  if (options.form == VotingForm::Covis)
    std::transform(local.begin(), local.end(), rank.begin(), [](const Votes& votes) { return votes.score(); });
  const Indices global_voters = best_rows(matches.size(), options.voters, [&](int a, int b) {
    return rank[static_cast<std::size_t>(a)] > rank[static_cast<std::size_t>(b)];
  });

  voting.set_global_voters(global_voters);
  for (int row = 0; row < matches.size(); ++row) {
    const Votes& near = local[static_cast<std::size_t>(row)];
    const Votes all = voting.global_votes(row);
    result.scores.push_back(Votes{near.positive + all.positive, near.asked + all.asked}.score());
  }
  result.selected = select_by_otsu(result.scores, options.otsu);
  return result;
}

double working_memory(int matches, const SearchOfInliersOptions& options) {
  // Two tables, columns of floats and marks, the neighbours that are sorted, votes, ranks and scores, some as they grow.
  return 2 * FilterTable::memory(matches) + 160.0 * matches + otsu_memory(matches, options.otsu) + 4096;
}

}  // namespace corral
