// SPDX-License-Identifier: MIT
#pragma once

// A data set of a few small pairs with exact truth, and an experiment on it.

#include <map>
#include <string>
#include <vector>

#include "apps/results/study_folder.h"
#include "apps/study/content_store.h"
#include "io/text/csv_file.h"
#include "kernel/random.h"
#include "kernel/surface/mesh/perturbation.h"
#include "kernel/surface/search/resolution.h"
#include "tests/support/program.h"

namespace corral::testing {

/// The folder data/b3r: two models and three noisy copies of each, every pair with noise_pr, size and model.
inline void put_small_dataset(const Workplace& place) {
  std::filesystem::create_directories(place / "data/b3r");
  place.put("data/b3r/dataset.toml", "name = \"b3r\"\nkind = \"retrieval\"\nresolution = \"source\"\n");
  std::string pairs = "pair,source,target,truth,noise_pr,size,model\n";
  for (const int number : {1, 2}) {
    const std::string model = "m" + std::to_string(number);
    const Mesh mesh = bumpy_sphere(3, static_cast<std::uint64_t>(number));
    write_mesh(place / ("data/b3r/" + model + ".ply"), mesh);
    for (const char* noise : {"0.05", "0.25", "0.45"}) {
      const std::string name = model + "-" + noise;
      const RigidTransform motion = random_motion(mesh, derive_seed(7, name));
      const double deviation = std::stod(noise) * point_resolution(mesh.vertices);
      write_mesh(place / ("data/b3r/" + name + ".ply"),
                 add_gaussian_noise(move_mesh(mesh, motion), deviation, derive_seed(8, name)));
      place.put("data/b3r/" + name + ".txt", transform_text(motion));
      pairs += name + "," + model + ".ply," + name + ".ply," + name + ".txt," + noise + "," +
               std::to_string(10 * number) + "," + model + "\n";
    }
  }
  place.put("data/b3r/pairs.csv", pairs);
}

/// Three levels of noise, all groupers; keypoints without choice, so that there are enough of them.
inline const char* const kSmallExperiment = R"toml(
name = "small"
dataset = "b3r"
attribute = "noise_pr"
levels = [0.05, 0.25, 0.45]
repeats = 2

[matching]
detector = "uniform"

[options.uniform]
spacing_pr = 2.5

[options.shot]
radius_pr = 8
)toml";

/// records.csv without the times, which no two runs share.
inline std::string without_times(const std::string& path) {
  CsvTable table = read_csv(path);
  const auto column = static_cast<std::size_t>(table.column("time_ms"));
  for (auto& row : table.rows) row[column].clear();
  return csv_text(table);
}

/// Everything of a study that does not depend on the clock, by file.
inline std::map<std::string, std::string> lasting_files(const Workplace& place, const std::string& run) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(place / (run + "/selections")))
    if (entry.is_regular_file())
      files[std::filesystem::relative(entry.path(), place / run).string()] = text_of(entry.path().string());
  files["summary.csv"] = place.text(run + "/summary.csv");
  for (const auto& [name, pair] : read_study(place / run).pairs)
    files[name] = std::to_string(*pair.source_points) + " " + std::to_string(*pair.source_keypoints);
  files["records.csv"] = without_times(place / (run + "/records.csv"));
  return files;
}

/// The lines of a text, each with its end.
inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
    lines.push_back(text.substr(at, end - at));
    at = end;
  }
  return lines;
}

inline std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line;
  return text;
}

/// A line of a journal whose hash agrees, whatever is in it.
inline std::string hashed(std::string content) {
  if (!content.empty() && content.back() == '\n') content.pop_back();
  return content_hash(content) + " " + content + "\n";
}

}  // namespace corral::testing
