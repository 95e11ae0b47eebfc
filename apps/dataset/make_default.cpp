// SPDX-License-Identifier: MIT
#include "apps/dataset/make_default.h"

#include <filesystem>

#include "apps/dataset/make_b3r.h"
#include "apps/dataset/recognition_pairs.h"
#include "apps/embedded_files.h"
#include "io/toml_file.h"
#include "kernel/error.h"

namespace corral {

const EmbeddedFiles& embedded_data();

namespace {

namespace fs = std::filesystem;

TomlTable plan() { return TomlTable::parse("data/default.toml", embedded_data().at("default.toml")); }

std::string inside(const std::string& folder, const std::string& name) { return (fs::path(folder) / name).string(); }

/// Where a file of a package must be.
std::string package_file(const std::string& folder, const std::string& name, const std::string& package) {
  const std::string path = inside(folder, name);
  if (!fs::exists(path)) throw IoError(path, "", "does not exist, expected it from Debian's package " + package);
  return path;
}

MakeB3rOptions retrieval(const MakeDefaultOptions& options) {
  const TomlTable table = plan().table("b3r").value();
  MakeB3rOptions made;
  for (const std::string& name : table.texts("models"))
    made.models.push_back(package_file(options.meshes, name, "libcgal-demo"));
  made.output = inside(options.output, "b3r");
  made.seed = options.seed;
  made.scenes_per_model = static_cast<int>(table.integer("scenes_per_model").value());
  made.parallel = options.parallel;
  return made;
}

/// The published instances, all files of which are there; none without a folder of scenes.
std::vector<PublishedInstance> real_instances(const MakeDefaultOptions& options) {
  std::vector<PublishedInstance> instances;
  if (options.scenes.empty()) return instances;
  for (const TomlTable& each : plan().tables("u3or-real")) {
    const auto text = [&](const char* key) { return each.text(key).value(); };
    const auto file = [&](const char* key) { return package_file(options.scenes, text(key), "opencv-doc"); };
    instances.push_back({text("model"), text("scene"), file("model_file"), file("scene_file"),
                         embedded_data().at(text("truth")), each.scalar_text("occlusion").value()});
  }
  return instances;
}

void make_real_recognition(const std::vector<PublishedInstance>& instances, const MakeDefaultOptions& options,
                           Progress& progress) {
  Dataset dataset = uwa_recognition_set("u3or-real");
  dataset.folder = inside(options.output, dataset.name);
  const SetFolder folder(dataset.folder, "make default, real scenes\nscenes " +
                                             fs::absolute(options.scenes).lexically_normal().string() + "\n");
  add_recognition_pairs(instances, folder, dataset, options.parallel, progress);
  folder.finish(dataset);
}

}  // namespace

double default_steps(const MakeDefaultOptions& options) {
  const MakeB3rOptions b3r = retrieval(options);
  return static_cast<double>(b3r.models.size()) * b3r.scenes_per_model +
         static_cast<double>(real_instances(options).size());
}

void make_default(const MakeDefaultOptions& options, Progress& progress) {
  const auto instances = real_instances(options);  // what is missing is said before the work
  make_b3r(retrieval(options), progress);
  if (!instances.empty()) make_real_recognition(instances, options, progress);
}

}  // namespace corral
