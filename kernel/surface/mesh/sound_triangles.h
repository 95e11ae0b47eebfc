// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "kernel/surface/mesh/mesh.h"
#include "kernel/surface/mesh/sides.h"

namespace corral {

/// The triangles of a mesh without degenerate ones (a repeated corner, or no area), those of each part wound alike as far as they
/// can be. They are copied only if any must change; the mesh must outlive it.
class SoundTriangles {
 public:
  explicit SoundTriangles(const Mesh& mesh);

  const Triangles& operator()() const { return changed_ ? *changed_ : given_; }
  const JoinedSides& joined() const { return joined_; }
  int degenerate() const { return degenerate_; }  ///< left out
  int reversed() const { return reversed_; }      ///< wound against the majority of their part

 private:
  void turn(int face);

  const Triangles& given_;
  std::optional<Triangles> changed_;
  JoinedSides joined_;
  int degenerate_ = 0, reversed_ = 0;
};

}  // namespace corral
