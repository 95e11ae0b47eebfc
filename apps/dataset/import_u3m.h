// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/align/align_view_set.h"
#include "apps/runtime/progress.h"
#include "kernel/parallel.h"

namespace corral {

struct ImportU3mOptions {
  std::string folder;  ///< the views, here or in views/: meshes or lists of points (.txt, .xyz), <object>_view<number>
  std::string output;  ///< folder of the set
  std::string truth;   ///< folder of published transforms; empty: the truth is computed by aligning the views
  std::string object;  ///< the object that all views show; empty: their names without the final number
  std::optional<ViewOptions> sensor;  ///< of every view; else that of view_side for each
  AlignOptions align;
  double least_overlap = 0.3, most_overlap = 0.9;  ///< of the pairs that are kept
  ParallelFor parallel = one_by_one;
};

/// The approximate number of progress steps.
double import_steps(const ImportU3mOptions& options);

/// Views of objects as a data set for registration [mian2006novel]: views/<view>.ply with faces, truth/<pair>.xf, and
/// pairs.csv with the attributes model, source_view, target_view and overlap (percent, overlap_share within 2 pr).
///
/// A computed truth is that of align_view_set, for each object. A pair is left out if its own pose contradicts the others or
/// its views contradict its truth. Published transforms are <view>-to-<anything>.xf into one frame for all views of an
/// object, or <view>-to-<view>.xf for pairs.
/// Returns   what should be inspected, one line each: pairs whose pose contradicts the others or is confirmed by none, views
///           that are not connected with the rest, truths that the views contradict.
/// Throws    IoError: no views, two of one name, no pair that is kept, a truth that cannot be read. The manifest is written
///           last, so that an unfinished set has none.
std::vector<std::string> import_u3m(const ImportU3mOptions& options, Progress& progress);

}  // namespace corral
