// SPDX-License-Identifier: MIT
#include "grouping/hough_voting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "grouping/columns/column_loops.h"
#include "kernel/bounding_box.h"
#include "kernel/columns.h"

namespace corral {
namespace {

constexpr double kCubePr = 5;

/// Votes by column. The columns are padded with copies of the first vote, so that lanes find nothing else in them.
struct Votes {
  Indices rows;
  AlignedColumn at[3];

  std::size_t size() const { return rows.size(); }
  Eigen::Array3d position(std::size_t i) const { return {at[0][i], at[1][i], at[2][i]}; }
};

/// Three whole numbers held as doubles: votes may lie anywhere a double can.
using Cell = std::array<double, 3>;

constexpr std::uint64_t kOddMultiplier = 0x9e3779b97f4a7c15u;

std::uint64_t hash(std::uint64_t cell) { return cell * kOddMultiplier; }
std::uint64_t hash(const Cell& cell) {
  std::uint64_t word = 0;
  for (const double number : cell) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &number, sizeof(bits));
    word = (word ^ bits) * kOddMultiplier;
    word ^= word >> 32;
  }
  return word * kOddMultiplier;
}

/// Sums of weights by cell: a hash table whose memory depends on the number of cells used, not on their extent.
template <class Key>
class Accumulator {
 public:
  explicit Accumulator(std::size_t most_cells) {
    while ((std::size_t{1} << bits_) < 2 * most_cells) ++bits_;
    slots_.resize(std::size_t{1} << bits_, {Key{}, 0});
  }

  void add(const Key& cell, double weight) {
    std::size_t at = static_cast<std::size_t>(hash(cell) >> (64 - bits_));
    while (slots_[at].weight > 0 && slots_[at].cell != cell) at = (at + 1) & (slots_.size() - 1);
    Slot& slot = slots_[at];
    slot.cell = cell;
    slot.weight += weight;
    if (slot.weight > fullest_.weight || (slot.weight == fullest_.weight && cell < fullest_.cell)) fullest_ = slot;
  }

  /// The cell with the largest sum; the first in order among equals.
  const Key& fullest() const { return fullest_.cell; }

 private:
  struct Slot {
    Key cell;
    double weight;  ///< 0: free
  };

  int bits_ = 1;
  std::vector<Slot> slots_;
  Slot fullest_{Key{}, 0};  ///< sums only grow, so that the largest is known at any time
};

Votes cast_votes(const CorrespondenceSet& matches) {
  const Eigen::Vector3d centroid = matches.source_centroid_or_mean();
  Votes votes;
  votes.rows.reserve(static_cast<std::size_t>(matches.size()));
  for (AlignedColumn& column : votes.at) column.resize(static_cast<std::size_t>(padded(matches.size())));
  for (int row = 0; row < matches.size(); ++row) {
    const LocalReferenceFrame& source = matches.source_frames[static_cast<std::size_t>(row)];
    const LocalReferenceFrame& target = matches.target_frames[static_cast<std::size_t>(row)];
    if (!is_valid_frame(source) || !is_valid_frame(target)) continue;
    const Eigen::Vector3d local = source * (centroid - matches.source_points.row(row).transpose());        // v_i
    const Eigen::Vector3d vote = target.transpose() * local + matches.target_points.row(row).transpose();  // g_i
    for (int axis = 0; axis < 3; ++axis) votes.at[axis][votes.size()] = vote(axis);
    votes.rows.push_back(row);
  }
  for (AlignedColumn& column : votes.at) {
    column.resize(votes.size());
    column.resize(static_cast<std::size_t>(padded(static_cast<int>(votes.size()))), votes.size() > 0 ? column[0] : 0);
  }
  return votes;
}

struct Box {
  Eigen::Array3d low, high;
};

Box box_of(const Votes& votes) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    const Extent extent = extent_of(votes.at[axis].data(), static_cast<Eigen::Index>(votes.at[axis].size()));
    box.low(axis) = extent.low, box.high(axis) = extent.high;
  }
  return box;
}

/// Extent below which an axis of the box holds nothing but rounding: it is not divided.
double rounding_extent(const Box& box, double resolution) {
  const double largest = std::max(box.low.abs().maxCoeff(), box.high.abs().maxCoeff());
  return std::max(1e-6 * resolution, 64 * std::numeric_limits<double>::epsilon() * largest);
}

/// The place of each vote among the cells of one axis.
using Places = std::vector<std::int32_t>;

std::array<Places, 3> places_in_box(const Votes& votes, const Box& box, int bins, double resolution) {
  const double indivisible = rounding_extent(box, resolution);
  std::array<Places, 3> places;
  for (int axis = 0; axis < 3; ++axis) {
    const AlignedColumn& column = votes.at[axis];
    Places& place = places[static_cast<std::size_t>(axis)];
    place.assign(column.size(), 0);
    const double extent = box.high(axis) - box.low(axis);
    if (extent > indivisible)
      find_cells(column.data(), column.size(), {box.low(axis), extent / bins, bins - 1.0}, place.data());
  }
  return places;
}

/// Each vote counts in one cell of the box; the fullest and its 6 face neighbours win.
Indices select_in_box(const Votes& votes, int bins, double resolution) {
  const auto [x, y, z] = places_in_box(votes, box_of(votes), bins, resolution);
  const auto count = static_cast<std::uint64_t>(bins);
  Accumulator<std::uint64_t> accumulator(std::min<std::size_t>(votes.size(), count * count * count));
  for (std::size_t i = 0; i < votes.size(); ++i)  // they compare as x, then y, then z do
    accumulator.add((static_cast<std::uint64_t>(x[i]) * count + static_cast<std::uint64_t>(y[i])) * count +
                        static_cast<std::uint64_t>(z[i]),
                    1);
  const std::uint64_t peak = accumulator.fullest();
  const auto peak_x = static_cast<int>(peak / count / count), peak_y = static_cast<int>(peak / count % count),
             peak_z = static_cast<int>(peak % count);
  Indices rows(votes.size());
  std::size_t winners = 0;
  for (std::size_t i = 0; i < votes.size(); ++i) {
    rows[winners] = votes.rows[i];
    winners += std::abs(x[i] - peak_x) + std::abs(y[i] - peak_y) + std::abs(z[i] - peak_z) <= 1;
  }
  rows.resize(winners);
  return rows;
}

/// The cell and the weight of each of the 8 cubes that share a vote.
template <class Visit>
void visit_shares(const Eigen::Array3d& vote, const Eigen::Array3d& low, double side, Visit visit) {
  const Eigen::Array3d scaled = (vote - low) / side - 0.5;  // whole numbers at the centres of cells
  const Eigen::Array3d base = scaled.floor();
  const Eigen::Array3d part = scaled - base;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Array3d step(corner & 1, (corner >> 1) & 1, corner >> 2);
    const double weight = (step * part + (1 - step) * (1 - part)).prod();
    const Eigen::Array3d at = base + step + 0.0;  // + 0: no negative zero
    if (weight > 0) visit(Cell{at(0), at(1), at(2)}, weight);
  }
}

/// Each vote is shared among 8 cubes; those with a share in the fullest win.
Indices select_in_cubes(const Votes& votes, double side) {
  const Eigen::Array3d low = box_of(votes).low;
  Accumulator<Cell> accumulator(8 * votes.size());
  for (std::size_t i = 0; i < votes.size(); ++i)
    visit_shares(votes.position(i), low, side, [&](const Cell& cell, double weight) { accumulator.add(cell, weight); });
  const Cell peak = accumulator.fullest();
  Indices rows;
  for (std::size_t i = 0; i < votes.size(); ++i) {
    bool has_share = false;
    visit_shares(votes.position(i), low, side,
                 [&](const Cell& cell, double) { has_share = has_share || cell == peak; });
    if (has_share) rows.push_back(votes.rows[i]);
  }
  return rows;
}

}  // namespace

GroupingResult group_by_hough_voting(const CorrespondenceSet& matches, const HoughVotingOptions& options) {
  validate_options(options, "hough");
  require_columns(matches, "hough", {Column::SourceFrames, Column::TargetFrames});
  const Votes votes = cast_votes(matches);
  GroupingResult result;
  if (votes.size() == 0) return result;
  result.selected = options.cells == HoughCells::Box ? select_in_box(votes, options.bins, matches.resolution)
                                                     : select_in_cubes(votes, kCubePr * matches.resolution);
  return result;
}

double working_memory(int matches, const HoughVotingOptions& options) {
  // The votes, their cells and the selection as it grows; a table of less than 4 slots for each share of a vote.
  const double table = options.cells == HoughCells::Box ? 4 * 16.0 : 8 * 4 * 32.0;
  return matches * (28.0 + 12.0 + 12.0 + table) + 1024;
}

}  // namespace corral
