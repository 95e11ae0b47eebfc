// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/picture/surface_view.h"

namespace corral {

/// What is drawn of a pair: two surfaces and the matches between them.
struct PairScene {
  PaintedSurface source, target;
  std::optional<RigidTransform> truth;  ///< target_from_source, or an approximation: orients the two surfaces alike
  Points source_points, target_points;  ///< of the matches, M rows in mesh units
  std::vector<bool> correct;            ///< correct matches, M, or empty where the truth is not known
};

/// The selection of a grouper, with a title.
struct DrawnGroup {
  std::string title;
  Indices selected;
};

/// The two surfaces side by side at one scale, every selected match as a line: correct ones green, incorrect ones red, and
/// correct ones that were not selected faint; where the truth is not known, selected ones blue and the others faint. The
/// title counts them. One picture for each group, all of one size, `width` pixels wide.
std::vector<Image> match_pictures(const PairScene& scene, const std::vector<DrawnGroup>& groups, int width);

/// A pose to draw; absent if there is none.
struct DrawnPose {
  std::string title;
  std::optional<RigidTransform> target_from_source;
};

/// The source moved to the target by each pose, all in the same view, each `width` pixels wide: the source orange, the
/// target blue. Without a pose only the target is drawn.
std::vector<Image> alignment_pictures(const PairScene& scene, const std::vector<DrawnPose>& poses, int width);

/// Pictures of one size, row by row, `columns` side by side.
Image contact_sheet(const std::vector<Image>& pictures, int columns);

}  // namespace corral
