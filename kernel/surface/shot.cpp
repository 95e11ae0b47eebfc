// SPDX-License-Identifier: MIT
#include "kernel/surface/shot.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "kernel/error.h"
#include "kernel/surface/keep_described.h"
#include "kernel/surface/support_loops.h"

namespace corral {
namespace {

constexpr int kSmallestFrame = 5;

/// Turns an axis, of which so many of the support lie ahead, to the side where most of it lies.
Eigen::Vector3d towards_majority(const Eigen::Vector3d& axis, int ahead, const Support& support) {
  if (2 * ahead != support.count) return 2 * ahead < support.count ? Eigen::Vector3d(-axis) : axis;

  Indices order(static_cast<std::size_t>(support.count));
  std::iota(order.begin(), order.end(), 0);
  const auto is_nearer = [&](int a, int b) {
    const double of_a = support.distance[static_cast<std::size_t>(a)],
                 of_b = support.distance[static_cast<std::size_t>(b)];
    return of_a < of_b || (of_a == of_b && a < b);
  };
  const auto first = order.begin() + std::clamp(support.count / 2, 2, support.count - 3) - 2;
  std::nth_element(order.begin(), first, order.end(), is_nearer);
  std::nth_element(first, first + 4, order.end(), is_nearer);
  const auto is_ahead = [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    return support.x[at] * axis.x() + support.y[at] * axis.y() + support.z[at] * axis.z() > 0;
  };
  const auto positive = std::count_if(first, first + 5, is_ahead);
  return positive < 3 ? Eigen::Vector3d(-axis) : axis;
}

}  // namespace

std::optional<LocalReferenceFrame> shot_frame(const Support& support, double radius) {
  if (support.count < kSmallestFrame) return std::nullopt;
  const WeightedMoments sums = sum_moments(support, radius);
  Eigen::Matrix3d moments;
  moments << sums.xx, sums.xy, sums.xz, sums.xy, sums.yy, sums.yz, sums.xz, sums.yz, sums.zz;
  moments /= sums.weights;
  if (!moments.allFinite()) return std::nullopt;                         // every vertex exactly at the rim
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments);  // ascending eigenvalues
  const std::array<Eigen::Vector3d, 2> axes{solver.eigenvectors().col(2), solver.eigenvectors().col(0)};
  const auto ahead = count_ahead(axes, support);
  const Eigen::Vector3d x = towards_majority(axes[0], ahead[0], support);
  const Eigen::Vector3d z = towards_majority(axes[1], ahead[1], support);
  LocalReferenceFrame frame;
  frame.row(0) = x;
  frame.row(1) = z.cross(x);
  frame.row(2) = z;
  return frame;
}

Descriptors describe_shot(const Points& vertices, const Points& normals, const Indices& keypoints, double resolution,
                          const ShotOptions& options, const ParallelFor& parallel) {
  require_positive("describe_shot", "resolution", resolution);
  validate_options(options, "describe_shot");
  require_keypoints("describe_shot", vertices, normals, keypoints);
  const double radius = options.radius_pr * resolution;
  const SupportFinder finder(vertices, normals, radius, options.form == ShotForm::PclBug ? Rim::Outside : Rim::Inside);
  Descriptors descriptors;
  descriptors.frames.resize(keypoints.size());
  descriptors.features.resize(kShotSize, static_cast<Eigen::Index>(keypoints.size()));
  std::vector<KeypointOutcome> outcomes(keypoints.size());
  const auto describe = [&](std::size_t i, const Support& support, ShotBins& bins) {
    outcomes[i] = KeypointOutcome::SmallSupport;
    if (support.count < options.minimum_support) return;
    outcomes[i] = KeypointOutcome::NoFrame;
    const auto frame = shot_frame(support, radius);
    if (!frame) return;
    outcomes[i] = KeypointOutcome::NoHistogram;
    const auto histogram = shot_histogram(support, *frame, radius, options.form, bins);
    if (!histogram) return;
    outcomes[i] = KeypointOutcome::Described;
    descriptors.frames[i] = *frame;
    std::copy_n(histogram->data(), kShotSize, descriptors.features.col(static_cast<Eigen::Index>(i)).data());
  };
  visit_supports(finder, keypoints, parallel, [&describe] {
    return
        [&describe, bins = ShotBins()](std::size_t i, const Support& support) mutable { describe(i, support, bins); };
  });
  keep_described(keypoints, outcomes, descriptors);
  return descriptors;
}

void add_shot_frames(const Points& vertices, double resolution, const ShotOptions& options, Descriptors& descriptors,
                     const ParallelFor& parallel) {
  require_positive("add_shot_frames", "resolution", resolution);
  validate_options(options, "add_shot_frames");
  const Indices keypoints = std::move(descriptors.vertices);
  const Points no_normals = Points::Zero(vertices.rows(), 3);
  require_keypoints("add_shot_frames", vertices, no_normals, keypoints);
  const double radius = options.radius_pr * resolution;
  const SupportFinder finder(vertices, no_normals, radius,
                             options.form == ShotForm::PclBug ? Rim::Outside : Rim::Inside);
  descriptors.vertices.clear();
  descriptors.frames.resize(keypoints.size());
  std::vector<KeypointOutcome> outcomes(keypoints.size(), KeypointOutcome::NoFrame);
  const auto add_frame = [&](std::size_t i, const Support& support) {
    if (const auto frame = shot_frame(support, radius)) {
      descriptors.frames[i] = *frame;
      outcomes[i] = KeypointOutcome::Described;
    }
  };
  visit_supports(finder, keypoints, parallel, [&add_frame] { return add_frame; });
  keep_described(keypoints, outcomes, descriptors);
}

}  // namespace corral
