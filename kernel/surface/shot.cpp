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

/// How many of the support lie ahead on each of two axes, or beside.
std::array<int, 2> count_ahead(const std::array<Eigen::Vector3d, 2>& axes, const Support& support) {
  std::array<int, 2> ahead;
  vectorized([&](auto kind) {
    using Lanes = typename decltype(kind)::Lanes;
    const Lanes zero = Lanes::fill(0), one = Lanes::fill(1);
    Lanes count[2] = {zero, zero}, axis[2][3];
    for (std::size_t which : {0, 1})
      for (int i = 0; i < 3; ++i) axis[which][i] = Lanes::fill(axes[which](i));
    for (std::size_t i = 0; i < static_cast<std::size_t>(support.count); i += kLanes) {
      const Lanes x = Lanes::load(&support.x[i]), y = Lanes::load(&support.y[i]), z = Lanes::load(&support.z[i]);
      for (std::size_t which : {0, 1}) {
        const Lanes along = x * axis[which][0] + y * axis[which][1] + z * axis[which][2];
        count[which] = select(zero <= along, count[which] + one, count[which]);
      }
    }
    const int padding = padded(support.count) - support.count;  // lies at the point: ahead
    for (std::size_t which : {0, 1}) ahead[which] = static_cast<int>(sum(count[which])) - padding;
  });
  return ahead;
}

}  // namespace

std::optional<LocalReferenceFrame> shot_frame(const Support& support, double radius) {
  if (support.count < kSmallestFrame) return std::nullopt;
  Eigen::Matrix3d moments;
  double weights = 0;
  vectorized([&](auto kind) {
    using Lanes = typename decltype(kind)::Lanes;
    const Lanes limit = Lanes::fill(radius), zero = Lanes::fill(0);
    Lanes w = zero, xx = zero, xy = zero, xz = zero, yy = zero, yz = zero, zz = zero;
    for (std::size_t i = 0; i < static_cast<std::size_t>(support.count); i += kLanes) {
      const Lanes x = Lanes::load(&support.x[i]), y = Lanes::load(&support.y[i]), z = Lanes::load(&support.z[i]),
                  distance = Lanes::load(&support.distance[i]);
      const Lanes weight = select(zero < distance, limit - distance, zero);
      const Lanes wx = weight * x, wy = weight * y, wz = weight * z;
      w = w + weight;
      xx = xx + wx * x, xy = xy + wx * y, xz = xz + wx * z, yy = yy + wy * y, yz = yz + wy * z, zz = zz + wz * z;
    }
    weights = sum(w);
    const double m01 = sum(xy), m02 = sum(xz), m12 = sum(yz);
    moments << sum(xx), m01, m02, m01, sum(yy), m12, m02, m12, sum(zz);
  });
  moments /= weights;
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
  std::vector<Outcome> outcomes(keypoints.size());
  visit_supports(finder, keypoints, parallel, [&](std::size_t i, const Support& support) {
    outcomes[i] = Outcome::SmallSupport;
    if (support.count < options.minimum_support) return;
    outcomes[i] = Outcome::NoFrame;
    const auto frame = shot_frame(support, radius);
    if (!frame) return;
    outcomes[i] = Outcome::NoHistogram;
    const auto histogram = shot_histogram(support, *frame, radius, options.form);
    if (!histogram) return;
    outcomes[i] = Outcome::Described;
    descriptors.frames[i] = *frame;
    std::copy_n(histogram->data(), kShotSize, descriptors.features.col(static_cast<Eigen::Index>(i)).data());
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
  std::vector<Outcome> outcomes(keypoints.size(), Outcome::NoFrame);
  visit_supports(finder, keypoints, parallel, [&](std::size_t i, const Support& support) {
    if (const auto frame = shot_frame(support, radius)) {
      descriptors.frames[i] = *frame;
      outcomes[i] = Outcome::Described;
    }
  });
  keep_described(keypoints, outcomes, descriptors);
}

}  // namespace corral
