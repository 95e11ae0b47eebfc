// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "kernel/parallel.h"
#include "kernel/surface/search/point_grid.h"

namespace corral {

/// The support of a point: the vertices around it, column by column, without those at the point itself.
struct Support {
  AlignedColumn x, y, z;     ///< from the point, mesh units
  AlignedColumn distance;    ///< > 0
  AlignedColumn nx, ny, nz;  ///< unit normals; zero where there is none
  AlignedColumn rows;        ///< of the vertices; only from SupportFinder::find_rows
  int count = 0;

  /// Adds a vertex; at distance 0 it is passed over.
  void add(const Eigen::Vector3d& offset, const Eigen::Vector3d& normal);
};

/// Whether vertices at exactly the radius belong to a support.
enum class Rim { Inside, Outside };

/// The support of every vertex that is asked for, through a grid.
class SupportFinder {
 public:
  SupportFinder(const Points& vertices, const Points& normals, double radius, Rim rim);

  /// The order in which walking over the cells meets some vertices.
  std::vector<std::size_t> walk(const Indices& vertices) const;

  /// Where a walk has come to.
  struct Place {
    CellSweep sweep;
    int end = 0;                    // of the slots of the cell
    std::vector<SlotRange> around;  // it
  };
  Place start() const { return {CellSweep(grid_, kReach), 0, {}}; }

  /// Vertices must come in the order of walk().
  void find(int vertex, Place& place, Support& support) const { look(vertex, place, support, false); }
  /// The same, with support.rows.
  void find_rows(int vertex, Place& place, Support& support) const { look(vertex, place, support, true); }

 private:
  static constexpr int kReach = 2;  // cells of half the radius waste fewer looks than cells of the radius

  int slot_of(int vertex) const { return slots_[static_cast<std::size_t>(vertex)]; }
  void look(int vertex, Place& place, Support& support, bool with_rows) const;
  void move_to(int cell, Place& place, Support& support) const;
  void collect(std::size_t slot, const std::vector<SlotRange>& ranges, Support& support, bool with_rows) const;

  PointGrid grid_;
  AlignedColumn nx_, ny_, nz_, rows_;
  double squared_;
  std::vector<int> slots_;  // by vertex
};

/// Calls visit(i, support) once for every keypoint i, in an order that the finder likes, on any thread. `visitor` makes the
/// visit of each chunk of keypoints: it may own memory that one keypoint after the other uses.
using SupportVisit = std::function<void(std::size_t i, const Support& support)>;
void visit_supports(const SupportFinder& finder, const Indices& keypoints, const ParallelFor& parallel,
                    const std::function<SupportVisit()>& visitor);

}  // namespace corral
