// SPDX-License-Identifier: MIT
// The readers of io/. What is read must be valid, and must be the same when it is written and read again.
#include "io/array/npy_file.h"
#include "io/disk/inflate.h"
#include "io/matches/feature_file.h"
#include "io/matches/foreign_matches.h"
#include "io/matches/group_file.h"
#include "io/matches/label_file.h"
#include "io/matches/matches_file.h"
#include "io/mesh/bin_file.h"
#include "io/mesh/mesh_file.h"
#include "io/pairs/dataset_file.h"
#include "io/pairs/fragment_poses.h"
#include "io/pairs/scan_pairs.h"
#include "io/pose/pose_entry.h"
#include "io/text/csv_file.h"
#include "io/text/toml_file.h"
#include "tests/fuzz/target.h"

namespace corral::fuzz {
namespace {

template <StoredMesh (*parse)(const std::string&, std::string_view)>
void mesh(const std::string& bytes) {
  const StoredMesh read = parse("file", bytes);
  read.validate("read");
  if (bytes.size() % 2 == 0) return;
  const std::string written = bytes.size() % 3 == 0 ? ply_text(read) : binary_ply_text(read);
  const StoredMesh again = parse_ply("again", written);
  require(again.vertices == read.vertices && again.triangles == read.triangles &&
              again.normals.rows() == read.normals.rows(),
          "a mesh that is written and read again is the same");
}

void gzip(const std::string& bytes) {
  const std::string content = inflated("file", bytes);
  require(content.size() <= std::max<std::size_t>(64u << 20, 100 * bytes.size()), "what comes out is limited");
}

void matches(const std::string& bytes) {
  const CorrespondenceSet read = read_matches(in_file(bytes, "matches.csv"));
  read.validate();
  const std::string written = matches_text(read);
  require(matches_text(read_matches(in_file(written, "again.csv"))) == written, "matches read again are the same");
}

void group(const std::string& bytes) {
  const GroupTable read = read_group(in_file(bytes, "group.csv"));
  const std::string written = group_text(read);
  require(group_text(read_group(in_file(written, "again.csv"))) == written, "a group read again is the same");
}

void labels(const std::string& bytes) {
  const Indices rows = read_selection(in_file(bytes, "labels.txt"), 6);
  for (std::size_t i = 0; i < rows.size(); ++i)
    require(rows[i] >= 0 && rows[i] < 6 && (i == 0 || rows[i] > rows[i - 1]), "rows ascend and are in the table");
}

const Points& cloud() {
  static const Points points = Points::Random(5, 3);
  return points;
}

/// The first byte says as what; archives and arrays by their names.
void foreign(const std::string& bytes) {
  if (bytes.empty()) return;
  const char* const names[] = {"foreign.txt", "foreign.npy", "foreign.npz"};
  const int kind = static_cast<unsigned char>(bytes[0]);
  ForeignFiles files{in_file(std::string_view(bytes).substr(1), names[kind % 3]), "", &cloud(), &cloud()};
  if (kind / 3 % 2 == 1) files.source = files.target = nullptr;
  if (kind / 6 % 2 == 1) files.targets = files.matches;
  const ForeignMatches read = read_foreign_matches(files);
  read.matches.validate();
  require(read.kept.size() == static_cast<std::size_t>(read.matches.size()), "each match has its row");
}

void features(const std::string& bytes) {
  if (bytes.empty()) return;
  const char* const names[] = {"features.txt", "features.npy", "features.npz"};
  const int kind = static_cast<unsigned char>(bytes[0]);
  const std::string file = in_file(std::string_view(bytes).substr(1), names[kind % 3]);
  const FeaturePoints read = read_features({file, kind / 3 % 2 == 1 ? file : "", &cloud()});
  require(read.features.cols() == read.points.rows() && read.points.allFinite() && read.features.allFinite(),
          "each point has a feature");
}

void npy(const std::string& bytes) { parse_npy("file", bytes); }

void npz(const std::string& bytes) {
  for (const std::string& name : npz_names("file", bytes)) parse_npz("file", bytes, name);
}

void pose(const std::string& bytes) {
  const std::string file = in_file(bytes, "pose.txt");
  for (const PoseEntry& entry : parse_poses("file", bytes)) {
    const StoredTransform read = rigid_pose("file", entry);
    require((read.rotation.transpose() * read.rotation - Eigen::Matrix3d::Identity()).norm() < 1e-3, "a pose is rigid");
  }
  const StoredTransform read = read_transform(file);
  const std::string written = transform_text(read);
  require(transform_text(read_transform(in_file(written, "again.txt"))) == written, "a pose read again is the same");
}

void pose_json(const std::string& bytes) {
  for (const PoseEntry& entry : parse_pose_json("file", bytes)) rigid_pose("file", entry);
}

void pose_array(const std::string& bytes) { read_transform(in_file(bytes, "pose.npy")); }

void fragments(const std::string& bytes) {
  const std::size_t half = bytes.find('\0');
  const std::string log = in_file(std::string_view(bytes).substr(0, half), "gt.log");
  read_fragment_pairs(log,
                      half == std::string::npos ? "" : in_file(std::string_view(bytes).substr(half + 1), "gt.info"));
}

void scans(const std::string& bytes) { read_scan_list(in_file(bytes, "scans.txt")); }

/// A manifest and its table, parted by a zero.
void dataset(const std::string& bytes) {
  const std::size_t half = std::min(bytes.find('\0'), bytes.size());
  const std::string manifest = in_file(std::string_view(bytes).substr(0, half), "dataset.toml");
  in_file(half < bytes.size() ? bytes.substr(half + 1) : "", "pairs.csv");
  const Dataset read = read_dataset(manifest.substr(0, manifest.rfind('/')));
  for (const DatasetPair& pair : read.pairs) {
    require(pair.name.find('/') == std::string::npos && pair.name[0] != '.', "a name of a pair is a name of a file");
    for (const std::string& attribute : read.attributes) attribute_text(read, pair, attribute);
  }
  const std::string toml = dataset_toml_text(read), table = pairs_csv_text(read);
  in_file(toml, "dataset.toml"), in_file(table, "pairs.csv");
  const Dataset again = read_dataset(read.folder);
  require(dataset_toml_text(again) == toml && pairs_csv_text(again) == table, "a manifest read again is the same");
}

void csv(const std::string& bytes) {
  const CsvTable read = parse_csv("file", bytes);
  const std::string written = csv_text(read);
  require(csv_text(parse_csv("again", written)) == written, "a table read again is the same");
}

void toml(const std::string& bytes) {
  const TomlTable table = TomlTable::parse("file", bytes);
  for (const std::string& key : table.keys()) table.scalar_text(key);
}

}  // namespace

const std::vector<Target>& file_targets() {
  static const std::vector<Target> all = {{"ply", mesh<parse_ply>},
                                          {"off", mesh<parse_off>},
                                          {"obj", mesh<parse_obj>},
                                          {"stl", mesh<parse_stl>},
                                          {"pcd", mesh<parse_pcd>},
                                          {"xyz", mesh<parse_xyz>},
                                          {"bin", mesh<parse_bin>},
                                          {"gzip", gzip},
                                          {"matches", matches},
                                          {"group", group},
                                          {"labels", labels},
                                          {"foreign", foreign},
                                          {"features", features},
                                          {"npy", npy},
                                          {"npz", npz},
                                          {"pose", pose},
                                          {"pose_json", pose_json},
                                          {"pose_array", pose_array},
                                          {"fragments", fragments},
                                          {"scans", scans},
                                          {"dataset", dataset},
                                          {"csv", csv},
                                          {"toml", toml}};
  return all;
}

}  // namespace corral::fuzz
