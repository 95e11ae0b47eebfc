// SPDX-License-Identifier: MIT
#include "kernel/surface/matching/feature_filter.h"

#include <hwy/cache_control.h>

#include <cmath>
#include <numeric>
#include <utility>

#include "kernel/surface/matching/feature_scores.h"
#include "kernel/surface/matching/nearest_features.h"

namespace corral {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr int kSeeds = 4;
constexpr int kFetched = 8;  // candidates whose memory is asked for ahead
constexpr int kTasks = 16;
constexpr int kGroupMembers = kPanelColumns / kFloatLanes;
constexpr float kLowest = std::numeric_limits<float>::lowest();  // the score of padding and of seeds
constexpr float kLeastScore = -3e38F;                            // any other score is above
constexpr double kUnit = 0x1p-24;                                // of float
constexpr double kTiny = 1e-30;                                  // more than underflow may take away

std::size_t size_of(int count, int each) { return static_cast<std::size_t>(count) * static_cast<std::size_t>(each); }

Index offset(int row, int panels, int each) { return static_cast<Index>(row) * panels * each; }

/// Scores are grouped as score_columns() says.
int column_of(int group, int member) {
  return group / kFloatLanes * kPanelColumns + group % kFloatLanes + member * kFloatLanes;
}

}  // namespace

FilterScratch::FilterScratch(Index dimension, int panels)
    : rows(dimension, FeatureFilter::kRows),
      scores(size_of(FeatureFilter::kRows * panels, kPanelColumns)),
      tops(size_of(FeatureFilter::kRows * panels, kFloatLanes)),
      groups(size_of(panels + 1, kFloatLanes)) {
  for (Query& query : queries) {
    query.seeds.resize(kSeeds);
    query.chosen.resize(size_of(panels, kPanelColumns));
    query.fine.resize(size_of(panels, kPanelColumns));
  }
}

FeatureFilter::FeatureFilter(const MatrixXd& source, const MatrixXd& target, const ParallelFor& parallel)
    : source_(source), target_(target), projection_(source, target) {
  if (!projection_.usable()) return;
  panels_ = static_cast<int>((target.cols() + kPanelColumns - 1) / kPanelColumns);
  coarse_.resize(size_of(panels_, kPanelColumns * kCoarseNumbers));
  fine_.resize(size_of(panels_, kPanelColumns * kFineNumbers));
  panel_errors_.resize(size_of(panels_, 1));
  panel_squared_.resize(size_of(panels_, 1));
  const int each = (panels_ + kTasks - 1) / kTasks;
  parallel((panels_ + each - 1) / each, [&](int task) { pack(task * each, std::min(panels_, (task + 1) * each)); });
  error_ = *std::max_element(panel_errors_.begin(), panel_errors_.end());
  largest_squared_ = *std::max_element(panel_squared_.begin(), panel_squared_.end());
}

void FeatureFilter::pack(int first_panel, int end_panel) {
  ProjectedFeatures projected(target_.rows(), kPanelColumns);
  for (int panel = first_panel; panel < end_panel; ++panel) {
    const Index first = static_cast<Index>(panel) * kPanelColumns;
    const int count = static_cast<int>(std::min<Index>(kPanelColumns, target_.cols() - first));
    projection_.project(target_, first, count, projected);
    float* coarse = coarse_.data() + first * kCoarseNumbers;
    float* fine = fine_.data() + first * kFineNumbers;
    for (int i = 0; i < count; ++i) {
      for (int k = 0; k < kCoarseNumbers - 1; ++k)
        coarse[k * kPanelColumns + i] = projected.coarse[i * kCoarseNumbers + k];
      std::copy_n(projected.fine.begin() + i * kFineNumbers, kFineNumbers - 1, fine + i * kFineNumbers);
      coarse[(kCoarseNumbers - 1) * kPanelColumns + i] = static_cast<float>(-projected.coarse_squared[i] / 2);
      fine[(i + 1) * kFineNumbers - 1] = static_cast<float>(-projected.fine_squared[i] / 2);
      panel_errors_[panel] = std::max(panel_errors_[panel], projected.error[i]);
      panel_squared_[panel] = std::max({panel_squared_[panel], projected.coarse_squared[i], projected.fine_squared[i]});
    }
    std::fill(coarse + (kCoarseNumbers - 1) * kPanelColumns + count, coarse + kCoarseNumbers * kPanelColumns, kLowest);
  }
}

void FeatureFilter::score(Index first, int count, FilterScratch& scratch) const {
  projection_.project(source_, first, count, scratch.rows);
  const FloatRows rows{scratch.rows.coarse.data(), kCoarseNumbers, (count + kRowTile - 1) / kRowTile * kRowTile};
  score_columns(coarse_.data(), panels_, kCoarseNumbers, rows, scratch.scores.data(), scratch.tops.data());
}

// A score is s = x'.y' - |y'|^2 / 2 = (|x'|^2 - |x' - y'|^2) / 2. Let D^2 = `squared` be a distance as computed in
// double, off by less than 1 + gamma. If the target is as near, then |x' - y'| <= D + both errors, so s is at least what
// that gives. As computed in float, s is off by (steps + 2) u times the magnitudes that are added, |x'| |y'| + |y'|^2 / 2.
float ScoreBound::least(double squared) const {
  const double gamma = static_cast<double>(dimension + 32) * 0x1p-52;
  const double reach = std::sqrt(squared) * scale * (1 + gamma) + kTiny + errors;
  const double magnitudes = std::sqrt(own_squared * largest_squared) + largest_squared / 2;
  const double slack = 1.01 * (steps + 6) * kUnit * magnitudes + kTiny;
  const double least = (own_squared - reach * reach * (1 + 1e-12)) / 2 - slack;
  return static_cast<float>(std::max<double>(kLeastScore, least - 2 * kUnit * std::abs(least)));
}

ScoreBound FeatureFilter::bound(double own_squared, double own_error, int steps) const {
  return {target_.rows(), projection_.scale(), own_squared, own_error + error_, largest_squared_, steps};
}

void FeatureFilter::fetch(const int* columns, int count) const {
  const Index rows = target_.rows();
  for (int i = 0; i < count; ++i)
    for (Index row = 0; row < rows; row += kLanes) hwy::Prefetch(target_.data() + columns[i] * rows + row);
}

/// The best few by their fine scores of the best of each sixteenth by their coarse ones.
void FeatureFilter::choose_seeds(int row, FilterScratch& scratch, Query& query) const {
  query.row = row;
  query.seed_count = 0;
  query.nearest = {};
  if (!(scratch.rows.error[row] < std::numeric_limits<double>::infinity())) return;
  float* scores = scratch.scores.data() + offset(row, panels_, kPanelColumns);
  float best[kFloatLanes];
  int at[kFloatLanes];
  best_of_lanes(scratch.tops.data() + offset(row, panels_, kFloatLanes), panels_ * kFloatLanes, best, at);
  for (int& place : at) {
    const float* const members = scores + column_of(place, 0);
    int top = 0;  // without a branch: it could not be predicted
    for (int member = 1; member < kGroupMembers; ++member)
      top += (members[member * kFloatLanes] > members[top * kFloatLanes]) * (member - top);
    place = column_of(place, top);
  }
  score_chosen(scratch.rows.fine.data() + row * kFineNumbers, fine_.data(), at, kFloatLanes, best);
  float top[kSeeds];
  std::fill_n(top, kSeeds, kLowest);
  for (int lane = 0; lane < kFloatLanes; ++lane) {
    float value = best[lane];
    int column = at[lane];
    for (int k = 0; k < kSeeds && column < target_.cols(); ++k)
      if (value > top[k]) std::swap(value, top[k]), std::swap(column, query.seeds[k]);
  }
  query.seed_count = kSeeds;
  for (const int seed : query.seeds) scores[seed] = kLowest;  // not found again
  fetch(query.seeds.data(), kSeeds);
}

void FeatureFilter::choose_candidates(Index first, FilterScratch& scratch, Query& query) const {
  const int row = query.row;
  const ProjectedFeatures& own = scratch.rows;
  if (query.seed_count == 0) {  // floats cannot carry the feature
    require_finite_features(source_.col(first + row), "source");
    query.count = static_cast<int>(target_.cols());
    std::iota(query.chosen.begin(), query.chosen.begin() + query.count, 0);
    std::fill_n(query.fine.begin(), query.count, 0.F);
    return;
  }
  offer(source_.col(first + row).data(), {target_.data(), target_.rows(), query.seeds.data(), kSeeds, 0},
        query.nearest);
  const double squared = query.nearest.second_squared;
  const float coarse = bound(own.coarse_squared[row], own.error[row], kCoarseNumbers).least(squared);
  const float fine = bound(own.fine_squared[row], own.error[row], kFineNumbers).least(squared);
  const float* scores = scratch.scores.data() + offset(row, panels_, kPanelColumns);
  const int groups = reaching(scratch.tops.data() + offset(row, panels_, kFloatLanes), panels_ * kFloatLanes, coarse,
                              scratch.groups.data());
  int found = 0;
  for (int i = 0; i < groups; ++i) {
    const int first_member = column_of(static_cast<int>(scratch.groups[i]), 0);
    for (int column = first_member; column < first_member + kPanelColumns; column += kFloatLanes) {
      query.chosen[found] = column;
      found += scores[column] >= coarse ? 1 : 0;
    }
  }
  score_chosen(own.fine.data() + row * kFineNumbers, fine_.data(), query.chosen.data(), found, query.fine.data());
  query.count = 0;
  for (int i = 0; i < found; ++i) {
    query.chosen[query.count] = query.chosen[i];
    query.fine[query.count] = query.fine[i];
    query.count += query.fine[i] >= fine ? 1 : 0;
  }
  fetch(query.chosen.data(), std::min(query.count, kFetched));
}

TwoNearest FeatureFilter::measure_candidates(Index first, const FilterScratch& scratch, const Query& query) const {
  TwoNearest nearest = query.nearest;
  offer_scored(source_.col(first + query.row).data(),
               {target_.data(), target_.rows(), query.chosen.data(), query.count, kFetched}, query.fine.data(),
               bound(scratch.rows.fine_squared[query.row], scratch.rows.error[query.row], kFineNumbers), nearest);
  return nearest;
}

}  // namespace corral
