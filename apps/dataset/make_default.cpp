// SPDX-License-Identifier: MIT
#include "apps/dataset/make_default.h"

#include <filesystem>

#include "apps/dataset/make_b3r.h"
#include "apps/dataset/make_u3m.h"
#include "apps/dataset/make_u3or.h"
#include "apps/dataset/recognition_pairs.h"
#include "apps/runtime/embedded_files.h"
#include "io/text/toml_file.h"
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

/// What all makers have in common; `set` names their table in the plan and their folder.
template <class Made>
Made made_set(const MakeDefaultOptions& options, const std::string& set) {
  Made made;
  for (const std::string& name : plan().table(set).value().texts("models"))
    made.models.push_back(package_file(options.meshes, name, "libcgal-demo"));
  made.output = inside(options.output, set);
  made.seed = options.seed;
  made.parallel = options.parallel;
  return made;
}

int planned(const std::string& set, const std::string& count) {
  return static_cast<int>(plan().table(set).value().integer(count).value());
}

MakeB3rOptions retrieval(const MakeDefaultOptions& options) {
  auto made = made_set<MakeB3rOptions>(options, "b3r");
  made.scenes_per_model = planned("b3r", "scenes_per_model");
  return made;
}

MakeU3orOptions recognition(const MakeDefaultOptions& options) {
  auto made = made_set<MakeU3orOptions>(options, "u3or");
  made.scenes = planned("u3or", "scenes");
  return made;
}

MakeU3mOptions registration(const MakeDefaultOptions& options) {
  auto made = made_set<MakeU3mOptions>(options, "u3m");
  made.views = planned("u3m", "views");
  return made;
}

/// The published instances whose files all exist; none without a folder of scenes.
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
  return static_cast<double>(b3r.models.size()) * b3r.scenes_per_model + 3.0 * recognition(options).scenes +
         static_cast<double>(registration(options).models.size()) + static_cast<double>(real_instances(options).size());
}

void make_default(const MakeDefaultOptions& options, Progress& progress) {
  const auto instances = real_instances(options);  // missing files are reported before the work
  make_b3r(retrieval(options), progress);
  make_u3or(recognition(options), progress);
  make_u3m(registration(options), progress);
  if (!instances.empty()) make_real_recognition(instances, options, progress);
}

}  // namespace corral
