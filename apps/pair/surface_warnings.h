// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kernel/surface/mesh/mesh.h"
#include "kernel/surface/normals.h"
#include "kernel/surface/search/resolution.h"

namespace corral {

/// What of the data of a surface makes results wrong without a failure: sentences without their full stop, that name the
/// vertices or coordinates at fault and the remedy.
///
///   stray points   lone vertices that decide on pr (PointSpacing::is_moved_by_strays)
///   rounding       coordinates that 32 bits hold, so far from the origin that their step is 0.1 pr or more
std::vector<std::string> surface_warnings(const Mesh& mesh, const PointSpacing& spacing);

/// The first of these; empty if pr is sound.
std::string stray_warning(const PointSpacing& spacing);

/// The size of a surface by two measures, mesh units.
struct SurfaceSize {
  double extent = 0;      ///< root mean square distance of its vertices from their mean, which no turn changes
  double resolution = 0;  ///< its pr
};
SurfaceSize size_of(const Points& vertices, double resolution);

/// Whether two surfaces are in different units, as far as sizes tell: extents may differ in a cluttered scene, resolutions in
/// a thinned one, but hardly both by the same power of ten, nor both by the same other factor within 8 %. Empty if not.
std::string unit_warning(const SurfaceSize& source, const SurfaceSize& target);

/// Where it makes normals point: "by the faces", "by the normals of the file", "towards the sensor", "towards the sensor of
/// the file", "towards the origin".
const char* to_text(NormalGuide guide);

/// Advice where the normals of two surfaces may lie on different sides: one follows what its file says, the other looks at
/// the origin for lack of anything. Empty if not.
std::string normal_hint(NormalGuide source, NormalGuide target);

/// The mesh without some vertices, and without the faces that use them; the others are numbered anew.
Mesh without_vertices(const Mesh& mesh, const Indices& dropped);

}  // namespace corral
