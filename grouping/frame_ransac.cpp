// SPDX-License-Identifier: MIT
#include "grouping/frame_ransac.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "grouping/columns/canonical_order.h"
#include "grouping/columns/compatibility.h"
#include "grouping/columns/filter_loops.h"
#include "grouping/pose/pose_choice.h"

namespace corral {
namespace {

constexpr int kFewest = 3;          ///< matches in agreement with a pose
constexpr std::size_t kBatch = 64;  ///< poses that are judged together
constexpr int kStretch = 1024;      ///< rows that are read for all of them

/// The pose that a match with valid frames proposes.
RigidTransform pose_of(const CorrespondenceSet& matches, int row) {
  RigidTransform pose = transform_from_frames(matches, row);
  if (is_rotation(pose.rotation, 1e-9)) return pose;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(pose.rotation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  pose.rotation = svd.matrixU() * svd.matrixV().transpose();
  pose.translation =
      matches.target_points.row(row).transpose() - pose.rotation * matches.source_points.row(row).transpose();
  return pose;
}

/// A pose, its worth, and one bit for each row: whether it agrees.
struct Ranked {
  RigidTransform pose;
  double score, mae;
  std::vector<std::uint64_t> agreeing;
};
bool is_better(const Ranked& a, const Ranked& b) { return a.score != b.score ? a.score > b.score : a.mae > b.mae; }

/// The best poses that different rows agree with, the best first, of equal ones the first that came.
class Ranking {
 public:
  explicit Ranking(std::size_t most) : most_(most) {}

  static std::size_t most(int rows, int polish) {
    return static_cast<std::size_t>(std::clamp(polish, 1, std::max(rows, 1)));
  }
  static double memory(int rows, int polish) {
    return (most(rows, polish) + 1.0) * (3 * sizeof(Ranked) + (rows + 63) / 64 * sizeof(std::uint64_t));
  }

  const std::vector<Ranked>& poses() const { return poses_; }

  /// A pose with at most so many rows in agreement is not ranked.
  int hopeless() const {
    if (poses_.size() < most_) return kFewest - 1;
    return std::max(kFewest, static_cast<int>(std::ceil(poses_.back().score))) - 1;
  }

  void add(Ranked&& pose) {
    if (poses_.size() == most_ && !is_better(pose, poses_.back())) return;
    const auto twin = std::find_if(poses_.begin(), poses_.end(),
                                   [&](const Ranked& other) { return other.agreeing == pose.agreeing; });
    if (twin != poses_.end()) {
      if (!is_better(pose, *twin)) return;
      poses_.erase(twin);
    }
    poses_.insert(std::upper_bound(poses_.begin(), poses_.end(), pose, is_better), std::move(pose));
    if (poses_.size() > most_) poses_.pop_back();
  }

 private:
  const std::size_t most_;
  std::vector<Ranked> poses_;
};

PoseRule rule_of(const FrameRansacOptions& options) { return {options.score, options.tolerance_pr, 0, options.keep}; }

bool needs_all(const FrameRansacOptions& options) { return options.keep > 0 || options.score == PoseScore::Fs; }

/// Poses that are counted together.
struct Tile {
  PoseFilter poses[kPoseTile];
  int near[kPoseTile] = {};
};

class Search {
 public:
  Search(const CorrespondenceSet& matches, const FrameRansacOptions& options)
      : matches_(matches),
        options_(options),
        tolerance_(options.tolerance_pr * matches.resolution),
        table_(matches),
        scorer_(matches, options.score, tolerance_),
        mae_(matches, PoseScore::Mae, tolerance_),
        ranking_(Ranking::most(matches.size(), options.polish)),
        choice_(matches, rule_of(options)) {
    proposed_.reserve(kBatch);
  }

  GroupingResult run() {
    for (int row = 0; row < matches_.size(); ++row) {
      const auto i = static_cast<std::size_t>(row);
      if (!is_valid_frame(matches_.source_frames[i]) || !is_valid_frame(matches_.target_frames[i])) continue;
      proposed_.push_back(pose_of(matches_, row));
      if (proposed_.size() == kBatch) judge();
    }
    judge();
    for (const Ranked& one : ranking_.poses())
      choice_.offer(options_.polish > 0 ? refit(matches_, one.pose, scorer_, tolerance_, options_.refit_rounds)
                                        : one.pose);
    return choice_.finish();
  }

 private:
  /// Floats count for each pose the rows that possibly agree: most poses have too few of them and are never counted exactly.
  void judge() {
    const std::size_t count = proposed_.size();
    proposed_.resize(kBatch);  // those left over are not looked at
    Tile tiles[kBatch / kPoseTile];
    for (std::size_t k = 0; k < kBatch; ++k)
      tiles[k / kPoseTile].poses[k % kPoseTile] = PoseFilter(table_, proposed_[k], tolerance_);
    const std::size_t used = (count + kPoseTile - 1) / kPoseTile;
    for (int first = 0; first < table_.padded_rows(); first += kStretch)
      for (std::size_t k = 0; k < used; ++k)
        add_near(table_, first, std::min(first + kStretch, table_.padded_rows()), tiles[k].poses, tiles[k].near);
    for (std::size_t k = 0; k < count; ++k) {
      const int hopeless = needs_all(options_) ? kFewest - 1 : ranking_.hopeless();
      if (tiles[k / kPoseTile].near[k % kPoseTile] > hopeless) rank(proposed_[k]);
    }
    proposed_.clear();
  }

  void rank(const RigidTransform& pose) {
    measure_residuals(matches_, pose, residuals_);
    Ranked ranked{pose, scorer_(residuals_), mae_(residuals_), {}};
    ranked.agreeing.resize((residuals_.size() + 63) / 64);
    int count = 0;
    for (std::size_t row = 0; row < residuals_.size(); ++row) {
      const bool agrees = residuals_[row] < tolerance_;
      ranked.agreeing[row / 64] |= static_cast<std::uint64_t>(agrees) << row % 64;
      count += agrees;
    }
    if (count < kFewest) return;
    ranking_.add(std::move(ranked));
    if (needs_all(options_)) choice_.offer(pose);
  }

  const CorrespondenceSet& matches_;
  const FrameRansacOptions& options_;
  const double tolerance_;
  const FilterTable table_;
  const PoseScorer scorer_, mae_;
  Ranking ranking_;
  PoseChoice choice_;
  std::vector<RigidTransform> proposed_;
  std::vector<double> residuals_;
};

}  // namespace

GroupingResult group_by_frame_ransac(const CorrespondenceSet& matches, const FrameRansacOptions& options) {
  validate_options(options, "frame-ransac");
  require_columns(matches, "frame-ransac", {Column::SourceFrames, Column::TargetFrames});
  if (matches.size() < kFewest) return {};
  return group_in_canonical_order(matches, [&](const CorrespondenceSet& rows) { return Search(rows, options).run(); });
}

double working_memory(int matches, const FrameRansacOptions& options) {
  const double ranked = static_cast<double>(Ranking::most(matches, options.polish));
  return canonical_order_memory(matches) + FilterTable::memory(matches) + PoseScorer::memory(matches) + 48.0 * matches +
         Ranking::memory(matches, options.polish) + kBatch * sizeof(RigidTransform) +
         PoseChoice::memory(matches, ranked + (needs_all(options) ? matches : 0), rule_of(options));
}

}  // namespace corral
