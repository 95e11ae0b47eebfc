// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "apps/report/page_scenes.h"
#include "apps/results/study_folder.h"

namespace corral {

/// The records that a page carries, of each run in their order.
using PageRecords = std::vector<std::vector<const StudyRecord*>>;

/// All records, or at most so many of them: a pair at a level with all of its groupers, or not at all. First the scenes (each
/// at the first level where it occurs); then, level by level in turn, a pair that failed or whose truth does not fit and a
/// pair of the others, each drawn at random. The same runs give the same records.
PageRecords sample_records(const std::vector<StudyFolder>& runs, const std::vector<SceneChoice>& scenes,
                           std::size_t most);

}  // namespace corral
