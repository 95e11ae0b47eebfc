// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include "apps/results/run_folder.h"

namespace corral {

/// One number for each row of a level; NaN where there is none, which every mean passes over.
using RowNumbers = std::vector<double>;

/// What a method made of the rows of a level, each the mean over its repeats. Rows that do not count have no number but a
/// time. Errors are infinite where there is no pose (in any repeat): for medians, which take it for the worst.
struct MethodColumns {
  RowNumbers precision, recall, f1;  ///< 0 where nothing was selected, or the method gave no answer
  RowNumbers nonempty_precision;     ///< none where nothing was selected
  RowNumbers selected, correct;      ///< 0 where the method gave no answer
  RowNumbers success;                ///< 1 if the refined pose has a mean error of at most 5 pr; no pose has not
  RowNumbers initial_success;        ///< the same of the pose before the refinement
  RowNumbers dense_success;          ///< and of the dense one; none unless the experiment has dense poses
  RowNumbers success_area;           ///< under the curve of success of the refined pose, 0 .. 5 pr
  RowNumbers rotation_error_deg, translation_error_pr, mean_error_pr;  ///< refined
  RowNumbers time_ms;                                                  ///< of the grouping alone
  int empty = 0;   ///< rows that count where a repeat selected nothing
  int failed = 0;  ///< rows that count where a repeat gave no answer
};

/// A level of an experiment: a row for each pair (for each table of it that the level has: one pair may give several).
struct LevelTable {
  StudyLevel level;
  std::vector<std::string> pairs;                               ///< of each row, in the order of the records
  std::vector<std::string> selections;                          ///< file below the run's folder, or empty
  RowNumbers value;                                             ///< of the swept attribute
  RowNumbers matches, true_matches, inlier_ratio, frame_share;  ///< of excluded rows too
  std::vector<char> counts;                                     ///< 1 unless the row is excluded or failed
  int excluded = 0;  ///< too few true matches, or no truth to know them by; for all methods alike
  int failed = 0;    ///< pairs that could not be matched
  std::map<std::string, MethodColumns> methods;

  int counted() const;
};

/// The numbers of an experiment, ready to be averaged. Means, pooled sums and counts are all to be taken from here.
struct ExperimentTable {
  ExperimentInfo info;
  std::vector<LevelTable> levels;
};

/// A table for each experiment of the run. Records without a level (pairs that failed where the number of matches is the
/// level) are passed over. Repeats of a method on a pair stand one behind the other, from 0, as in records.csv.
/// Throws    IoError if a record names an experiment or level that the manifest lacks.
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
