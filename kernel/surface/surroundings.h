// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "kernel/surface/mesh/mesh.h"
#include "kernel/surface/search/neighborhood.h"

namespace corral {

/// How far the neighbourhood of a vertex extends over a mesh. A path length is that of the shortest among the paths with the
/// fewest edges.
struct Reach {
  double ball_radius = 0;                            ///< above 0: all vertices within it; the other fields are ignored
  int most_rings = std::numeric_limits<int>::max();  ///< most edges from the vertex
  double longest_path = std::numeric_limits<double>::infinity();  ///< the first ring with a longer path is the last
};

/// Collects the neighbourhoods of a mesh, one at a time.
class Surroundings {
 public:
  /// `rings` are those of vertex_rings(mesh) and must outlive this; the mesh need not.
  Surroundings(const Mesh& mesh, const std::vector<Indices>& rings, const Reach& reach);

  /// The neighbours of a vertex relative to it, itself included; the caller may overwrite them; valid until the next call.
  /// Their order depends on their coordinates alone, so that sums over them are the same to the last bit however the
  /// vertices are numbered.
  std::vector<Eigen::Vector3d>& around(int vertex);

 private:
  void collect(int vertex);
  double add_ring(std::size_t first, int depth);
  const Eigen::Vector3d& place(int vertex) const;

  const std::vector<Indices>& rings_;
  Reach reach_;
  std::unique_ptr<PointIndex> index_;    // of a ball
  std::vector<Eigen::Vector3d> sorted_;  // all vertices by x, then y, then z
  Indices rank_;                         // of each vertex among them
  Indices found_;                        // the present neighbourhood, ring after ring
  Indices depth_;                        // edges from the present vertex; -1 beyond
  std::vector<double> path_;             // length to the present vertex
  std::vector<Eigen::Vector3d> offsets_;
};

}  // namespace corral
