// SPDX-License-Identifier: MIT
#include "kernel/surface/mesh/sides.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace corral {
namespace {

/// The sides of a triangle in ascending order of their edges: parts that cannot be wound alike depend on it.
std::array<int, 3> sides_by_edge(const Ends& ends, int face) {
  std::array<int, 3> sides = ends.sides_of(face);
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

}  // namespace

JoinedSides join_sides(const Triangles& triangles, Eigen::Index vertices) {
  const Ends ends(triangles);
  // First the sides with the same lower vertex form a chain: fresh memory costs more than all else here.
  JoinedSides joined{Indices(index(ends.count()))};
  Indices& across = joined.across;
  Indices last(static_cast<std::size_t>(vertices), kNoSide);
  for (int side = 0; side < ends.count(); ++side)
    across[index(side)] = std::exchange(last[index(ends.low(side))], side);
  struct Met {
    int low, side;  // the last lower vertex of a chain that has a side to this higher one, and the first such side
  };
  std::vector<Met> met(last.size(), Met{kNoSide, kNoSide});
  for (int low = 0; low < static_cast<int>(vertices); ++low)
    for (int side = last[index(low)], next; side != kNoSide; side = next) {
      next = std::exchange(across[index(side)], kNoSide);
      Met& before = met[index(ends.high(side))];
      if (before.low != low) {
        before = {low, side};
        continue;
      }
      const int other = across[index(before.side)];
      if (other == kNoSide) {
        across[index(side)] = before.side;
        across[index(before.side)] = side;
        continue;
      }
      if (other >= 0) across[index(other)] = across[index(before.side)] = kManySides, ++joined.many_edges;
      across[index(side)] = kManySides;
    }
  return joined;
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

}  // namespace corral
