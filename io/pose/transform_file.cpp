// SPDX-License-Identifier: MIT
#include "io/pose/transform_file.h"

#include <algorithm>
#include <filesystem>

#include "io/array/npy_file.h"
#include "io/disk/file.h"
#include "io/pose/pose_entry.h"
#include "io/text/line_reader.h"
#include "io/text/toml_file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

/// Times may be written in several ways: 7, 7.0, 07.
bool same_name(const std::string& a, const std::string& b) {
  if (a == b) return true;
  const std::optional<double> first = parse_double(a), second = parse_double(b);
  return first && second && *first == *second;
}

std::string key_of(const PoseEntry& entry) {
  return entry.target.empty() ? entry.source : entry.source + "," + entry.target;
}

/// The poses of a file, by the names of what they map.
class PoseList {
 public:
  PoseList(const TransformName& name, const std::vector<PoseEntry>& entries) : name_(name), entries_(entries) {}

  StoredTransform chosen() const {
    if (name_.key.empty()) {
      if (entries_.size() == 1) return pose(entries_[0]);
      throw IoError(
          name_.file, "",
          "has " + std::to_string(entries_.size()) + " poses, expected FILE:KEY, which names one of " + keys());
    }
    if (const PoseEntry* entry = find(name_.key, "")) return pose(*entry);
    const std::size_t comma = name_.key.find(',');
    if (comma == std::string::npos) fail();
    const std::string source = name_.key.substr(0, comma), target = name_.key.substr(comma + 1);
    if (source.empty() || target.empty()) fail();
    return between(source, target);
  }

 private:
  StoredTransform pose(const PoseEntry& entry) const { return rigid_pose(name_.file, entry); }

  const PoseEntry* find(const std::string& source, const std::string& target) const {
    const PoseEntry* found = nullptr;
    for (const PoseEntry& entry : entries_) {
      if (!same_name(entry.source, source) || !same_name(entry.target, target)) continue;
      if (found) throw IoError(name_.file, entry.place, "the pose " + key_of(entry) + " is there twice, expected once");
      found = &entry;
    }
    return found;
  }

  StoredTransform between(const std::string& source, const std::string& target) const {
    if (const PoseEntry* entry = find(source, target)) return pose(*entry);
    if (const PoseEntry* entry = find(target, source)) {
      const StoredTransform stored = pose(*entry);
      StoredTransform inverse{stored.inverse(), stored.notes};
      inverse.notes.push_back("it is the inverse of the stored pose, which maps " + target + " into " + source);
      return inverse;
    }
    const PoseEntry *from = find(source, ""), *into = find(target, "");
    if (!from || !into) fail();
    if (from->world != into->world)
      throw IoError(name_.file, "pose " + name_.key,
                    "the two are seen by the cameras of two images, expected two in one image");
    const StoredTransform world_from_source = pose(*from), world_from_target = pose(*into);
    StoredTransform relative{world_from_target.inverse() * world_from_source, world_from_source.notes};
    for (const std::string& note : world_from_target.notes)
      if (std::find(relative.notes.begin(), relative.notes.end(), note) == relative.notes.end())
        relative.notes.push_back(note);
    return relative;
  }

  std::string keys() const {
    constexpr std::size_t kShown = 5;
    std::string text;
    for (std::size_t i = 0; i < std::min(kShown, entries_.size()); ++i)
      text += (i > 0 ? ", " : "") + corral::quoted(key_of(entries_[i]));
    return text + (entries_.size() > kShown ? ", ... " + corral::quoted(key_of(entries_.back())) : "");
  }

  [[noreturn]] void fail() const {
    std::vector<std::string> known;
    for (const PoseEntry& entry : entries_) known.push_back(key_of(entry));
    if (entries_.size() == 1 && known[0].empty())
      throw IoError(name_.file, "pose " + name_.key,
                    "is not in the file, which holds a single unnamed pose; leave out the key");
    const std::string nearest = nearest_name(name_.key, known);
    throw IoError(name_.file, "pose " + name_.key,
                  "is not there, expected one of " + keys() + ", or SOURCE,TARGET of two of them" +
                      (nearest.empty() ? "" : "; did you mean " + corral::quoted(nearest) + "?"));
  }

  const TransformName& name_;
  const std::vector<PoseEntry>& entries_;
};

/// A matrix of 4x4 or 3x4 that numpy wrote.
PoseEntry array_pose(const std::string& path, const std::string& content) {
  const Eigen::MatrixXd rows = parse_npy(path, content).rows;
  if (rows.rows() != 4 || (rows.cols() != 3 && rows.cols() != 4) || !rows.allFinite())
    throw IoError(path, "", "is no array of 4 x 4 or 3 x 4 finite numbers, expected a pose");
  PoseEntry entry;
  entry.numbers.assign(rows.data(), rows.data() + rows.size());
  return entry;
}

bool is_file(const std::string& path) {
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  return std::filesystem::exists(status) && !std::filesystem::is_directory(status);
}

}  // namespace

TransformName split_transform_name(const std::string& name) {
  if (!is_file(name))
    for (std::size_t colon = name.find(':'); colon != std::string::npos; colon = name.find(':', colon + 1))
      if (is_file(name.substr(0, colon))) return {name.substr(0, colon), name.substr(colon + 1)};
  return {name, ""};
}

StoredTransform read_transform(const std::string& name) {
  const TransformName split = split_transform_name(name);
  const std::string content = read_file(split.file);
  const bool is_array = split.file.size() > 4 && split.file.compare(split.file.size() - 4, 4, ".npy") == 0;
  const auto entries =
      is_array ? std::vector<PoseEntry>{array_pose(split.file, content)} : parse_poses(split.file, content);
  return PoseList(split, entries).chosen();
}

}  // namespace corral
