// SPDX-License-Identifier: MIT
#include "apps/dataset/import_u3or.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <set>

#include "apps/dataset/recognition_pairs.h"
#include "io/disk/file.h"
#include "io/mesh/mesh_file.h"
#include "io/text/line_reader.h"
#include "kernel/error.h"

namespace corral {
namespace {

namespace fs = std::filesystem;

/// Names in occlusion.txt and those of the truths.
const std::map<std::string, std::string> kModels = {
    {"chef", "chef"}, {"chicken", "chicken"}, {"para", "parasaurolophus"}, {"trex", "T-rex"}};

/// All files below a folder by their names, the first of several in the order of their paths.
std::map<std::string, std::string> files_below(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> paths;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->is_regular_file(error)) paths.push_back(entry->path().string());
  if (error) throw IoError(folder, "", "cannot be read as a folder (" + error.message() + ")");
  std::sort(paths.begin(), paths.end());
  std::map<std::string, std::string> files;
  for (const std::string& path : paths) files.emplace(fs::path(path).filename().string(), path);
  return files;
}

bool begins_with(const std::string& text, const std::string& begin) { return text.rfind(begin, 0) == 0; }

/// The mesh of a model, empty if there is none; several candidates are reported in a note.
std::string find_model(const std::map<std::string, std::string>& files, const std::string& model,
                       std::vector<std::string>& notes) {
  std::string best;
  int candidates = 0;
  for (const auto& [name, path] : files) {
    if (!is_mesh_name(name) || !begins_with(name, model)) continue;
    ++candidates;
    const auto rank = [](const std::string& file) {
      const std::string stem = fs::path(file).stem().string();
      const bool is_whole = stem.size() > 5 && stem.substr(stem.size() - 5) == "_high";
      return std::make_pair(is_whole, fs::file_size(file));
    };
    if (best.empty() || rank(path) > rank(best)) best = path;
  }
  if (best.empty()) notes.push_back("no model " + model);
  if (candidates > 1)
    notes.push_back("model " + model + ": " + fs::path(best).filename().string() + ", the largest of " +
                    std::to_string(candidates));
  return best;
}

std::string find_scene(const std::map<std::string, std::string>& files, int scene) {
  const std::string stem = "rs" + std::to_string(scene);
  for (const auto& [name, path] : files)
    if (is_mesh_name(name) && (fs::path(name).stem() == stem || begins_with(name, stem + "_"))) return path;
  return "";
}

/// rs2, rs5 .. rs9
std::string list(const std::set<int>& scenes) {
  std::string text;
  for (auto scene = scenes.begin(); scene != scenes.end();) {
    const int first = *scene;
    int last = first;
    while (++scene != scenes.end() && *scene == last + 1) ++last;
    text += (text.empty() ? "rs" : ", rs") + std::to_string(first);
    if (last > first) text += " .. rs" + std::to_string(last);
  }
  return text;
}

}  // namespace

std::vector<OcclusionLine> read_occlusion_table(const std::string& path) {
  const std::string text = read_file(path);
  LineReader reader(path, text);
  reader.need("the header 'scene object % occlusion'");
  std::vector<OcclusionLine> lines;
  while (reader.next()) {
    const auto& fields = reader.fields();
    if (fields.size() != 3)
      reader.fail("found " + std::to_string(fields.size()) + " fields, expected scene, object, percent");
    const auto model = kModels.find(std::string(fields[1]));
    if (model == kModels.end())
      reader.fail("the object " + quoted(fields[1]) + ", expected chef, chicken, para or trex");
    const double percent = reader.finite_number(fields[2]);
    if (!(percent >= 0 && percent <= 100)) reader.fail("found " + quoted(fields[2]) + ", expected 0 .. 100 percent");
    lines.push_back(
        {static_cast<int>(reader.integer(fields[0], 1, 9999, "scene")), model->second, std::string(fields[2])});
  }
  return lines;
}

std::vector<std::string> import_u3or(const ImportU3orOptions& options, Progress& progress) {
  const auto files = files_below(options.folder);
  const auto place = [&](const std::string& name) {
    const auto found = files.find(name);
    return found == files.end() ? std::string() : found->second;
  };
  if (place("occlusion.txt").empty())
    throw IoError(options.folder, "", "has no occlusion.txt, expected the list of pairs");
  const std::vector<OcclusionLine> lines = read_occlusion_table(place("occlusion.txt"));
  std::vector<std::string> notes;
  std::map<std::string, std::string> models;
  for (const auto& [word, model] : kModels) models[model] = find_model(files, model, notes);
  std::vector<PublishedInstance> instances;
  std::set<int> no_scene;
  for (const OcclusionLine& line : lines) {
    const std::string scene = "rs" + std::to_string(line.scene), scene_file = find_scene(files, line.scene),
                      truth = line.model + "-" + scene + ".xf";
    if (scene_file.empty()) no_scene.insert(line.scene);
    if (scene_file.empty() || models[line.model].empty()) continue;
    if (place(truth).empty()) {
      notes.push_back("no truth " + truth);
      continue;
    }
    instances.push_back({line.model, scene, models[line.model], scene_file, read_file(place(truth)), line.percent});
  }
  if (!no_scene.empty()) notes.push_back("no scenes " + list(no_scene));
  if (instances.empty()) throw IoError(options.folder, "", "no pair with its model, scene and truth");
  if (instances.size() < lines.size())
    notes.push_back(std::to_string(instances.size()) + " of the " + std::to_string(lines.size()) +
                    " pairs of occlusion.txt are complete");
  const SetFolder folder(options.output,
                         "import u3or\nfolder " + fs::absolute(options.folder).lexically_normal().string() + "\n");
  Dataset dataset = uwa_recognition_set("u3or");
  dataset.folder = options.output;
  add_recognition_pairs(instances, folder, dataset, options.parallel, progress);
  folder.finish(dataset);
  return notes;
}

}  // namespace corral
