// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/runtime/progress.h"
#include "kernel/parallel.h"

namespace corral {

struct MakeU3mOptions {
  std::vector<std::string> models;  ///< mesh files
  std::string output;               ///< folder of the set
  std::uint64_t seed = 1;
  int views = 8;          ///< of each model
  double noise_pr = 0.1;  ///< deviation of the depth along each ray
  ParallelFor parallel = one_by_one;
};

/// A registration set after the published one: every model seen by virtual range scanners, the first of a ring of 16
/// (ring_sensor), or of as many as there are views. The published models have 16 to 22 views.
///
///   views/NAME-vI.ply     a view with faces, in the frame of its sensor (at the origin, looking along -z)
///   views/NAME.csv        the pairs of the model
///   truth/NAME-vI-vJ.xf   view I to view J, exact
///
/// A pair is two views of a model that overlap by 30 to 90 % (overlap_share at 2 pr, the mean of both); its attributes are
/// model, source_view, target_view, and overlap in percent. The views are as dense as the model and in its units.
/// An interrupted call continues when repeated. One progress step per model.
///
/// Source    [mian2006recognition] for the published views, [yang2017evaluation] for the range of overlaps.
/// Throws    IoError, InvalidInput.
void make_u3m(const MakeU3mOptions& options, Progress& progress);

}  // namespace corral
