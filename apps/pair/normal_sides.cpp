// SPDX-License-Identifier: MIT
#include "apps/pair/normal_sides.h"

#include "apps/runtime/text_table.h"
#include "apps/runtime/workers.h"
#include "kernel/surface/normals.h"
#include "kernel/surface/search/coincidence.h"

namespace corral {

std::optional<double> opposed_normals(const Mesh& source, const Mesh& target, const RigidTransform& target_from_source,
                                      double resolution, const MatchSettings& settings) {
  const ParallelFor parallel = workers(settings.threads);
  const Points source_normals = estimate_normals(source, settings.normal_options(), parallel);
  const Points target_normals = estimate_normals(target, settings.normal_options(), parallel);
  return opposed_share({source.vertices, source_normals}, {target.vertices, target_normals}, PointTree(target.vertices),
                       target_from_source, resolution);
}

std::string opposed_warning(double share) {
  return "the normals of the surfaces point to opposite sides on " + fixed(100 * share, 0) +
         " % of the overlap: give the place of the sensor with --sensor, or turn the faces of one";
}

}  // namespace corral
