// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/runtime/progress.h"
#include "io/dataset_file.h"
#include "kernel/parallel.h"

namespace corral {

/// Something wrong with a data set.
struct Finding {
  std::string pair;     ///< the first that it concerns
  std::string file;     ///< as it stands in pairs.csv; empty if it is the pair itself
  std::string problem;  ///< a sentence without its full stop
};

/// Looks at every file of every pair. Found are
///
///   files      that are missing, cannot be read, or hold no surface; truths that are no rigid motion
///   units      sides whose sizes differ as 10, 100 or 1000 to 1, in extent and resolution alike; translations of a truth
///              that fit once they are in other units
///   truths     that fit better inverted, or neither way (Coincidence)
///   pr         out of line: more than 8 times the usual part of the mesh's diagonal on its side of the set, or less
///   pairs      of the same surfaces under the same truth as an earlier one, whatever the files are called
///
/// in the order of the pairs. Each file is named once.
std::vector<Finding> check_dataset(const Dataset& dataset, const ParallelFor& parallel, Progress& progress);

}  // namespace corral
