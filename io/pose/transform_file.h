// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <vector>

#include "kernel/rigid_transform.h"

namespace corral {

/// A rigid motion with what was done to read it.
struct StoredTransform : RigidTransform {
  std::vector<std::string> notes = {};  ///< what a user should know: a sentence each, no full stop
};

/// A pose as users name it: a file, or FILE:KEY where the file has several.
struct TransformName {
  std::string file, key;  ///< the key may be empty
};

/// Takes FILE:KEY apart; a file that has this very name with the colon comes first.
TransformName split_transform_name(const std::string& name);

/// Reads a rigid motion p_target = R p_source + t, in mesh units, in any layout of the field. The content tells which:
///
///   matrix     4x4 or 3x4, row by row, in one line or several, with or without commas, semicolons and brackets
///   KITTI      12 (or 16) numbers a line: frame 0, 1, ... -> world
///   TUM        time tx ty tz qx qy qz qw, or without the time (frames 0, 1, ...): frame -> world
///   .log       Redwood and 3DMatch: lines "i j n" with a 4x4 matrix below: fragment j -> fragment i; i = j: frame -> world
///   .conf      Stanford: bmesh FILE tx ty tz qx qy qz qw, whose quaternion is the transpose's: scan -> world
///   .json      BOP's scene_gt.json (IMAGE/INSTANCE: model -> camera), or an object with matrices by name
///
/// KEY names one of several: "source,target", or "source" alone for its pose in the world of the file. "a,b" where only
/// b -> a is stored is its inverse; where both are in the same world, it is inverse(world_from_b) world_from_a.
///
/// A rotation is accepted if it is orthonormal to 1e-4 with det +1. One that is printed with 3 or more digits and whose
/// deviation these explain is taken to the nearest rotation, with a note. Anything else is refused, with the numbers that
/// show it and the cause where it is known: mirrored, scaled, transposed.
/// Throws    IoError that names the file, the line or pose, and what was expected there.
StoredTransform read_transform(const std::string& name);

/// The same as text: a 4x4 matrix, four lines of four numbers; reading it back gives the same doubles.
std::string transform_text(const RigidTransform& transform);

/// Layouts that are written.
enum class TransformLayout { Matrix4x4, Matrix3x4, Kitti, Tum, Log, Conf, JsonRows, Bop };
constexpr std::array<const char*, 8> choice_names(TransformLayout) {
  return {"4x4", "3x4", "kitti", "tum", "log", "conf", "json", "bop"};
}

/// The pose as a file of this layout. The key is what names the pose there: a time for TUM (default 0), "source,target" for
/// .log (default 1,0), the file of the scan for .conf (default source.ply), the image for BOP (default 0, object 1).
/// Throws InvalidInput for a key that the layout cannot hold.
std::string transform_text(const RigidTransform& transform, TransformLayout layout, const std::string& key = "");

}  // namespace corral
