// SPDX-License-Identifier: MIT
#include "kernel/evaluation.h"

#include <algorithm>
#include <cmath>

#include "kernel/error.h"

namespace corral {
namespace {

std::optional<double> ratio(double numerator, int denominator) {
  if (denominator == 0) return std::nullopt;
  return numerator / denominator;
}

}  // namespace

std::vector<bool> label_correct(const CorrespondenceSet& matches, const RigidTransform& target_from_source,
                                double threshold_pr) {
  matches.validate();
  if (!(threshold_pr >= 0) || !std::isfinite(threshold_pr))
    throw InvalidInput("label_correct", "threshold_pr", threshold_pr, "a finite length of at least 0");
  const double threshold = threshold_pr * matches.resolution;
  const Points moved = target_from_source.apply(matches.source_points);
  std::vector<bool> labels(static_cast<std::size_t>(matches.size()));
  for (int row = 0; row < matches.size(); ++row)
    labels[static_cast<std::size_t>(row)] = (moved.row(row) - matches.target_points.row(row)).norm() <= threshold;
  return labels;
}

GroupingScore score_grouping(const std::vector<bool>& labels, const Indices& selected) {
  GroupingScore score;
  score.matches = static_cast<int>(labels.size());
  score.selected = static_cast<int>(selected.size());
  score.true_matches = static_cast<int>(std::count(labels.begin(), labels.end(), true));
  int previous = -1;
  for (const int row : selected) {
    if (row <= previous || row >= score.matches)
      throw InvalidInput("score_grouping", "selected row", std::to_string(row),
                         "strictly ascending rows below " + std::to_string(score.matches));
    score.correct += labels[static_cast<std::size_t>(row)];
    previous = row;
  }
  score.precision = ratio(score.correct, score.selected);
  score.recall = ratio(score.correct, score.true_matches);
  if (score.true_matches > 0) score.f1 = ratio(2.0 * score.correct, score.selected + score.true_matches);
  return score;
}

std::optional<double> FrameRepeatability::share() const { return ratio(agreeing, compared); }

FrameRepeatability frame_repeatability(const CorrespondenceSet& matches, const RigidTransform& target_from_source,
                                       const std::vector<bool>& labels, double limit_deg) {
  FrameRepeatability found;
  if (matches.source_frames.empty() || matches.target_frames.empty()) return found;
  for (std::size_t row = 0; row < labels.size(); ++row) {
    const LocalReferenceFrame &source = matches.source_frames[row], &target = matches.target_frames[row];
    if (!labels[row] || !is_valid_frame(source) || !is_valid_frame(target)) continue;
    ++found.compared;
    const RigidTransform between{target.transpose() * source, Eigen::Vector3d::Zero()};
    found.agreeing += rotation_error_deg(between, target_from_source) <= limit_deg;
  }
  return found;
}

double rotation_error_deg(const RigidTransform& estimate, const RigidTransform& truth) {
  const Eigen::Matrix3d difference = estimate.rotation * truth.rotation.transpose();
  const Eigen::Vector3d twice_sine_axis(difference(2, 1) - difference(1, 2), difference(0, 2) - difference(2, 0),
                                        difference(1, 0) - difference(0, 1));
  return std::atan2(twice_sine_axis.norm(), difference.trace() - 1.0) * (180.0 / 3.141592653589793);
}

double translation_error_pr(const RigidTransform& estimate, const RigidTransform& truth, double resolution) {
  return (estimate.translation - truth.translation).norm() / resolution;
}

std::optional<PointError> point_error(const RigidTransform& estimate, const RigidTransform& truth, const Points& points,
                                      double resolution) {
  if (points.rows() == 0) return std::nullopt;
  const Eigen::VectorXd distances = (estimate.apply(points) - truth.apply(points)).rowwise().norm() / resolution;
  const double count = static_cast<double>(distances.size());
  return PointError{std::sqrt(distances.squaredNorm() / count), distances.sum() / count, distances.maxCoeff()};
}

const std::vector<double>& success_thresholds_pr() {
  static const std::vector<double> thresholds{0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0};
  return thresholds;
}

std::vector<double> success_curve(const std::vector<std::optional<double>>& errors_pr,
                                  const std::vector<double>& thresholds_pr) {
  if (errors_pr.empty()) throw InvalidInput("success_curve", "errors_pr", "0 pairs", "at least 1");
  std::vector<double> shares;
  for (const double threshold : thresholds_pr) {
    const auto registered = std::count_if(errors_pr.begin(), errors_pr.end(),
                                          [&](const auto& error) { return error && *error <= threshold; });
    shares.push_back(static_cast<double>(registered) / static_cast<double>(errors_pr.size()));
  }
  return shares;
}

double success_area(const std::vector<std::optional<double>>& errors_pr) {
  std::vector<double> thresholds{0};
  thresholds.insert(thresholds.end(), success_thresholds_pr().begin(), success_thresholds_pr().end());
  const std::vector<double> shares = success_curve(errors_pr, thresholds);
  double area = 0;
  for (std::size_t i = 1; i < shares.size(); ++i)
    area += (thresholds[i] - thresholds[i - 1]) * (shares[i - 1] + shares[i]) / 2;
  return area / thresholds.back();
}

}  // namespace corral
