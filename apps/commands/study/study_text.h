// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/study/study.h"

namespace corral {

/// A table for the terminal: each grouper in each experiment, by its means over the levels.
std::string overview_text(const std::vector<SummaryRow>& rows);

/// Where the pairs of each grouper in each experiment were lost, over all levels; for scripts, at each level.
std::string explanation_text(const std::vector<LossRow>& rows);
Json explanation_json(const std::vector<LossRow>& rows);

/// The counts and warnings of a study, for scripts.
Json study_json(const std::string& folder, const StudyOutcome& outcome);

/// "463 pairs, 2 failed (records.csv says why)".
std::string counts_text(const StudyOutcome& outcome);

/// "90 s", "3 min", "2.5 h".
std::string duration(double seconds);

/// "3 of 10 pairs done, 0 failed"; as the first of a call with what the others are expected to take, from 10 s on.
std::string progress_text(const StudyProgress& now, bool is_first);

/// Warns on stderr of data that make results wrong, the first few of each kind.
void say_study(const StudyOutcome& outcome);

}  // namespace corral
