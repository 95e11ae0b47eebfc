// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/results/study_record.h"
#include "apps/study/evaluate_unit.h"
#include "apps/study/work_list.h"

namespace corral {

/// The rows of records.csv of one experiment from the results of all units, in parts of whole pairs at one level, since those of
/// a large study take more memory than it should need: by level (-1 first: of pairs that failed before theirs was known), unit,
/// grouper and repeat, oracle and baseline last. A pair that failed has a row for each of them with its cause. Tables whose size
/// is at no level are left out.
void assemble_records(const WorkList& list, const std::vector<UnitResult>& results, int experiment,
                      const std::function<void(int level, std::vector<StudyRecord>)>& consume);

/// The lines of records in the file records.csv, and of its header.
std::string records_text(const std::vector<StudyRecord>& records);
std::string records_header();

}  // namespace corral
