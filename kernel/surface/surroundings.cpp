// SPDX-License-Identifier: MIT
#include "kernel/surface/surroundings.h"

#include <algorithm>

namespace corral {
namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

}  // namespace

Surroundings::Surroundings(const Mesh& mesh, const std::vector<Indices>& rings, const Reach& reach)
    : rings_(rings), reach_(reach), rank_(rings.size()), depth_(rings.size(), -1), path_(rings.size(), 0.0) {
  if (reach.ball_radius > 0) index_ = std::make_unique<PointIndex>(mesh.vertices);
  for (const int vertex : rows_by_place(mesh.vertices)) {
    rank_[at(vertex)] = static_cast<int>(sorted_.size());
    sorted_.emplace_back(mesh.vertices.row(vertex).transpose());
  }
}

const Eigen::Vector3d& Surroundings::place(int vertex) const { return sorted_[at(rank_[at(vertex)])]; }

/// Appends the vertices that follow the ring which starts at `first`; returns the longest path to one of them.
double Surroundings::add_ring(std::size_t first, int depth) {
  const std::size_t end = found_.size();
  for (std::size_t i = first; i < end; ++i) {
    const int here = found_[i];
    for (const int next : rings_[at(here)]) {
      const bool is_new = depth_[at(next)] < 0;
      if (!is_new && depth_[at(next)] != depth) continue;
      const double path = path_[at(here)] + (place(next) - place(here)).norm();
      path_[at(next)] = is_new ? path : std::min(path, path_[at(next)]);
      depth_[at(next)] = depth;
      if (is_new) found_.push_back(next);
    }
  }
  double longest = 0;
  for (std::size_t i = end; i < found_.size(); ++i) longest = std::max(longest, path_[at(found_[i])]);
  return longest;
}

void Surroundings::collect(int vertex) {
  found_.clear();
  if (index_) {
    for (const Neighbor& neighbor : index_->within(place(vertex), reach_.ball_radius)) found_.push_back(neighbor.index);
    return;
  }
  found_.push_back(vertex);
  depth_[at(vertex)] = 0;
  path_[at(vertex)] = 0;
  std::size_t first = 0;
  for (int depth = 1; depth <= reach_.most_rings && first < found_.size(); ++depth) {
    const std::size_t end = found_.size();
    if (add_ring(first, depth) > reach_.longest_path) break;
    first = end;
  }
  for (const int reached : found_) depth_[at(reached)] = -1;
}

std::vector<Eigen::Vector3d>& Surroundings::around(int vertex) {
  collect(vertex);
  for (int& found : found_) found = rank_[at(found)];
  std::sort(found_.begin(), found_.end());
  offsets_.clear();
  for (const int rank : found_) offsets_.emplace_back(sorted_[at(rank)] - place(vertex));
  return offsets_;
}

}  // namespace corral
