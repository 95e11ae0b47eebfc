// SPDX-License-Identifier: MIT
#include "grouping/hough_voting.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace corral {
namespace {

constexpr double kCubePr = 5;

struct Vote {
  int row;
  Eigen::Vector3d position;
};

/// The cell of a vote. Whole numbers held as doubles: votes may lie anywhere a double can.
using Cell = Eigen::Vector3d;

bool before(const Cell& a, const Cell& b) { return std::tie(a.x(), a.y(), a.z()) < std::tie(b.x(), b.y(), b.z()); }

/// The share of one vote in one cell.
struct Share {
  Cell cell;
  int row;
  double weight;
};

std::vector<Vote> cast_votes(const CorrespondenceSet& matches) {
  const Eigen::Vector3d centroid = matches.source_centroid_or_mean();
  std::vector<Vote> votes;
  for (int row = 0; row < matches.size(); ++row) {
    const LocalReferenceFrame& source = matches.source_frames[static_cast<std::size_t>(row)];
    const LocalReferenceFrame& target = matches.target_frames[static_cast<std::size_t>(row)];
    if (!is_valid_frame(source) || !is_valid_frame(target)) continue;
    const Eigen::Vector3d local = source * (centroid - matches.source_points.row(row).transpose());   // v_i
    votes.push_back({row, target.transpose() * local + matches.target_points.row(row).transpose()});  // g_i
  }
  return votes;
}

/// The cell with the largest sum of weights; the first in order among equals. `shares` must not be empty; sorts it.
Cell fullest_cell(std::vector<Share>& shares) {
  std::sort(shares.begin(), shares.end(), [](const Share& a, const Share& b) {
    return before(a.cell, b.cell) || (!before(b.cell, a.cell) && a.row < b.row);
  });
  Cell best = shares.front().cell;
  double best_weight = -1;
  for (auto first = shares.begin(); first != shares.end();) {
    double weight = 0;
    auto last = first;
    for (; last != shares.end() && last->cell == first->cell; ++last) weight += last->weight;
    if (weight > best_weight) best = first->cell, best_weight = weight;
    first = last;
  }
  return best;
}

/// Rows with a share in a cell that passes, ascending.
template <class Passes>
Indices rows_in(const std::vector<Share>& shares, Passes passes) {
  Indices rows;
  for (const Share& share : shares)
    if (passes(share.cell)) rows.push_back(share.row);
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

struct Box {
  Eigen::Array3d low, high;
};

Box bounding_box(const std::vector<Vote>& votes) {
  Box box{votes.front().position, votes.front().position};
  for (const Vote& vote : votes) {
    box.low = box.low.min(vote.position.array());
    box.high = box.high.max(vote.position.array());
  }
  return box;
}

/// Extent below which an axis of the box holds nothing but rounding: it is not divided.
double rounding_extent(const Box& box, double resolution) {
  const double largest = std::max(box.low.abs().maxCoeff(), box.high.abs().maxCoeff());
  return std::max(1e-6 * resolution, 64 * std::numeric_limits<double>::epsilon() * largest);
}

Indices select_in_box(const std::vector<Vote>& votes, int bins, double resolution) {
  const Box box = bounding_box(votes);
  const Eigen::Array3d low = box.low, extent = box.high - box.low, width = extent / bins;
  const double indivisible = rounding_extent(box, resolution);
  std::vector<Share> shares;
  for (const Vote& vote : votes) {
    Cell cell = Cell::Zero();
    for (int axis = 0; axis < 3; ++axis)
      if (extent(axis) > indivisible)
        cell(axis) = std::min(std::floor((vote.position(axis) - low(axis)) / width(axis)), bins - 1.0);
    shares.push_back({cell, vote.row, 1});
  }
  const Cell peak = fullest_cell(shares);
  return rows_in(shares, [&](const Cell& cell) { return (cell - peak).lpNorm<1>() <= 1; });  // itself and 6 faces
}

Indices select_in_cubes(const std::vector<Vote>& votes, double side) {
  const Eigen::Array3d low = bounding_box(votes).low;
  std::vector<Share> shares;
  for (const Vote& vote : votes) {
    const Eigen::Array3d scaled = (vote.position.array() - low) / side - 0.5;  // whole numbers at the centres of cells
    const Eigen::Array3d base = scaled.floor();
    const Eigen::Array3d part = scaled - base;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Array3d step(corner & 1, (corner >> 1) & 1, corner >> 2);
      const double weight = (step * part + (1 - step) * (1 - part)).prod();
      if (weight > 0) shares.push_back({(base + step).matrix(), vote.row, weight});
    }
  }
  const Cell peak = fullest_cell(shares);
  return rows_in(shares, [&](const Cell& cell) { return cell == peak; });
}

}  // namespace

GroupingResult group_by_hough_voting(const CorrespondenceSet& matches, const HoughVotingOptions& options) {
  validate_options(options, "hough");
  require_columns(matches, "hough", {Column::SourceFrames, Column::TargetFrames});
  const std::vector<Vote> votes = cast_votes(matches);
  GroupingResult result;
  if (votes.empty()) return result;
  result.selected = options.cells == HoughCells::Box ? select_in_box(votes, options.bins, matches.resolution)
                                                     : select_in_cubes(votes, kCubePr * matches.resolution);
  return result;
}

}  // namespace corral
