// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/study/finished_units.h"
#include "apps/study/study.h"

namespace corral {

/// Whether the pair, or a grouper on it, failed.
bool has_failed(const UnitResult& result);

/// What there is to tell of these units, which are finished.
StudyOutcome outcome_of(const WorkList& list, const FinishedUnits& finished, const std::vector<std::size_t>& units);

/// Writes records.csv, summary.csv and manifest.json from the results of all units.
StudyOutcome finish_study(const WorkList& list, const FinishedUnits& finished, const std::string& folder,
                          const std::string& command_line);

}  // namespace corral
