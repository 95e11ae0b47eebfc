// SPDX-License-Identifier: MIT
#include "apps/dataset/match_layouts.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>

#include "apps/dataset/set_folder.h"
#include "io/matches/named_arrays.h"
#include "io/mesh/mesh_file.h"
#include "io/pairs/fragment_poses.h"
#include "io/pairs/scan_pairs.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

namespace fs = std::filesystem;
using Pairs = std::vector<PairFiles>;

/// The files below a folder.
class Tree {
 public:
  explicit Tree(const std::string& folder) : root_(folder) {
    std::error_code error;
    for (fs::recursive_directory_iterator entry(root_, error), end; !error && entry != end; entry.increment(error))
      if (entry->is_regular_file(error)) files_.insert(entry->path().lexically_relative(root_).generic_string());
    if (error) throw IoError(folder, "", "cannot be read as a folder (" + error.message() + ")");
  }

  const std::set<std::string>& files() const { return files_; }
  /// The first that is there, as a path; empty if none is.
  std::string first(const std::string& in, const std::vector<std::string>& names) const {
    for (const std::string& name : names)
      if (files_.count(in + name)) return path(in + name);
    return "";
  }
  /// The cloud of this name without its ending, or of one that begins with it and a '_'.
  std::string cloud(const std::string& in, const std::string& name) const {
    if (files_.count(in + name) && is_mesh_name(name)) return path(in + name);
    for (const char* after : {".", "_"})
      for (auto file = files_.lower_bound(in + name + after); file != files_.end(); ++file) {
        if (file->compare(0, in.size() + name.size() + 1, in + name + after) != 0) break;
        if (file->find('/', in.size()) == std::string::npos && is_mesh_name(*file)) return path(*file);
      }
    return "";
  }
  std::string first_cloud(const std::string& in, const std::vector<std::string>& names) const {
    for (const std::string& name : names)
      if (const std::string found = cloud(in, name); !found.empty()) return found;
    return "";
  }
  std::string path(const std::string& file) const { return (root_ / file).generic_string(); }

 private:
  fs::path root_;
  std::set<std::string> files_;
};

/// The folder of a file with its '/', or nothing.
std::string folder_of(const std::string& file) { return file.substr(0, file.rfind('/') + 1); }
std::string name_of(const std::string& file) { return file.substr(file.rfind('/') + 1); }

PairFiles pair_of(const std::string& in, const std::string& name) {
  PairFiles pair;
  const std::string scene = in.empty() ? "" : in.substr(0, in.size() - 1);
  pair.name = pair_word(scene.empty() || name.empty() ? scene + name : scene + "-" + name);
  if (!scene.empty()) pair.attributes.push_back({"scene", scene});
  return pair;
}

/// A pose in the files that lie beside a table, of which the first names are the nearest.
void add_pose(const Tree& tree, const std::string& in, PairFiles& pair) {
  pair.truth = tree.first(in, {"GTmat.txt", "gtmat.txt", "gt.txt", "trans.txt", "T_gt.txt", "pose.txt", "truth.txt"});
  const auto first = [&](const char* letter) {
    std::vector<std::string> names;
    for (const char* kind : {"_gt", "_ref", ""})
      for (const char* ending : {".csv", ".txt"}) names.push_back(std::string(letter) + kind + ending);
    return tree.first(in, names);
  };
  if (!pair.truth.empty()) return;
  pair.rotation = first("R");
  pair.translation = first("t");
}

Pairs find_mac(const Tree& tree) {
  static const std::regex pattern("(.*@)?(corr_data|corr)(_[A-Za-z0-9]+)?\\.txt");
  Pairs pairs;
  for (const std::string& file : tree.files()) {
    const std::string in = folder_of(file), name = name_of(file);
    std::smatch part;
    if (!std::regex_match(name, part, pattern) || part[3] == "_ind" || part[3] == "_label") continue;
    const std::string before = part[1], after = part[3];
    const std::string data = in + before + "corr_data" + after + ".txt";
    if (file != data && tree.files().count(data)) continue;  // the coordinates, rather than indices
    const std::string sides = before.empty() ? "" : before.substr(0, before.size() - 1);
    PairFiles pair = pair_of(in, sides + after);
    pair.matches = tree.path(file);
    pair.labels = tree.first(in, {before + "label" + after + ".txt", before + "gtlabel" + after + ".txt",
                                  before + "true_corre" + after + ".txt"});
    pair.truth = tree.first(in, {before + "GTmat" + after + ".txt", before + "gtmat" + after + ".txt"});
    const std::size_t plus = sides.find('+');
    if (plus != std::string::npos) {
      pair.source = tree.cloud(in, sides.substr(0, plus));
      pair.target = tree.cloud(in, sides.substr(plus + 1));
    } else {
      pair.source = tree.first_cloud(in, {"source", "src"});
      pair.target = tree.first_cloud(in, {"target", "tgt", "des", "dst"});
    }
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

Pairs find_points(const Tree& tree) {
  static const std::vector<std::pair<std::string, std::string>> kSides = {
      {"src", "dst"}, {"src", "tgt"}, {"source", "target"}, {"objectIn", "sceneIn"}, {"v1", "v2"}};
  Pairs pairs;
  for (const std::string& file : tree.files()) {
    const std::string in = folder_of(file), name = name_of(file);
    const std::string ending = fs::path(name).extension().string(), stem = fs::path(name).stem().string();
    if (ending != ".txt" && ending != ".csv" && ending != ".npy") continue;
    for (const auto& [source, target] : kSides) {
      const bool fits =
          stem.size() >= source.size() && stem.compare(stem.size() - source.size(), source.size(), source) == 0;
      const std::string before = fits ? stem.substr(0, stem.size() - source.size()) : "";
      if (!fits || !tree.files().count(in + before + target + ending)) continue;
      std::string id = before;
      for (const std::string word : {"kpts_", "keypts_", "pts_"})
        if (id.size() >= word.size() && id.compare(id.size() - word.size(), word.size(), word) == 0)
          id.resize(id.size() - word.size());
      PairFiles pair = pair_of(in, id.empty() ? "" : id.substr(0, id.size() - (id.back() == '_')));
      if (pair.name.empty()) pair.name = pair_word(source + "+" + target);
      pair.matches = tree.path(file);
      pair.targets = tree.path(in + before + target + ending);
      for (std::string common = id; !common.empty();) {  // 000_fpfh_, then 000_
        if (pair.truth.empty() && pair.rotation.empty()) add_pose(tree, in + common, pair);
        for (const std::string& word : {std::string("pts_"), std::string()}) {
          if (pair.source.empty()) pair.source = tree.cloud(in, common + word + source);
          if (pair.target.empty()) pair.target = tree.cloud(in, common + word + target);
        }
        const std::size_t cut = common.find_last_of('_', common.size() - 2);
        common.resize(common.size() < 2 || cut == std::string::npos ? 0 : cut + 1);
      }
      if (pair.truth.empty() && pair.rotation.empty()) add_pose(tree, in, pair);
      pairs.push_back(std::move(pair));
      break;
    }
  }
  return pairs;
}

Pairs find_npz(const Tree& tree) {
  Pairs pairs;
  for (const std::string& file : tree.files()) {
    if (!is_archive(file)) continue;
    const NamedArrays arrays(tree.path(file));
    if (arrays.matches().empty() && arrays.points().source.empty()) continue;
    PairFiles pair = pair_of(folder_of(file), fs::path(file).stem().string());
    pair.matches = tree.path(file);
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

Pairs find_tcf(const Tree& tree) {
  static const std::regex pattern("(.+)\\.match"), ending("_top[0-9]+$");
  Pairs pairs;
  for (const std::string& file : tree.files()) {
    const std::string in = folder_of(file), name = name_of(file);
    std::smatch part;
    if (!std::regex_match(name, part, pattern)) continue;
    const std::string sides = std::regex_replace(part[1].str(), ending, "");
    PairFiles pair = pair_of(in, sides);
    pair.matches = tree.path(file);
    for (std::size_t cut = sides.find('_'); cut != std::string::npos; cut = sides.find('_', cut + 1)) {
      const std::string source = sides.substr(0, cut), target = sides.substr(cut + 1);
      pair.truth = tree.first(in, {source + "-" + target + ".pose"});
      if (pair.truth.empty()) continue;
      pair.source = tree.cloud(in, source);
      pair.target = tree.cloud(in, target);
      break;
    }
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

/// gt.log lies in the folder of the scene, or in SCENE-evaluation beside it or elsewhere: the fragments are found by name.
Pairs find_3dmatch(const Tree& tree) {
  Pairs pairs;
  const auto fragment_folder = [&](const std::string& scene, const std::string& first) {
    std::string found;
    for (const std::string& file : tree.files())
      if (name_of(file).rfind(first, 0) == 0 &&
          (scene.empty() || ("/" + folder_of(file)).find("/" + scene + "/") != std::string::npos))
        return folder_of(file);
    return found;
  };
  for (const std::string& file : tree.files()) {
    if (name_of(file) != "gt.log") continue;
    const std::string in = folder_of(file), kEvaluation = "-evaluation";
    std::string scene = in.empty() ? "" : name_of(in.substr(0, in.size() - 1));
    if (const std::size_t end = scene.rfind(kEvaluation);
        end != std::string::npos && end + kEvaluation.size() == scene.size())
      scene.resize(end);
    const std::string info = tree.first(in, {"gt.info"});
    const std::string fragments = fragment_folder(scene, "cloud_bin_");
    for (const FragmentPair& entry : read_fragment_pairs(tree.path(file), info)) {
      const std::string source = "cloud_bin_" + std::to_string(entry.source),
                        target = "cloud_bin_" + std::to_string(entry.target);
      PairFiles pair = pair_of(scene.empty() ? "" : scene + "/", source + "+" + target);
      pair.source = tree.first(fragments, {source + ".ply"});
      pair.target = tree.first(fragments, {target + ".ply"});
      for (const char* kind : {"_fcgf.npz", "_fpfh.npz", ".npz"}) {
        if (!pair.source_features.empty() && !pair.target_features.empty()) break;
        pair.source_features = tree.first(fragments, {source + kind});
        pair.target_features = tree.first(fragments, {target + kind});
      }
      if ((pair.source.empty() || pair.target.empty()) &&
          (pair.source_features.empty() || pair.target_features.empty()))
        continue;
      pair.truth = tree.path(file) + ":" + std::to_string(entry.source) + "," + std::to_string(entry.target);
      pair.attributes.push_back({"source_fragment", std::to_string(entry.source)});
      pair.attributes.push_back({"target_fragment", std::to_string(entry.target)});
      pair.attributes.push_back({"fragments_apart", std::to_string(std::abs(entry.source - entry.target))});
      if (entry.overlap_points) pair.attributes.push_back({"overlap_points", to_text(*entry.overlap_points)});
      pairs.push_back(std::move(pair));
    }
  }
  return pairs;
}

/// Scans of KITTI's odometry benchmark by sequence and number.
class Scans {
 public:
  explicit Scans(const Tree& tree) {
    static const std::regex pattern("(?:.*/)?([0-9]+)/velodyne/([0-9]+)\\.[^/]+");
    std::smatch part;
    for (const std::string& file : tree.files())
      if (std::regex_match(file, part, pattern)) paths_[key(part[1], part[2])] = tree.path(file);
  }
  /// Empty if there is none.
  std::string path(const std::string& sequence, const std::string& scan) const {
    const auto found = paths_.find(key(sequence, scan));
    return found == paths_.end() ? "" : found->second;
  }

 private:
  static std::string number(const std::string& digits) {
    return digits.substr(std::min(digits.find_first_not_of('0'), digits.size() - 1));
  }
  static std::string key(const std::string& sequence, const std::string& scan) {
    return number(sequence) + "/" + number(scan);
  }

  std::map<std::string, std::string> paths_;
};

std::string sequence_word(const std::string& sequence) {
  return std::string(2 - std::min<std::size_t>(2, sequence.size()), '0') + sequence;
}

void add_listed(const Tree& tree, const std::string& list, const Scans& scans, Pairs& pairs) {
  const std::string stem = fs::path(list).stem().string();
  for (const ScanPair& entry : read_scan_list(tree.path(list))) {
    const std::string from = std::to_string(entry.source_sequence), into = std::to_string(entry.target_sequence),
                      source = std::to_string(entry.source), target = std::to_string(entry.target);
    PairFiles pair = pair_of("", from + "_" + source + (from == into ? "" : "_" + into) + "_" + target);
    pair.source = scans.path(from, source);
    pair.target = scans.path(into, target);
    if (pair.source.empty() || pair.target.empty()) continue;
    pair.pose = entry.target_from_source;
    pair.attributes = {{"scene", sequence_word(from)}, {"list", stem}};
    pairs.push_back(std::move(pair));
  }
}

Pairs find_kitti(const Tree& tree) {
  static const std::regex pattern("0*([0-9]+)_0*([0-9]+)_0*([0-9]+)\\.(npy|txt)");
  const Scans scans(tree);
  Pairs pairs;
  for (const std::string& file : tree.files()) {
    const std::string name = name_of(file);
    std::smatch part;
    if (fs::path(file).extension() == ".txt" && is_scan_list(tree.path(file))) {
      add_listed(tree, file, scans, pairs);
      continue;
    }
    if (!std::regex_match(name, part, pattern)) continue;
    PairFiles pair = pair_of("", part[1].str() + "_" + part[2].str() + "_" + part[3].str());
    pair.source = scans.path(part[1], part[2]);
    pair.target = scans.path(part[1], part[3]);
    if (pair.source.empty() || pair.target.empty()) continue;
    pair.truth = tree.path(file);
    pair.attributes = {{"scene", sequence_word(part[1])}};
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

Pairs find_corral(const Tree& tree) {
  static const std::string kEnding = ".matches.csv";
  Pairs pairs;
  for (const std::string& file : tree.files()) {
    const std::string in = folder_of(file), name = name_of(file);
    if (name.size() <= kEnding.size() || name.compare(name.size() - kEnding.size(), kEnding.size(), kEnding) != 0)
      continue;
    const std::string stem = name.substr(0, name.size() - kEnding.size());
    PairFiles pair = pair_of(in, stem);
    pair.matches = tree.path(file);
    pair.truth = tree.first(in, {stem + ".xf", stem + ".txt"});
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

struct Layout {
  std::string name;
  Pairs (*find)(const Tree&);
};
const std::vector<Layout>& layouts() {
  static const std::vector<Layout> kLayouts = {
      {"mac", find_mac},         {"points", find_points}, {"npz", find_npz},       {"tcf", find_tcf},
      {"3dmatch", find_3dmatch}, {"kitti", find_kitti},   {"corral", find_corral},
  };
  return kLayouts;
}

}  // namespace

const std::vector<std::string>& match_layouts() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const Layout& layout : layouts()) names.push_back(layout.name);
    return names;
  }();
  return kNames;
}

std::vector<PairFiles> find_match_pairs(const std::string& folder, const std::string& layout) {
  const Tree tree(folder);
  Pairs pairs;
  std::string found;
  int count = 0;
  for (const Layout& each : layouts()) {
    if (!layout.empty() && each.name != layout) continue;
    Pairs here = each.find(tree);
    if (here.empty()) continue;
    found += (found.empty() ? "" : ", ") + each.name + " (" + std::to_string(here.size()) + ")";
    if (++count == 1) pairs = std::move(here);
  }
  if (count == 0)
    throw IoError(folder, "",
                  "has no pairs" + (layout.empty() ? " of a known layout" : " of the layout " + layout) +
                      "; 'corral import matches --help' lists what is expected");
  if (count > 1) throw IoError(folder, "", "has pairs of several layouts, expected --layout with one of " + found);
  std::set<std::string> names;
  for (PairFiles& pair : pairs) {
    if (pair.name.empty()) pair.name = file_word(fs::absolute(folder).lexically_normal().generic_string());
    if (!names.insert(pair.name).second)
      throw IoError(folder, "", "has two pairs that would be named " + pair.name + ", expected one for each name");
  }
  return pairs;
}

}  // namespace corral
