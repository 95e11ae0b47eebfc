// SPDX-License-Identifier: MIT
#include "apps/dataset/import_u3m.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "apps/align/alignment_files.h"
#include "apps/dataset/set_folder.h"
#include "apps/pair/read_surface.h"
#include "apps/runtime/text_table.h"
#include "io/disk/file.h"
#include "io/mesh/mesh_file.h"
#include "io/pairs/dataset_file.h"
#include "io/pose/transform_file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"
#include "kernel/surface/scan/visibility.h"

namespace corral {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTo = "-to-";

/// The views of one object.
struct Object {
  std::string name;
  std::vector<std::string> views, files;
};

/// One truth between two views of an object.
struct TruePair {
  int source, target;
  RigidTransform target_from_source;
};

bool is_view_name(const fs::path& path) {
  const std::string stem = path.stem().string(), ending = path.extension().string();
  const bool is_numbered = !stem.empty() && std::isdigit(static_cast<unsigned char>(stem.back()));
  return is_mesh_name(path.string()) || (ending == ".txt" && is_numbered);  // a list of points, not prose
}

/// "T-rex" of "T-rex_view001", "bun" of "bun045".
std::string object_of(const std::string& view) {
  const auto without = [](std::string name, const char* letters) {
    return name.substr(0, name.find_last_not_of(letters) + 1);
  };
  std::string name = without(view, "0123456789");
  const std::string word = "view";
  if (name.size() > word.size() && name.compare(name.size() - word.size(), word.size(), word) == 0)
    name.resize(name.size() - word.size());
  name = without(name, "_-. ");
  return name.empty() ? view : name;
}

std::vector<Object> find_objects(const ImportU3mOptions& options) {
  fs::path folder = options.folder;
  if (fs::is_directory(folder / "views")) folder /= "views";
  if (!fs::is_directory(folder)) throw IoError(folder.string(), "", "no such folder, expected one of views");
  std::set<fs::path> files;  // sorted
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && is_view_name(entry.path())) files.insert(entry.path());
  std::map<std::string, Object> objects;
  std::set<std::string> names;
  for (const fs::path& file : files) {
    const std::string view = view_name(file.string());
    if (!names.insert(view).second)
      throw IoError(file.string(), "", "is a second view of this name, expected one file for each view");
    const std::string name = options.object.empty() ? object_of(view) : options.object;
    Object& object = objects[name];
    object.name = name;
    object.views.push_back(view);
    object.files.push_back(file.string());
  }
  if (objects.empty())
    throw IoError(folder.string(), "", "has no views, expected files such as chef_view001.ply or .txt");
  std::vector<Object> list;
  for (auto& [name, object] : objects) list.push_back(std::move(object));
  return list;
}

/// The transforms of a folder, by the parts of their names before and after "-to-".
std::map<std::pair<std::string, std::string>, std::string> find_truths(const std::string& folder) {
  if (!fs::is_directory(folder)) throw IoError(folder, "", "no such folder, expected one of transforms");
  std::map<std::pair<std::string, std::string>, std::string> truths;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().stem().string();
    const auto middle = name.find(kTo);
    if (entry.path().extension() == ".xf" && middle != std::string::npos)
      truths[{name.substr(0, middle), name.substr(middle + std::string(kTo).size())}] = entry.path().string();
  }
  return truths;
}

/// Published truths of an object: of pairs, and of two views into the same frame.
std::vector<TruePair> published_pairs(const Object& object, const std::string& folder) {
  const auto truths = find_truths(folder);
  std::map<std::string, std::map<int, RigidTransform>> frames;  // by their names: frame from view
  for (const auto& [names, file] : truths) {
    const auto view = std::find(object.views.begin(), object.views.end(), names.first);
    if (view != object.views.end())
      frames[names.second].emplace(static_cast<int>(view - object.views.begin()), read_transform(file));
  }
  std::map<std::pair<int, int>, RigidTransform> pairs;
  for (const auto& [name, from_view] : frames) {
    const auto view = std::find(object.views.begin(), object.views.end(), name);
    for (auto a = from_view.begin(); a != from_view.end(); ++a) {
      if (view != object.views.end()) pairs.insert_or_assign({a->first, int(view - object.views.begin())}, a->second);
      for (auto b = std::next(a); b != from_view.end(); ++b)
        if (view == object.views.end()) pairs.emplace(std::pair(a->first, b->first), b->second.inverse() * a->second);
    }
  }
  std::vector<TruePair> list;
  for (const auto& [ends, truth] : pairs) list.push_back({ends.first, ends.second, truth});
  if (list.empty())
    throw IoError(folder, "", "has no transforms of " + object.name + ", expected <view>-to-<frame>.xf");
  return list;
}

/// Pairs of views that the alignment connects, without those whose own poses all contradict it.
std::vector<TruePair> made_pairs(const Object& object, const AlignedViews& aligned, std::vector<std::string>& doubts) {
  std::map<std::pair<int, int>, bool> is_denied;
  for (const AlignedPair& pair : aligned.pairs) {
    const bool contradicts = pair.judgement.verdict == PairVerdict::Contradicts;
    is_denied.try_emplace({pair.pose.a, pair.pose.b}, true).first->second &= contradicts;
    if (pair.judgement.verdict != PairVerdict::Agrees)
      doubts.push_back(object.views[std::size_t(pair.pose.a)] + " -> " + object.views[std::size_t(pair.pose.b)] + ": " +
                       to_text(pair.judgement.verdict) + ", off by " + fixed(pair.judgement.error_pr, 2) + " pr");
  }
  std::vector<TruePair> list;
  for (int a = 0; a < int(object.views.size()); ++a) {
    if (aligned.part[std::size_t(a)] != 0)
      doubts.push_back(object.views[std::size_t(a)] + ": not connected with all others");
    for (int b = a + 1; b < int(object.views.size()); ++b)
      if (aligned.part[std::size_t(a)] == aligned.part[std::size_t(b)] && !is_denied[{a, b}])
        list.push_back({a, b, aligned.between(a, b)});
  }
  return list;
}

Dataset empty_set(const ImportU3mOptions& options) {
  Dataset dataset;
  dataset.name = "u3m";
  dataset.kind = "registration";
  dataset.provenance = "2.5D views in the layout of the UWA 3D modelling set; ";
  dataset.provenance += options.truth.empty() ? "truth made by aligning them" : "published transforms";
  dataset.licence = "that of the views; UWA: research";
  dataset.citation = {
      "Mian, Bennamoun, Owens: A Novel Representation and Feature Matching Algorithm for Automatic "
      "Pairwise Registration of Range Images, IJCV 2006"};
  dataset.attributes = {"model", "source_view", "target_view", "overlap"};
  return dataset;
}

class Import {
 public:
  Import(const ImportU3mOptions& options, Progress& progress)
      : options_(options), progress_(progress), dataset_(empty_set(options)) {}

  std::vector<std::string> run() {
    const std::vector<Object> objects = find_objects(options_);
    make_folder(options_.output + "/views");
    make_folder(options_.output + "/truth");
    check_writable(options_.output + "/pairs.csv");
    remove_file(options_.output + "/dataset.toml");
    for (const Object& object : objects) add(object);
    if (dataset_.pairs.empty())
      throw IoError(options_.folder, "",
                    "no two views overlap enough, expected pairs with an overlap of " +
                        to_text(100 * options_.least_overlap) + " to " + to_text(100 * options_.most_overlap) + " %");
    write_files({{options_.output + "/pairs.csv", pairs_csv_text(dataset_)},
                 {options_.output + "/dataset.toml", dataset_toml_text(dataset_)}});
    return doubts_;
  }

 private:
  void add(const Object& object) {
    std::vector<Mesh> meshes;
    for (const std::string& file : object.files) meshes.push_back(read_surface(file));
    progress_.begin(object.name);
    const ViewSet views(meshes, options_.sensor, options_.parallel);
    std::vector<TruePair> truths;
    if (options_.truth.empty()) {
      const AlignedViews aligned = align_view_set(
          views, options_.align, options_.parallel,
          [&](const std::string& what, double steps) { progress_.begin(object.name + ": " + what, steps); });
      truths = made_pairs(object, aligned, doubts_);
    } else {
      truths = published_pairs(object, options_.truth);
    }
    keep(object, views, truths);
  }

  void keep(const Object& object, const ViewSet& views, const std::vector<TruePair>& truths) {
    std::vector<double> overlaps(truths.size()), in_front(truths.size());
    options_.parallel(static_cast<int>(truths.size()), [&](int i) {
      const TruePair& pair = truths[std::size_t(i)];
      overlaps[std::size_t(i)] = overlap_share(views.mesh(pair.source).vertices, views.mesh(pair.target).vertices,
                                               pair.target_from_source, kOverlapSharePr * views.resolution());
      in_front[std::size_t(i)] = views.share_in_front(pair.source, pair.target, pair.target_from_source);
    });
    std::vector<FileContent> files;
    for (int view = 0; view < views.size(); ++view)
      files.push_back(
          {options_.output + "/views/" + object.views[std::size_t(view)] + ".ply", ply_text(views.mesh(view))});
    for (std::size_t i = 0; i < truths.size(); ++i) {
      if (!(overlaps[i] >= options_.least_overlap && overlaps[i] <= options_.most_overlap)) continue;
      const std::string &source = object.views[std::size_t(truths[i].source)],
                        &target = object.views[std::size_t(truths[i].target)];
      if (in_front[i] > options_.align.most_in_front) {
        doubts_.push_back(source + " -> " + target + ": the views contradict the truth, " +
                          fixed(100 * in_front[i], 2) + " % of one lie in front of the other");
        if (options_.truth.empty()) continue;
      }
      const std::string name = pair_word(source + "-" + target), truth = "truth/" + name + ".xf";
      files.push_back({options_.output + "/" + truth, transform_text(truths[i].target_from_source)});
      dataset_.pairs.push_back({name,
                                "views/" + source + ".ply",
                                "views/" + target + ".ply",
                                truth,
                                {object.name, source, target, to_text(100 * overlaps[i])}});
    }
    write_files(files);
  }

  const ImportU3mOptions& options_;
  Progress& progress_;
  Dataset dataset_;
  std::vector<std::string> doubts_;
};

}  // namespace

double import_steps(const ImportU3mOptions& options) {
  double steps = 0;
  for (const Object& object : find_objects(options))
    steps += 1 + (options.truth.empty() ? align_steps(static_cast<int>(object.views.size())) : 0);
  return steps;
}

std::vector<std::string> import_u3m(const ImportU3mOptions& options, Progress& progress) {
  return Import(options, progress).run();
}

}  // namespace corral
