// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/results/study_results.h"
#include "apps/study/study.h"
#include "apps/study/work_list.h"
#include "kernel/correspondence_set.h"

namespace corral {

/// Times the groupers of the only experiment of the list, which sweeps table_size, and writes a study folder with records.csv
/// and time.csv. Everything runs in the calling thread, the repeats of the groupers in turn, each after a call to warm up. A
/// call that takes less than a millisecond is repeated 100 times for one time. Tables are rows drawn from the matches of the
/// first pairs that have enough of them, else of those that have most; a size that none has is left out.
/// Throws    IoError as run_study does, or if no pair has a table of any of the sizes.
std::vector<TimeRow> run_time_study(const WorkList& list, const StudySettings& settings,
                                    const std::function<void(const std::string& what)>& observer);

/// `count` rows of a table, drawn without replacement, in their order.
CorrespondenceSet draw_rows(const CorrespondenceSet& matches, int count, std::uint64_t seed);

}  // namespace corral
