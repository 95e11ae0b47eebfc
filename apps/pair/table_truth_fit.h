// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "kernel/correspondence_set.h"
#include "kernel/rigid_transform.h"

namespace corral {

/// Whether a truth can belong to a table of matches without surfaces, by how many matches it makes correct.
struct TableTruthFit {
  std::string
      name;  ///< as TruthFit::name: "fits", or what fits instead; empty where too few matches are correct to tell
  std::string text;  ///< for a message; empty if it fits
};

/// A truth fits if it makes at least 3 matches correct (4 pr), and its inverse, its transposed rotation and its translation in
/// other units do not make 10 or more, and five times as many, correct.
TableTruthFit fit_truth(const CorrespondenceSet& matches, const RigidTransform& target_from_source);

}  // namespace corral
