// SPDX-License-Identifier: MIT
#include "apps/dataset/challenge_table.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "kernel/error.h"
#include "kernel/evaluation.h"
#include "kernel/random.h"

namespace corral {
namespace {

constexpr double kBeside_pr = 5;
constexpr int kMostTries = 10'000;

/// A row of the new table: of which rows of the real one it has its two sides, and how its points are moved.
struct DrawnRow {
  int source = 0, target = 0;
  Eigen::RowVector3d source_shift = Eigen::RowVector3d::Zero(), target_shift = Eigen::RowVector3d::Zero();
};

class Drawing {
 public:
  Drawing(const CorrespondenceSet& real, const RigidTransform& truth, const ChallengeOptions& options)
      : real_(real), truth_(truth), options_(options), stream_(options.seed) {
    const std::vector<bool> labels = label_correct(real, truth, options.threshold_pr);
    for (int row = 0; row < real.size(); ++row)
      (labels[static_cast<std::size_t>(row)] ? correct_ : incorrect_).push_back(row);
  }

  std::vector<DrawnRow> draw() {
    const auto correct = static_cast<int>(std::llround(options_.matches * options_.inlier_ratio / 100));
    if (correct > 0 && correct_.empty())
      throw InvalidInput("challenge", "correct matches of the table", "0", "some to draw from");
    if (correct < options_.matches && incorrect_.size() < 2)
      throw InvalidInput("challenge", "incorrect matches of the table", std::to_string(incorrect_.size()), "2 or more");
    std::vector<DrawnRow> rows;
    add(rows, correct_, correct, true, [&] { return beside_correct(); });
    add(rows, incorrect_, options_.matches - correct, false, [&] { return paired_anew(); });
    shuffle(rows);
    return rows;
  }

 private:
  /// So many rows: each of the real ones once, in random order, then made ones.
  void add(std::vector<DrawnRow>& rows, Indices real, int count, bool is_correct,
           const std::function<DrawnRow()>& make) {
    shuffle(real);
    for (int i = 0; i < count; ++i) {
      const bool is_real = i < static_cast<int>(real.size());
      const int row = is_real ? real[static_cast<std::size_t>(i)] : 0;
      rows.push_back(accepted([&] { return is_real ? DrawnRow{row, row} : make(); }, is_correct));
    }
  }

  /// The first draw that is on its side of the threshold, noise included.
  DrawnRow accepted(const std::function<DrawnRow()>& make, bool is_correct) {
    for (int attempt = 0; attempt < kMostTries; ++attempt) {
      DrawnRow row = make();
      if (options_.noise_pr > 0)
        for (double& coordinate : row.target_shift)
          coordinate += options_.noise_pr * real_.resolution * stream_.normal();
      const Eigen::Vector3d source = (real_.source_points.row(row.source) + row.source_shift).transpose();
      const Eigen::Vector3d target = (real_.target_points.row(row.target) + row.target_shift).transpose();
      const double residual = (truth_.rotation * source + truth_.translation - target).norm();
      if ((residual <= options_.threshold_pr * real_.resolution) == is_correct) return row;
    }
    throw InvalidInput("challenge", "noise_pr", options_.noise_pr,
                       "a deviation that leaves correct matches within the threshold");
  }

  DrawnRow beside_correct() {
    const int row = any_of(correct_);
    const double length = kBeside_pr * real_.resolution * std::cbrt(stream_.uniform());  // uniform in the ball
    const Eigen::Vector3d shift = length * stream_.direction();
    return {row, row, shift.transpose(), (truth_.rotation * shift).transpose()};
  }

  DrawnRow paired_anew() { return {any_of(incorrect_), any_of(incorrect_)}; }

  int any_of(const Indices& rows) { return rows[static_cast<std::size_t>(stream_.below(rows.size()))]; }

  template <class List>
  void shuffle(List& list) {
    for (std::size_t i = list.size(); i > 1; --i)
      std::swap(list[i - 1], list[static_cast<std::size_t>(stream_.below(i))]);
  }

  const CorrespondenceSet& real_;
  const RigidTransform& truth_;
  const ChallengeOptions& options_;
  RandomStream stream_;
  Indices correct_, incorrect_;
};

}  // namespace

CorrespondenceSet draw_challenge(const CorrespondenceSet& real, const RigidTransform& target_from_source,
                                 const ChallengeOptions& options) {
  if (options.matches < 1) throw InvalidInput("challenge", "matches", options.matches, "at least 1");
  if (!(options.inlier_ratio >= 0 && options.inlier_ratio <= 100))
    throw InvalidInput("challenge", "inlier_ratio", options.inlier_ratio, "0 .. 100 %");
  if (!(options.noise_pr >= 0) || !std::isfinite(options.noise_pr))
    throw InvalidInput("challenge", "noise_pr", options.noise_pr, "a finite number of at least 0");
  const std::vector<DrawnRow> rows = Drawing(real, target_from_source, options).draw();
  Indices sources, targets;
  for (const DrawnRow& row : rows) sources.push_back(row.source), targets.push_back(row.target);
  CorrespondenceSet drawn = select_rows(real, sources);
  const CorrespondenceSet others = select_rows(real, targets);
  drawn.target_points = others.target_points;
  drawn.target_frames = others.target_frames;
  drawn.target_keypoints = others.target_keypoints;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    drawn.source_points.row(static_cast<Eigen::Index>(i)) += rows[i].source_shift;
    drawn.target_points.row(static_cast<Eigen::Index>(i)) += rows[i].target_shift;
  }
  return drawn;
}

}  // namespace corral
