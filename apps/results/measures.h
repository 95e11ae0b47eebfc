// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/results/study_record.h"

namespace corral {

/// What a mean over pairs takes for a number that a judged pair lacks. (Of a pair that is not judged it is left out.)
enum class Absent { Zero, LeftOut, Infinite };

/// What of the pairs of a level stands in summary.csv. Pooled: the sum of one measure over the sum of another. Scenes: the mean
/// over scenes of the mean over the pairs of each; pairs without a scene are left out.
enum class Average { None, Mean, Median, Quantile75, Quantile95, Pooled, Scenes };

enum class Better { Larger, Smaller };

/// Where a number stands in a record; nowhere if it is worked out.
struct Stored {
  std::optional<int> StudyRecord::*count = nullptr;
  OptionalNumber StudyRecord::*number = nullptr;
  PoseScores StudyRecord::*pose = nullptr;
  OptionalNumber PoseScores::*score = nullptr;  ///< of the pose

  bool is_anywhere() const { return count || number || pose; }
};

/// A number of a record, and all that the program knows of it. The flags say where else it appears.
struct Measure {
  std::string name;   ///< column of records.csv and summary.csv, key in JSON
  std::string title;  ///< a word or two for headers, such as "F1"
  std::string unit;   ///< "pr", "deg", "ms"; empty for shares and counts
  int decimals;       ///< for people
  double largest;     ///< values are from 0 to this
  Better better;
  Stored stored;
  std::optional<double> (*derived)(const StudyRecord& record);  ///< if it is not stored
  Absent absent;
  Average average;
  unsigned flags = 0;
  std::string axis = {};                               ///< more words for figures; else the title
  std::pair<std::string, std::string> pooled_of = {};  ///< of Average::Pooled

  std::optional<double> of(const StudyRecord& record) const;
  bool has(unsigned flag) const { return (flags & flag) != 0; }
  std::string word() const;  ///< the title in small letters: on command lines and in the rules of claims
  const std::string& axis_title() const { return axis.empty() ? title : axis; }
};

constexpr unsigned kHeadline = 1;    ///< has an interval in the summary, and what groupers are compared by
constexpr unsigned kFigure = 2;      ///< a panel over the levels
constexpr unsigned kWithBounds = 4;  ///< there the oracle and the baseline say something
constexpr unsigned kOnPage = 8;      ///< a column of the page's table of records
constexpr unsigned kOfPair = 16;     ///< the same whatever the method
constexpr unsigned kEveryPair = 32;  ///< of excluded pairs too
constexpr unsigned kYesOrNo = 64;    ///< 0 or 1
constexpr unsigned kIfTried = 128;   ///< absent of an experiment that has none at all

/// The one table of measures, in the order of the columns of records.csv and of summary.csv. Everything that shows, averages
/// or compares a measure goes by it: a new one is a new entry (and, if a record is to store it, a member of StudyRecord).
const std::vector<Measure>& measures();
std::vector<const Measure*> measures_with(unsigned flag);

/// By name. Throws InvalidInput for one that is not there.
const Measure& measure(const std::string& name);

/// A measure of a pose: one behind the name of each stage stands in the table.
struct PoseMeasure {
  const char *name, *title, *unit;
  OptionalNumber PoseScores::*score;
  bool is_summed;   ///< of the refined pose: in the summary and on the page
  bool is_on_page;  ///< of the others too
};
const std::vector<PoseMeasure>& pose_measures();

/// What a pair is to the means of an experiment: of every record of the pair the same.
enum class PairRole {
  Judged,    ///< counts
  Unjudged,  ///< excluded because it has no truth: only what needs none counts
  Excluded,  ///< has fewer correct matches than the experiment asks for, or none at all
  Misfit,    ///< its truth cannot belong to it (TruthFit::belongs)
  Failed,    ///< could not be matched
};

/// The one place where it is decided.
PairRole role_of(const StudyRecord& record, int least_true_matches);

/// Whether a pair counts as excluded in tables: what is judged leaves it out, for all groupers alike.
inline bool is_excluded(PairRole role) { return role == PairRole::Excluded || role == PairRole::Unjudged; }

/// What the mean over pairs takes for a measure of a record; NaN if it is left out.
double counted_number(const Measure& measure, const StudyRecord& record, PairRole role);

}  // namespace corral
