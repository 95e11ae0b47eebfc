// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/picture/surface_view.h"

namespace corral {

/// What there is to see of a pair: two surfaces and the matches between them.
struct PairScene {
  PaintedSurface source, target;
  std::optional<RigidTransform> truth;  ///< target_from_source, or what is next to it: turns the two surfaces alike
  Points source_points, target_points;  ///< of the matches, M rows in mesh units
  std::vector<bool> right;              ///< M, or empty where the truth is not known
};

/// What one method selected, under a name for people.
struct DrawnGroup {
  std::string title;
  Indices selected;
};

/// The two surfaces side by side in one scale, every selected match as a line: right ones green, wrong ones red, and
/// right ones that are missed faint; blue all selected and faint the others where the truth is not known. The title
/// counts them. One picture for each group, all of one size, `width` pixels wide.
std::vector<Image> match_pictures(const PairScene& scene, const std::vector<DrawnGroup>& groups, int width);

/// A pose to look at; absent: there was none.
struct DrawnPose {
  std::string title;
  std::optional<RigidTransform> target_from_source;
};

/// The source laid on the target by every pose, all in one view, each `width` pixels wide: the source orange, the
/// target blue. Without a pose the target stands alone.
std::vector<Image> alignment_pictures(const PairScene& scene, const std::vector<DrawnPose>& poses, int width);

/// Pictures of one size row by row, so many beside each other.
Image contact_sheet(const std::vector<Image>& pictures, int columns);

}  // namespace corral
