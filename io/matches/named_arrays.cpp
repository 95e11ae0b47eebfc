// SPDX-License-Identifier: MIT
#include "io/matches/named_arrays.h"

#include <algorithm>
#include <cmath>

#include "io/array/npy_file.h"
#include "io/disk/file.h"
#include "io/pose/pose_entry.h"
#include "kernel/error.h"

// The names are those that the published programs use; the first that is there counts.
namespace corral {

bool is_archive(const std::string& name) {
  constexpr std::string_view kEnding = ".npz";
  return name.size() > kEnding.size() && name.compare(name.size() - kEnding.size(), kEnding.size(), kEnding) == 0;
}

NamedArrays::NamedArrays(const std::string& path)
    : path_(path), content_(read_file(path)), names_(npz_names(path, content_)) {}

NamedArrays::Pair NamedArrays::points() const {
  return first_of({{"src_corr_points", "ref_corr_points"},
                   {"corr_kpts_src", "corr_kpts_dst"},
                   {"src_keypts", "tgt_keypts"},
                   {"src_kpts", "tgt_kpts"},
                   {"kpts_src", "kpts_dst"},
                   {"kpts_src", "kpts_tgt"},
                   {"source_points", "target_points"},
                   {"source", "target"},
                   {"src_pts", "tgt_pts"},
                   {"src_points", "tgt_points"},
                   {"src", "tgt"},
                   {"src", "dst"},
                   {"xyz0", "xyz1"},
                   {"pts0", "pts1"},
                   {"points0", "points1"},
                   {"v1", "v2"}});
}

NamedArrays::Pair NamedArrays::features() const {
  return first_of({{"features0", "features1"},
                   {"src_features", "tgt_features"},
                   {"src_feats", "tgt_feats"},
                   {"src_desc", "tgt_desc"},
                   {"feats0", "feats1"},
                   {"feature0", "feature1"}});
}

std::string NamedArrays::matches() const {
  return first_of({"corr", "corrs", "corr_pos", "corr_data", "corres", "correspondences", "matches", "corr_ind"});
}

std::string NamedArrays::labels() const { return first_of({"gt_labels", "gt_label", "labels", "label"}); }

std::optional<RigidTransform> NamedArrays::pose() {
  const std::string name = first_of(
      {"gt_trans", "trans_gt", "transform", "gt_transform", "gtmat", "GTmat", "ground_truth", "T_gt", "gt", "pose"});
  if (name.empty()) return std::nullopt;
  const NumberTable table = read(name);
  if (table.width() != 4 || (table.size() != 3 && table.size() != 4))
    throw IoError(table.path, "",
                  "is " + std::to_string(table.size()) + " x " + std::to_string(table.width()) +
                      ", expected a pose of 4 x 4 or 3 x 4");
  PoseEntry entry;
  entry.numbers.assign(table.rows.data(), table.rows.data() + table.rows.size());
  for (const double number : entry.numbers)
    if (!std::isfinite(number)) throw IoError(table.path, "", "holds a number that is not finite, expected a pose");
  return rigid_pose(table.path, entry);
}

std::string NamedArrays::own_points() const {
  return first_of({"xyz", "xyz_down", "keypts", "keypoints", "kpts", "points", "pts"});
}

std::string NamedArrays::own_features() const {
  return first_of({"feature", "features", "feats", "feat", "desc", "descriptors", "data"});
}

NumberTable NamedArrays::read(const std::string& name) {
  read_.push_back(name);
  NumberTable table;
  table.path = path_ + ":" + name;
  table.rows = parse_npz(path_, content_, name).rows;
  return table;
}

std::string NamedArrays::unread() const {
  std::string text;
  for (const std::string& name : names_)
    if (std::find(read_.begin(), read_.end(), name) == read_.end()) text += (text.empty() ? "" : ", ") + name;
  return text;
}

bool NamedArrays::has(const std::string& name) const {
  return std::find(names_.begin(), names_.end(), name) != names_.end();
}

std::string NamedArrays::first_of(const std::vector<const char*>& names) const {
  for (const char* name : names)
    if (has(name)) return name;
  return "";
}

NamedArrays::Pair NamedArrays::first_of(const std::vector<std::pair<const char*, const char*>>& pairs) const {
  for (const auto& [source, target] : pairs)
    if (has(source) && has(target)) return {source, target};
  return {};
}

}  // namespace corral
