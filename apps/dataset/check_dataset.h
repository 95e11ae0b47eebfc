// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/runtime/progress.h"
#include "io/pairs/dataset_file.h"
#include "kernel/parallel.h"

namespace corral {

/// Something wrong with a data set.
struct Finding {
  std::string pair;      ///< the first that it concerns
  std::string file;      ///< as written in pairs.csv; empty if the pair itself is wrong
  std::string problem;   ///< a sentence without its full stop
  bool is_error = true;  ///< false: worth knowing, but nothing to mend
};

/// Reads every file of every pair and reports
///
///   files      that are missing, cannot be read, or hold no surface; truths that are not rigid motions
///   units      sides whose sizes differ by a factor of 10, 100 or 1000, in extent and resolution alike; truths whose
///              translation fits in other units
///   tables     of matches that cannot be read, or of which hardly any is correct
///   truths     that do not fit, and what would; those that fit loosely are no error (TruthFit)
///   vertices   that make pr or coordinates useless (surface_warnings)
///   pr         that is unusual: more than 8 times the usual share of the mesh's diagonal on its side of the set, or less
///              than an eighth
///   pairs      of the same surfaces under the same truth as an earlier one, whatever the names of the files
///
/// in the order of the pairs. Each file is reported once.
std::vector<Finding> check_dataset(const Dataset& dataset, const ParallelFor& parallel, Progress& progress);

}  // namespace corral
