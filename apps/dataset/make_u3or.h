// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/runtime/progress.h"
#include "kernel/parallel.h"
#include "kernel/surface/scan/scene_composition.h"

namespace corral {

struct MakeU3orOptions {
  std::vector<std::string> models;  ///< mesh files; 5 or more for scenes of 4 and 5 different ones
  std::string output;               ///< folder of the set
  std::uint64_t seed = 1;
  int scenes = 12;
  double noise_pr = 0.1;  ///< deviation of the depth along each ray
  ParallelFor parallel = one_by_one;
};

/// A recognition set after the published one: heaps of models, each seen by a virtual range scanner.
///
///   models/NAME.ply   every model, moved to the origin and scaled to a bounding-box diagonal of 200 mm
///   scenes/sK.ply     the view of a heap, with faces, in the frame of the sensor (at the origin, looking along -z)
///   scenes/sK.csv     the pairs of the scene
///   truth/NAME-sK.xf  model to scene, exact
///
/// A pair is a model of which a scene shows at least 5 %; its attributes are scene, model, and clutter and occlusion in
/// percent (measure_visibility). The scenes are as dense as the models on average, within 20,000 to 60,000 points or so.
/// An interrupted call continues when repeated. Three progress steps per scene.
///
/// Source    [mian2006recognition], [mian2010repeatability].
/// Returns   how the pairs spread over the bins.
/// Throws    IoError, InvalidInput.
VisibilityCounts make_u3or(const MakeU3orOptions& options, Progress& progress);

/// The same in words: three lines, the last without its line break.
std::string to_text(const VisibilityCounts& counts);

}  // namespace corral
