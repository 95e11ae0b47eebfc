// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "apps/pair/evaluate_pair.h"
#include "apps/pair/match_settings.h"
#include "apps/pair/register_pair.h"
#include "io/pairs/dataset_file.h"

namespace corral {

/// The two meshes of a pair.
struct PairMeshes {
  Mesh source, target;

  RegisteredSurfaces surfaces() const { return {source, target, {}, {}}; }
};

/// A pair of a data set in memory.
struct LoadedPair {
  std::string name;
  std::optional<PairMeshes> meshes;  ///< absent of a table alone
  CorrespondenceSet matches;         ///< its table, or matched
  std::optional<PairTruth> truth;    ///< of correct matches within 4 pr

  std::optional<RegisteredSurfaces> surfaces() const;
};

/// Reads and matches. The resolution is by the rule of the data set. Throws IoError or InvalidInput.
LoadedPair load_pair(const Dataset& dataset, const DatasetPair& pair, MatchSettings settings = {});

/// What pairs of one object or scene have in common: its `object`, `model` or `scene`; else the name of the pair.
std::string group_of(const Dataset& dataset, const DatasetPair& pair);

}  // namespace corral
