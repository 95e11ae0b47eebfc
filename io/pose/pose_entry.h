// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "io/pose/transform_file.h"

// Between the layouts of poses and what is made of them.
namespace corral {

/// One pose of a file, as it stands there: nothing about its numbers has been checked but that they are finite.
struct PoseEntry {
  std::string source;           ///< what is moved, by its name in the file
  std::string target;           ///< into what, if the file names it; empty: into a world
  std::string world;            ///< of several worlds in one file; poses are composed within one only
  std::string place;            ///< for messages, such as "line 7"; empty for the only pose of a file
  std::vector<double> numbers;  ///< 16 or 12: the rows of a matrix; 7: translation, quaternion x y z w
  std::vector<std::string> notes = {};
};

/// All poses of a text, whose layout its content tells. Throws IoError.
std::vector<PoseEntry> parse_poses(const std::string& path, const std::string& content);

/// The same of a JSON object: BOP's scene_gt.json, or matrices by name.
std::vector<PoseEntry> parse_pose_json(const std::string& path, const std::string& content);

/// The rigid motion of an entry; throws IoError if it is none.
StoredTransform rigid_pose(const std::string& path, const PoseEntry& entry);

}  // namespace corral
