// SPDX-License-Identifier: MIT
#include "apps/dataset/pair_sweep.h"

#include <algorithm>
#include <map>
#include <memory>
#include <string_view>
#include <vector>

#include "io/pose/transform_file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

/// Number of pairs whose meshes are in memory at once: enough to keep the threads busy.
constexpr int kBlock = 16;

template <class Number>
std::string_view bytes_of(const Number* numbers, Eigen::Index count) {
  return {reinterpret_cast<const char*>(numbers), static_cast<std::size_t>(count) * sizeof(Number)};
}

SweptSurface load(const std::string& path) {
  SweptSurface surface;
  try {
    surface.mesh = read_mesh(path);
    surface.spacing = point_spacing(surface.mesh.vertices);
    surface.resolution = surface.spacing.resolution;
    surface.tree.emplace(surface.mesh.vertices);
    const std::hash<std::string_view> hash;
    surface.content = hash(bytes_of(surface.mesh.vertices.data(), surface.mesh.vertices.size())) * 31 +
                      hash(bytes_of(surface.mesh.triangles.data(), surface.mesh.triangles.size()));
  } catch (const IoError& error) {
    surface.problem = without_path(error.what(), path);
  } catch (const InvalidInput&) {
    surface.problem = "has fewer than two distinct vertices, expected a surface";
  }
  return surface;
}

SweptPair complete(const Dataset& dataset, const DatasetPair& pair, const SweptSurface& source,
                   const SweptSurface& target) {
  SweptPair swept{pair, source, target, std::nullopt, "", {}};
  std::string path = dataset.path(pair.truth);
  try {
    if (pair.truth.empty()) return swept;
    StoredTransform truth = read_transform(path);
    swept.truth_notes = std::move(truth.notes);
    swept.truth = truth;
    for (const std::string& equal : pair.equal_truths) {
      path = dataset.path(equal);
      read_transform(path);
    }
  } catch (const IoError& error) {
    swept.truth_problem = without_path(error.what(), split_transform_name(path).file);
  }
  return swept;
}

}  // namespace

void sweep_pairs(const Dataset& dataset, const ParallelFor& parallel, Progress& progress,
                 const std::function<void(int, const SweptPair&)>& visit) {
  const auto count = static_cast<int>(dataset.pairs.size());
  const auto pair = [&](int i) -> const DatasetPair& { return dataset.pairs[static_cast<std::size_t>(i)]; };
  std::map<std::string, int> last_use;
  for (int i = 0; i < count; ++i) last_use[pair(i).source] = last_use[pair(i).target] = i;
  std::map<std::string, SweptSurface> surfaces;
  for (int begin = 0; begin < count; begin += kBlock) {
    const int end = std::min(begin + kBlock, count);
    progress.begin("pair " + std::to_string(begin + 1) + " of " + std::to_string(count), end - begin);
    std::vector<std::pair<const std::string*, SweptSurface*>> missing;
    for (int i = begin; i < end; ++i)
      for (const std::string& file : {pair(i).source, pair(i).target}) {
        const auto [place, is_new] = surfaces.try_emplace(file);
        if (is_new && !file.empty()) missing.emplace_back(&place->first, &place->second);
      }
    parallel(static_cast<int>(missing.size()), [&](int i) {
      const auto& [file, surface] = missing[static_cast<std::size_t>(i)];
      *surface = load(dataset.path(*file));
    });
    parallel(end - begin, [&](int i) {
      const DatasetPair& each = pair(begin + i);
      visit(begin + i, complete(dataset, each, surfaces.at(each.source), surfaces.at(each.target)));
    });
    for (auto it = surfaces.begin(); it != surfaces.end();)
      it = last_use.at(it->first) < end ? surfaces.erase(it) : std::next(it);
  }
}

std::string without_path(const std::string& message, const std::string& path) {
  return message.rfind(path, 0) == 0 ? message.substr(path.size() + 2) : message;
}

double pair_resolution(const Dataset& dataset, double source, double target) {
  if (dataset.resolution == "source") return source;
  if (dataset.resolution == "target") return target;
  if (dataset.resolution == "mean") return (source + target) / 2;
  return parse_double(dataset.resolution).value();
}

}  // namespace corral
