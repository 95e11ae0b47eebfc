// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "apps/results/study_record.h"
#include "apps/study/evaluate_unit.h"
#include "apps/study/work_list.h"

namespace corral {

/// The rows of records.csv from the results of all units: by experiment, level, unit, grouper and repeat, oracle and baseline
/// last. A pair that failed has a row for each of them with its cause. Tables whose size is at no level are left out.
std::vector<StudyRecord> assemble_records(const WorkList& list, const std::vector<UnitResult>& results);

/// As the file records.csv.
std::string records_text(const std::vector<StudyRecord>& records);

}  // namespace corral
