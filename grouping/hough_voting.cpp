// SPDX-License-Identifier: MIT
#include "grouping/hough_voting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace corral {
namespace {

constexpr double kCubePr = 5;

struct Vote {
  int row;
  Eigen::Vector3d position;
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
    slots_[at].cell = cell;
    slots_[at].weight += weight;
  }

  /// The cell with the largest sum; the first in order among equals.
  Key fullest() const {
    const Slot* best = &slots_.front();
    for (const Slot& slot : slots_)
      if (slot.weight > best->weight || (slot.weight == best->weight && slot.weight > 0 && slot.cell < best->cell))
        best = &slot;
    return best->cell;
  }

 private:
  struct Slot {
    Key cell;
    double weight;  ///< 0: free
  };

  int bits_ = 1;
  std::vector<Slot> slots_;
};

std::vector<Vote> cast_votes(const CorrespondenceSet& matches) {
  const Eigen::Vector3d centroid = matches.source_centroid_or_mean();
  std::vector<Vote> votes;
  votes.reserve(static_cast<std::size_t>(matches.size()));
  for (int row = 0; row < matches.size(); ++row) {
    const LocalReferenceFrame& source = matches.source_frames[static_cast<std::size_t>(row)];
    const LocalReferenceFrame& target = matches.target_frames[static_cast<std::size_t>(row)];
    if (!is_valid_frame(source) || !is_valid_frame(target)) continue;
    const Eigen::Vector3d local = source * (centroid - matches.source_points.row(row).transpose());   // v_i
    votes.push_back({row, target.transpose() * local + matches.target_points.row(row).transpose()});  // g_i
  }
  return votes;
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

/// Each vote counts in one cell of the box; the fullest and its 6 face neighbours win.
Indices select_in_box(const std::vector<Vote>& votes, int bins, double resolution) {
  const Box box = bounding_box(votes);
  const Eigen::Array3d low = box.low, extent = box.high - box.low, width = extent / bins;
  const double indivisible = rounding_extent(box, resolution);
  const auto count = static_cast<std::uint64_t>(bins);
  Accumulator<std::uint64_t> accumulator(votes.size());
  std::vector<std::uint64_t> cells;  // (x bins + y) bins + z: they compare as x, then y, then z do
  cells.reserve(votes.size());
  for (const Vote& vote : votes) {
    std::uint64_t cell = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double place = extent(axis) > indivisible ? (vote.position(axis) - low(axis)) / width(axis) : 0;
      cell = cell * count + std::min(static_cast<std::uint64_t>(place), count - 1);
    }
    accumulator.add(cell, 1);
    cells.push_back(cell);
  }
  const std::uint64_t peak = accumulator.fullest();
  std::array<std::uint64_t, 7> winners;  // the peak itself where there is no neighbour
  winners.fill(peak);
  std::uint64_t step = 1;
  for (std::size_t axis = 0; axis < 3; ++axis, step *= count) {
    const std::uint64_t place = peak / step % count;
    if (place > 0) winners[2 * axis] = peak - step;
    if (place + 1 < count) winners[2 * axis + 1] = peak + step;
  }
  Indices rows;
  for (std::size_t i = 0; i < votes.size(); ++i) {
    bool wins = false;
    for (const std::uint64_t winner : winners) wins |= cells[i] == winner;
    if (wins) rows.push_back(votes[i].row);
  }
  return rows;
}

/// The cell and the weight of each of the 8 cubes that share a vote.
template <class Visit>
void visit_shares(const Vote& vote, const Eigen::Array3d& low, double side, Visit visit) {
  const Eigen::Array3d scaled = (vote.position.array() - low) / side - 0.5;  // whole numbers at the centres of cells
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
Indices select_in_cubes(const std::vector<Vote>& votes, double side) {
  const Eigen::Array3d low = bounding_box(votes).low;
  Accumulator<Cell> accumulator(8 * votes.size());
  for (const Vote& vote : votes)
    visit_shares(vote, low, side, [&](const Cell& cell, double weight) { accumulator.add(cell, weight); });
  const Cell peak = accumulator.fullest();
  Indices rows;
  for (const Vote& vote : votes) {
    bool has_share = false;
    visit_shares(vote, low, side, [&](const Cell& cell, double) { has_share = has_share || cell == peak; });
    if (has_share) rows.push_back(vote.row);
  }
  return rows;
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

double working_memory(int matches, const HoughVotingOptions& options) {
  // The votes, their cells and the selection as it grows; a table of less than 4 slots for each share of a vote.
  const double shares = options.cells == HoughCells::Box ? 1 : 8;
  return matches * (32.0 + 24.0 + 12.0 + 4 * 32.0 * shares) + 256;
}

}  // namespace corral
