// SPDX-License-Identifier: MIT
#include "kernel/surface/mesh/sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace corral {
namespace {

std::size_t index(int number) { return static_cast<std::size_t>(number); }

/// The vertices of a mesh by side.
class Ends {
 public:
  explicit Ends(const Triangles& triangles)
      : from_(triangles.data()), faces_(static_cast<int>(triangles.rows())), count_(3 * faces_) {}

  int faces() const { return faces_; }
  int count() const { return count_; }
  int face(int side) const { return side < faces_ ? side : side < count_ - faces_ ? side - faces_ : side - 2 * faces_; }
  int next(int side) const { return side < count_ - faces_ ? side + faces_ : side - 2 * faces_; }
  int before(int side) const { return side < faces_ ? side + 2 * faces_ : side - faces_; }

  int from(int side) const { return from_[side]; }
  int to(int side) const { return from_[next(side)]; }
  int low(int side) const { return std::min(from(side), to(side)); }
  int high(int side) const { return std::max(from(side), to(side)); }
  std::pair<int, int> edge(int side) const { return {low(side), high(side)}; }

 private:
  const int* from_;
  int faces_, count_;
};

/// The sides of a triangle in ascending order of their edges: parts that cannot be wound alike depend on it.
std::array<int, 3> sides_by_edge(const Ends& ends, int face) {
  std::array<int, 3> sides = {face, face + ends.faces(), face + 2 * ends.faces()};
  std::sort(sides.begin(), sides.end(), [&](int a, int b) { return ends.edge(a) < ends.edge(b); });
  return sides;
}

enum Turn : char { Unknown, Kept, Turned };

/// Grows the part of one triangle; `part` are its triangles, `turned` those wound against the first.
void grow_part(const Ends& ends, const Indices& across, std::vector<Turn>& turns, Indices& part, Indices& turned) {
  for (std::size_t next = 0; next < part.size(); ++next) {
    const Turn here = turns[index(part[next])];
    if (here == Turned) turned.push_back(part[next]);
    for (const int side : sides_by_edge(ends, part[next])) {
      const int other = across[index(side)];
      if (other < 0 || turns[index(ends.face(other))] != Unknown) continue;
      const bool is_against = ends.from(side) == ends.from(other);
      turns[index(ends.face(other))] = (here == Turned) == is_against ? Kept : Turned;
      part.push_back(ends.face(other));
    }
  }
}

bool all_wound_alike(const Ends& ends, const Indices& across) {
  for (int side = 0; side < ends.count(); ++side)
    if (across[index(side)] >= 0 && ends.from(side) == ends.from(across[index(side)])) return false;
  return true;
}

/// The parts of triangles that are joined across edges.
int count_parts(const Ends& ends, const Indices& across) {
  std::vector<char> seen(index(ends.faces()), 0);
  Indices part;
  int parts = 0;
  for (int seed = 0; seed < ends.faces(); ++seed) {
    if (seen[index(seed)]) continue;
    ++parts;
    seen[index(seed)] = 1;
    for (part.assign(1, seed); !part.empty();) {
      const int face = part.back();
      part.pop_back();
      for (const int side : {face, face + ends.faces(), face + 2 * ends.faces()}) {
        if (across[index(side)] < 0) continue;
        const int other = ends.face(across[index(side)]);
        if (seen[index(other)]) continue;
        seen[index(other)] = 1;
        part.push_back(other);
      }
    }
  }
  return parts;
}

/// For each vertex a side that begins there, one of the boundary if there is; empty if a vertex has two of those, or an edge
/// more than two triangles.
Indices fan_starts(const Ends& ends, const Indices& across, Eigen::Index vertices) {
  Indices starts(static_cast<std::size_t>(vertices), kNoSide);
  for (int side = 0; side < ends.count(); ++side) {
    if (across[index(side)] == kManySides) return {};
    int& start = starts[index(ends.from(side))];
    const bool is_boundary = across[index(side)] == kNoSide;
    if (is_boundary && start != kNoSide && across[index(start)] == kNoSide) return {};
    if (is_boundary || start == kNoSide) start = side;
  }
  return starts;
}

/// Whether the triangles around each vertex are one fan: walks from the starts then pass every corner.
bool are_single_fans(const Ends& ends, const Indices& starts, const Indices& across) {
  std::size_t corners = 0;
  for (const int start : starts) {
    if (start == kNoSide) continue;
    int side = start;
    do {
      ++corners;
      side = across[index(ends.before(side))];
    } while (side >= 0 && side != start);
  }
  return corners == across.size();
}

int count_loops(const Ends& ends, const Indices& starts, const Indices& across) {
  std::vector<char> seen(across.size(), 0);
  int loops = 0;
  for (int first = 0; first < ends.count(); ++first) {
    if (across[index(first)] != kNoSide || seen[index(first)]) continue;
    ++loops;
    for (int side = first; !seen[index(side)]; side = starts[index(ends.to(side))]) seen[index(side)] = 1;
  }
  return loops;
}

}  // namespace

Indices sides_across(const Triangles& triangles, Eigen::Index vertices) {
  const Ends ends(triangles);
  // First the sides with the same lower vertex form a chain: fresh memory costs more than all else here.
  Indices last(static_cast<std::size_t>(vertices), kNoSide), across(index(ends.count()));
  for (int side = 0; side < ends.count(); ++side)
    across[index(side)] = std::exchange(last[index(ends.low(side))], side);
  std::vector<std::pair<int, int>> chain;  // the higher vertex, the side
  for (const int first : last) {
    chain.clear();
    for (int side = first; side != kNoSide; side = across[index(side)]) chain.emplace_back(ends.high(side), side);
    std::sort(chain.begin(), chain.end());
    for (auto group = chain.begin(); group != chain.end();) {
      auto behind = group + 1;
      while (behind != chain.end() && behind->first == group->first) ++behind;
      for (auto side = group; side != behind; ++side)
        across[index(side->second)] = behind - group > 2    ? kManySides
                                      : behind - group == 1 ? kNoSide
                                                            : group[side == group].second;
      group = behind;
    }
  }
  return across;
}

Indices wound_against_majority(const Triangles& triangles, const Indices& across) {
  const Ends ends(triangles);
  Indices against;
  if (all_wound_alike(ends, across)) return against;
  std::vector<Turn> turns(index(ends.faces()), Unknown);
  for (int seed = 0; seed < ends.faces(); ++seed) {
    if (turns[index(seed)] != Unknown) continue;
    turns[index(seed)] = Kept;
    Indices part{seed}, turned;
    grow_part(ends, across, turns, part, turned);
    const bool most_turned = 2 * turned.size() > part.size();
    for (const int face : most_turned ? part : turned)
      if (!most_turned || turns[index(face)] == Kept) against.push_back(face);
  }
  return against;
}

SoundEdges inspect_edges(const Points& vertices, const Triangles& triangles, const Indices& across) {
  SoundEdges found;
  const Ends ends(triangles);
  const Indices starts = fan_starts(ends, across, vertices.rows());
  if (starts.empty() || !all_wound_alike(ends, across) || !are_single_fans(ends, starts, across)) return found;
  found.is_sound = true;
  found.components = count_parts(ends, across);
  found.boundary_loops = count_loops(ends, starts, across);
  double length = 0;
  int edges = 0;
  for (int face = 0; face < ends.faces(); ++face)
    for (const int side : {face, face + ends.faces(), face + 2 * ends.faces()}) {
      const int other = across[index(side)];
      found.boundary_edges += other == kNoSide;
      if (other != kNoSide && ends.face(other) < face) continue;
      const Eigen::Vector3d step = vertices.row(ends.to(side)) - vertices.row(ends.from(side));
      length += std::sqrt(step.x() * step.x() + step.y() * step.y() + step.z() * step.z());
      ++edges;
    }
  if (edges > 0) found.mean_edge_length = length / static_cast<double>(edges);
  return found;
}

}  // namespace corral
