// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "apps/pair/match_settings.h"
#include "kernel/rigid_transform.h"

namespace corral {

/// opposed_share() of the normals by which two surfaces are matched. `resolution`: mesh units per pr.
std::optional<double> opposed_normals(const Mesh& source, const Mesh& target, const RigidTransform& target_from_source,
                                      double resolution, const MatchSettings& settings);

/// Whether the normals point to opposite sides on most of the overlap.
inline bool is_opposed(const std::optional<double>& share) { return share && *share > 0.5; }

/// The sentence of a warning, without its full stop.
std::string opposed_warning(double share);

}  // namespace corral
