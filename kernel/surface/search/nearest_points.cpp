// SPDX-License-Identifier: MIT
#include "kernel/surface/search/nearest_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kernel/spatial_order.h"
#include "kernel/surface/search/nearest_search.h"

namespace corral {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kShare = 4096;  // places that one thread takes at a time

}  // namespace

struct PointTree::Box {
  double low[3] = {kInfinity, kInfinity, kInfinity}, high[3] = {-kInfinity, -kInfinity, -kInfinity};
  int number = kNothing;  // of what it holds

  void add(int axis, double from, double to) {
    low[axis] = std::min(low[axis], from);
    high[axis] = std::max(high[axis], to);
  }
  double longest_side() const { return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]}); }
};

/// The points in their spatial order make the leaves, eight by eight; these make nodes, and so on.
PointTree::PointTree(const Points& points, const ParallelFor& parallel) {
  Indices order = spatial_order(points, parallel);
  while (!order.empty() && !points.row(order.back()).allFinite()) order.pop_back();
  leaves_.resize((order.size() + kLanes - 1) / kLanes);
  std::vector<Box> boxes(leaves_.size());
  for (std::size_t index = 0; index < leaves_.size(); ++index) {
    Leaf& leaf = leaves_[index];
    boxes[index].number = leaf_number(index);
    for (std::size_t i = 0; i < kLanes; ++i) {
      const std::size_t at = kLanes * index + i;
      const bool is_there = at < order.size();
      leaf.row[i] = is_there ? order[at] : kInfinity;
      for (int axis = 0; axis < 3; ++axis) {
        leaf.place[axis][i] = is_there ? points(order[at], axis) : kInfinity;
        if (is_there) boxes[index].add(axis, leaf.place[axis][i], leaf.place[axis][i]);
      }
    }
  }
  for (const Box& box : boxes) spacing_ += box.longest_side() / (std::sqrt(kLanes) * static_cast<double>(boxes.size()));
  while (boxes.size() > 1) boxes = gather(boxes);
  if (!boxes.empty()) root_ = boxes.front().number;
}

/// Makes nodes of eight boxes each.
std::vector<PointTree::Box> PointTree::gather(const std::vector<Box>& boxes) {
  std::vector<Box> larger;
  for (std::size_t first = 0; first < boxes.size(); first += kLanes) {
    Node node;
    Box whole;
    whole.number = static_cast<int>(nodes_.size());
    for (std::size_t i = 0; i < kLanes; ++i) {
      const bool is_there = first + i < boxes.size();
      node.child[i] = is_there ? boxes[first + i].number : kNothing;
      for (int axis = 0; axis < 3; ++axis) {
        node.low[axis][i] = is_there ? boxes[first + i].low[axis] : kInfinity;
        node.high[axis][i] = is_there ? boxes[first + i].high[axis] : kInfinity;
        if (is_there) whole.add(axis, node.low[axis][i], node.high[axis][i]);
      }
    }
    nodes_.push_back(node);
    larger.push_back(whole);
  }
  return larger;
}

NearestTracker::NearestTracker(const PointTree& tree, ParallelFor parallel)
    : tree_(tree), parallel_(std::move(parallel)) {}
NearestTracker::~NearestTracker() = default;

FollowedPoints& NearestTracker::follow(Eigen::Index count) {
  const auto size = static_cast<std::size_t>(padded(static_cast<int>(count)));
  return followed_.try_emplace(count, size).first->second;
}

const PointPairs& NearestTracker::pair(const Points& queries, double limit) {
  FollowedPoints& followed = follow(queries.rows());
  for (int axis = 0; axis < 3; ++axis)
    std::copy_n(queries.col(axis).data(), queries.rows(), followed.source[axis].data());
  const std::size_t size = followed.target_rows.size();
  parallel_(static_cast<int>((size + kShare - 1) / kShare), [&](int share) {
    const std::size_t first = static_cast<std::size_t>(share) * kShare;
    search_partners(tree_, followed, first, std::min(size, first + kShare), limit);
  });
  return followed;
}

const Indices& NearestTracker::nearest(const Points& queries, double limit) {
  FollowedPoints& followed = follow(queries.rows());
  if (followed.order.empty()) followed.order = spatial_order(queries, parallel_);
  const PointPairs& pairs = pair(queries(followed.order, Eigen::all), limit);
  followed.nearest.resize(followed.order.size());
  for (std::size_t i = 0; i < followed.order.size(); ++i)
    followed.nearest[static_cast<std::size_t>(followed.order[i])] = pairs.target_rows[i];
  return followed.nearest;
}

}  // namespace corral
