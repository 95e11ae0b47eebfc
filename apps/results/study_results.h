// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/results/summary.h"

namespace corral {

/// Times of one method on tables of one size.
struct TimeRow {
  std::string experiment, dataset, level, method;
  int runs = 0;  ///< timed, over all tables
  double median_ms = 0, mean_ms = 0, lower_quartile_ms = 0, upper_quartile_ms = 0;
};

/// Whether an experiment only takes times: it sweeps the size of the table.
bool is_of_times(const ExperimentInfo& info);

/// The times of such an experiment, by level and method; those without any are left out.
std::vector<TimeRow> time_rows(const ExperimentInfo& info, const std::vector<StudyRecord>& records);
std::string time_text(const std::vector<TimeRow>& rows);  ///< as the file time.csv

/// What is worked out of a run's records, once. The run must outlive it.
struct StudyResults {
  const StudyFolder* run = nullptr;
  std::vector<ExperimentTable> tables;  ///< of each experiment
  std::vector<SummaryRow> summary;
};
std::vector<StudyResults> results_of(const std::vector<StudyFolder>& runs,
                                     const ParallelFor& parallel_for = one_by_one);
std::vector<StudyResults> results_of(std::vector<StudyFolder>&& runs, const ParallelFor& = one_by_one) = delete;
/// The same without the summary, whose intervals take most of the time.
std::vector<StudyResults> tables_of(const std::vector<StudyFolder>& runs);

/// Throws IoError as read_study.
std::vector<StudyFolder> read_runs(const std::vector<std::string>& folders);

/// Keeps the methods whose names begin with the prefix, and drops it from their names. Throws InvalidInput if there are none.
void keep_methods_named(const std::string& prefix, std::vector<StudyFolder>& runs);

}  // namespace corral
