// SPDX-License-Identifier: MIT
#include "kernel/surface/descriptor.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "kernel/error.h"
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

/// The support of every vertex that is asked for, through a grid.
class SupportFinder {
 public:
  SupportFinder(const Points& vertices, const Points& normals, double radius, bool rim)
      : grid_(PointGrid::for_radius(vertices, radius, kReach)),
        nx_(grid_.by_slot(normals.col(0))),
        ny_(grid_.by_slot(normals.col(1))),
        nz_(grid_.by_slot(normals.col(2))),
        squared_(  // finite: the padding of the grid is not near
            std::min(rim ? radius * radius : std::nextafter(radius * radius, 0), std::numeric_limits<double>::max())),
        slots_(static_cast<std::size_t>(grid_.size())) {
    for (int slot = 0; slot < grid_.size(); ++slot) slots_[static_cast<std::size_t>(grid_.row(slot))] = slot;
  }

  /// The order in which walking over the cells meets some vertices.
  std::vector<std::size_t> walk(const Indices& vertices) const {
    std::vector<std::size_t> order(vertices.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return std::make_pair(slot_of(vertices[a]), a) < std::make_pair(slot_of(vertices[b]), b);
    });
    return order;
  }

  /// Where a walk has come to.
  struct Place {
    CellSweep sweep;
    int end = 0;                    // of the slots of the cell
    std::vector<SlotRange> around;  // it
  };
  Place start() const { return {CellSweep(grid_, kReach), 0, {}}; }

  /// Vertices must come in the order of walk().
  void find(int vertex, Place& place, Support& support) const {
    const int slot = slot_of(vertex);
    if (slot >= place.end) move_to(grid_.cell_of(slot), place, support);
    collect(static_cast<std::size_t>(slot), place.around, support);
    measure(support);
  }

 private:
  static constexpr int kReach = 2;  // cells of half the radius waste fewer looks than cells of the radius

  int slot_of(int vertex) const { return slots_[static_cast<std::size_t>(vertex)]; }

  void move_to(int cell, Place& place, Support& support) const {
    place.end = grid_.end(cell);
    place.around.clear();
    place.sweep.around(cell, place.around);
    std::size_t most = kLanes;
    for (const SlotRange& range : place.around) most += static_cast<std::size_t>(range.end - range.begin);
    for (AlignedColumn* column :
         {&support.x, &support.y, &support.z, &support.distance, &support.nx, &support.ny, &support.nz})
      if (column->size() < most) column->resize(2 * most);
  }

  void collect(std::size_t slot, const std::vector<SlotRange>& ranges, Support& support) const {
    const SlotColumns columns{
        {grid_.x().data(), grid_.y().data(), grid_.z().data(), nx_.data(), ny_.data(), nz_.data()}};
    collect_support(columns, slot, squared_, ranges, support);
  }

  /// The distances, and nothing in the padding.
  static void measure(Support& support) {
    const auto count = static_cast<std::size_t>(support.count), end = static_cast<std::size_t>(padded(support.count));
    for (AlignedColumn* column :
         {&support.x, &support.y, &support.z, &support.distance, &support.nx, &support.ny, &support.nz})
      std::fill(column->begin() + static_cast<std::ptrdiff_t>(count),
                column->begin() + static_cast<std::ptrdiff_t>(end), 0.0);
    measure_support(support);
  }

  PointGrid grid_;
  AlignedColumn nx_, ny_, nz_;
  double squared_;
  std::vector<int> slots_;  // by vertex
};

enum class Outcome : char { Described, SmallSupport, NoFrame, NoHistogram };

}  // namespace

void ShotOptions::validate() const {
  require_positive("describe_shot", "radius_pr", radius_pr);
  if (minimum_support < 0)
    throw InvalidInput("describe_shot", "minimum_support", std::to_string(minimum_support), "at least 0");
  if (form != "additive" && form != "pcl" && form != "product")
    throw InvalidInput("describe_shot", "form", "'" + form + "'", "additive|pcl|product");
}

void Support::add(const Eigen::Vector3d& offset, const Eigen::Vector3d& normal) {
  const double length = std::sqrt(offset.x() * offset.x() + offset.y() * offset.y() + offset.z() * offset.z());
  if (!(length > 0)) return;
  const auto at = static_cast<std::size_t>(count++);
  const double values[] = {offset.x(), offset.y(), offset.z(), length, normal.x(), normal.y(), normal.z()};
  const double* value = values;
  for (AlignedColumn* column : {&x, &y, &z, &distance, &nx, &ny, &nz}) {
    column->resize(static_cast<std::size_t>(padded(count)), 0.0);
    (*column)[at] = *value++;
  }
}

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
  options.validate();
  if (normals.rows() != vertices.rows())
    throw InvalidInput("describe_shot", "number of normals", std::to_string(normals.rows()),
                       "one per vertex, " + std::to_string(vertices.rows()));
  for (const int vertex : keypoints)
    if (vertex < 0 || vertex >= vertices.rows())
      throw InvalidInput("describe_shot", "keypoint", std::to_string(vertex),
                         "vertices 0 .. " + std::to_string(vertices.rows() - 1));
  const double radius = options.radius_pr * resolution;
  const SupportFinder finder(vertices, normals, radius, options.form != "pcl");
  const auto order = finder.walk(keypoints);

  const auto count = static_cast<Eigen::Index>(keypoints.size());
  Descriptors descriptors;
  LocalReferenceFrames frames(keypoints.size());
  std::vector<Outcome> outcomes(keypoints.size());
  descriptors.features.resize(kShotSize, count);
  constexpr std::size_t kBlock = 64;
  parallel(static_cast<int>((order.size() + kBlock - 1) / kBlock), [&](int block) {
    auto place = finder.start();
    Support support;
    for (std::size_t at = static_cast<std::size_t>(block) * kBlock;
         at < std::min(order.size(), (static_cast<std::size_t>(block) + 1) * kBlock); ++at) {
      const std::size_t i = order[at];
      finder.find(keypoints[i], place, support);
      outcomes[i] = Outcome::SmallSupport;
      if (support.count < options.minimum_support) continue;
      outcomes[i] = Outcome::NoFrame;
      const auto frame = shot_frame(support, radius);
      if (!frame) continue;
      outcomes[i] = Outcome::NoHistogram;
      const auto histogram = shot_histogram(support, *frame, radius, options.form);
      if (!histogram) continue;
      outcomes[i] = Outcome::Described;
      frames[i] = *frame;
      std::copy_n(histogram->data(), kShotSize, descriptors.features.col(static_cast<Eigen::Index>(i)).data());
    }
  });

  Eigen::Index kept = 0;
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    descriptors.dropped_small_support += outcomes[i] == Outcome::SmallSupport;
    descriptors.dropped_no_frame += outcomes[i] == Outcome::NoFrame;
    descriptors.dropped_no_histogram += outcomes[i] == Outcome::NoHistogram;
    if (outcomes[i] != Outcome::Described) continue;
    descriptors.vertices.push_back(keypoints[i]);
    descriptors.frames.push_back(frames[i]);
    if (kept < static_cast<Eigen::Index>(i))
      descriptors.features.col(kept) = descriptors.features.col(static_cast<Eigen::Index>(i));
    ++kept;
  }
  descriptors.features.conservativeResize(Eigen::NoChange, kept);
  return descriptors;
}

}  // namespace corral
