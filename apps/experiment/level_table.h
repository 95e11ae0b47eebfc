// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include "apps/experiment/run_folder.h"

namespace corral {

/// One number for each row of a level; NaN where there is none, which every mean passes over.
using RowNumbers = std::vector<double>;

/// What a method made of the rows of a level, each the mean over its repeats. Excluded rows have no number but a time.
struct MethodColumns {
  RowNumbers precision, recall, f1;  ///< 0 where nothing was selected, or the method gave no answer
  RowNumbers nonempty_precision;     ///< none where nothing was selected
  RowNumbers selected, correct;
  RowNumbers success;  ///< 1 if the refined pose has an RMSE of at most 5 pr
  RowNumbers time_ms;  ///< of the grouping alone
  int empty = 0;       ///< rows that count where a repeat selected nothing or gave no answer
};

/// A level of an experiment: a row for each pair (for each size of it that the level has).
struct LevelTable {
  StudyLevel level;
  std::vector<std::string> pairs;  ///< of each row, in the order of the records
  RowNumbers value;                ///< of the swept attribute
  RowNumbers matches, true_matches, inlier_ratio, frame_share;
  std::vector<char> counts;  ///< 1 unless the row is excluded or failed
  int excluded = 0;          ///< too few true matches, for all methods alike
  int failed = 0;            ///< could not be matched or judged: nobody knows its true matches
  std::map<std::string, MethodColumns> methods;

  int counted() const;
};

/// The numbers of an experiment, ready to be averaged. Means, pooled sums and counts are all to be taken from here.
struct ExperimentTable {
  ExperimentInfo info;
  std::vector<LevelTable> levels;
};

constexpr double kSuccessPr = 5;

/// A table for each experiment of the run. Throws IoError if a record names an experiment or level that the manifest lacks.
std::vector<ExperimentTable> experiment_tables(const RunFolder& run);

/// Unweighted mean over the rows (macro), or over rows that were drawn; NaN where there is no number.
double mean_of(const RowNumbers& column);
double mean_of(const RowNumbers& column, const std::vector<int>& rows);
int present_in(const RowNumbers& column);  ///< how many numbers there are
double median_of(RowNumbers values);       ///< likewise

/// Whether a level lies in low .. high, ends included; levels are decimal numbers, so ends may be off by their rounding.
bool is_within(const StudyLevel& level, double low, double high);

/// Pooled over the rows that count (micro): all that is right among all that was selected, or among all true matches.
double pooled_precision(const LevelTable& level, const std::string& method);
double pooled_recall(const LevelTable& level, const std::string& method);

/// For each row, how alike the methods' selections are: the mean Jaccard index over pairs of methods, two empty ones left
/// out. Reads the files of selections that the records name; NaN where there is none (a run may be kept without them).
std::vector<RowNumbers> selection_agreement(const RunFolder& run, const ExperimentTable& table,
                                            const std::vector<std::string>& methods);

}  // namespace corral
