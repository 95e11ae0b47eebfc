// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "kernel/surface/mesh/mesh.h"

namespace corral {

// Side i F + f of a mesh of F triangles runs from corner i of triangle f to its next one: where the corner is in `triangles`.
// No triangle repeats a corner.

constexpr int kNoSide = -1;     ///< no other triangle has this edge
constexpr int kManySides = -2;  ///< more than one other triangle has it

/// The vertices of a mesh by side. The triangles must outlive it.
class Ends {
 public:
  explicit Ends(const Triangles& triangles)
      : from_(triangles.data()), faces_(static_cast<int>(triangles.rows())), count_(3 * faces_) {}

  int faces() const { return faces_; }
  int count() const { return count_; }
  int face(int side) const { return side < faces_ ? side : side < count_ - faces_ ? side - faces_ : side - 2 * faces_; }
  int next(int side) const { return side < count_ - faces_ ? side + faces_ : side - 2 * faces_; }
  int before(int side) const { return side < faces_ ? side + 2 * faces_ : side - faces_; }
  std::array<int, 3> sides_of(int face) const { return {face, face + faces_, face + 2 * faces_}; }

  int from(int side) const { return from_[side]; }
  int to(int side) const { return from_[next(side)]; }
  int low(int side) const { return std::min(from(side), to(side)); }
  int high(int side) const { return std::max(from(side), to(side)); }
  std::pair<int, int> edge(int side) const { return {low(side), high(side)}; }

 private:
  const int* from_;
  int faces_, count_;
};

/// Entry of a table by side, face or vertex.
inline std::size_t index(int number) { return static_cast<std::size_t>(number); }

struct JoinedSides {
  Indices across;      ///< for each side that of the triangle across its edge, or one of the two above
  int many_edges = 0;  ///< edges of more than two triangles
};

/// However the triangles are wound.
JoinedSides join_sides(const Triangles& triangles, Eigen::Index vertices);

/// The triangles of each part that are wound against its majority; parts join across edges of two triangles.
Indices wound_against_majority(const Triangles& triangles, const Indices& across);

}  // namespace corral
