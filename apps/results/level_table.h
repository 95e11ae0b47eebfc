// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "apps/results/measures.h"
#include "apps/results/study_folder.h"

namespace corral {

/// One number for each row of a level; NaN where there is none, which means ignore.
using RowNumbers = std::vector<double>;

/// What a method made of the rows of a level, each the mean over its repeats, by the name of the measure.
struct MethodColumns {
  std::map<std::string, RowNumbers> numbers;  ///< as counted_number says
  int empty = 0;                              ///< judged rows where a repeat selected nothing
  int failed = 0;  ///< rows where a repeat gave no answer, but for those of excluded and failed pairs
};

/// A level of an experiment: a row for each pair (for each table of it that the level has: one pair may give several).
struct LevelTable {
  StudyLevel level;
  std::vector<std::string> pairs;              ///< of each row, in the order of the records
  std::vector<std::string> scenes;             ///< of each row; empty where the pair belongs to none
  std::vector<std::string> selections;         ///< file below the run's folder, or empty
  std::vector<PairRole> roles;                 ///< of each row, for all methods alike
  RowNumbers value;                            ///< of the swept attribute
  std::map<std::string, RowNumbers> of_pairs;  ///< measures that are the same for every method; of excluded rows too
  std::map<std::string, MethodColumns> methods;

  int count(PairRole role) const;
  /// The column of a measure, of the pairs or else of the method. Null if it is not there.
  const RowNumbers* column(const Measure& measure, const std::string& method) const;
};

/// The numbers of an experiment, ready to be averaged.
struct ExperimentTable {
  ExperimentInfo info;
  std::vector<LevelTable> levels;
};

/// A table for each experiment of the run. Records without a level (pairs that failed where the number of matches is the
/// level) are ignored. Repeats of a grouper on a pair follow one another, from 0, as in records.csv.
/// Throws    IoError if a record names an experiment or level that the manifest lacks.
std::vector<ExperimentTable> experiment_tables(const StudyFolder& run);

/// Adds the names of the measures of kIfTried that some of these records have.
void add_tried(const std::vector<StudyRecord>& records, std::set<std::string>& tried);

/// The table of an experiment, or of some of its levels, from its records in parts, which need not be in memory together. All
/// rows of a pair's table (its groupers and their repeats) are in one part; in any other way the parts give what the whole
/// gives. `tried`: by all records of the experiment.
class TableBuilder {
 public:
  TableBuilder(ExperimentInfo info, std::set<std::string> tried);
  void add(std::vector<StudyRecord> records);  ///< throws IoError as experiment_tables
  ExperimentTable table() &&;

 private:
  ExperimentTable table_;
  std::set<std::string> tried_;
};

/// Unweighted mean over the rows (macro), or over rows that were drawn; NaN where there is no number.
double mean_of(const RowNumbers& column);
double mean_of(const RowNumbers& column, const std::vector<int>& rows);
int present_in(const RowNumbers& column);                     ///< how many numbers there are
double median_of(RowNumbers values);                          ///< likewise
double quantile_of_present(RowNumbers values, double share);  ///< likewise

/// Whether a level lies in low .. high, ends included; levels are decimal numbers, so ends may be off by their rounding.
bool is_within(const StudyLevel& level, double low, double high);

/// For each row the agreement of the selections: the mean Jaccard index over pairs of groupers, without pairs of empty
/// selections. Reads the files of selections that the records name; NaN where there is none (a study may lack them).
std::vector<RowNumbers> selection_agreement(const StudyFolder& run, const ExperimentTable& table,
                                            const std::vector<std::string>& methods);

}  // namespace corral
