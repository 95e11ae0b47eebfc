// SPDX-License-Identifier: MIT
#include "apps/pair/load_pair.h"

#include "apps/pair/match_pair.h"
#include "apps/pair/read_surface.h"
#include "io/matches/matches_file.h"
#include "io/pose/transform_file.h"

namespace corral {
namespace {

constexpr double kThresholdPr = 4;

}  // namespace

std::optional<RegisteredSurfaces> LoadedPair::surfaces() const {
  if (!meshes) return std::nullopt;
  return meshes->surfaces();
}

LoadedPair load_pair(const Dataset& dataset, const DatasetPair& given, MatchSettings settings) {
  const DatasetPair pair = dataset.with_paths(given);
  LoadedPair loaded;
  loaded.name = pair.name;
  if (pair.has_surfaces()) loaded.meshes = {read_surface(pair.source), read_surface(pair.target)};
  if (pair.matches.empty()) {
    settings.resolution = dataset.resolution;
    loaded.matches = match_pair(loaded.meshes->source, loaded.meshes->target, settings).matches;
  } else {
    loaded.matches = read_matches(pair.matches);
  }
  if (pair.truth.empty()) return loaded;
  const RigidTransform pose = read_transform(pair.truth);
  loaded.truth = loaded.meshes ? pair_truth(loaded.meshes->source, loaded.meshes->target, pose,
                                            loaded.matches.resolution, kThresholdPr)
                               : table_truth(loaded.matches, pose, kThresholdPr);
  for (const std::string& equal : pair.equal_truths) loaded.truth->equals.push_back(read_transform(equal));
  return loaded;
}

std::string group_of(const Dataset& dataset, const DatasetPair& pair) {
  for (const char* column : {"object", "model", "scene"}) {
    const std::string text = attribute_text(dataset, pair, column);
    if (!text.empty()) return text;
  }
  return pair.name;
}

}  // namespace corral
