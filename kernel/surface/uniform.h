// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/options.h"
#include "kernel/surface/keypoints.h"
#include "kernel/surface/mesh/mesh.h"

namespace corral {

struct UniformOptions {
  double spacing_pr = 3;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(OptionField{"spacing_pr", "pr", "", "edge of the cubes of the lattice", above(0)}, self.spacing_pr);
  }
};

/// Uniform sampling, a control without any choice: of the vertices in each cube of a lattice the one nearest to the middle.
/// The lattice starts at the lowest corner of the bounding box; ties go to the lower index.
///
/// Cost      O(V log V) time, O(V) memory. Deterministic.
/// Throws    InvalidInput if the spacing or `resolution` is not finite and positive.
Keypoints detect_uniform(const Points& vertices, double resolution, const UniformOptions& options = {});

}  // namespace corral
