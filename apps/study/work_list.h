// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/pair/external_method.h"
#include "apps/pair/foreign_answer.h"
#include "apps/study/specification.h"
#include "io/pairs/dataset_file.h"

namespace corral {

/// One call of one grouper: its options with the seed of this call. Or the answer of another program.
struct GroupingTask {
  std::string method;
  OptionOverrides options;
  int repeat = 0;
  std::shared_ptr<const ForeignAnswer> answer = {};     ///< of another program, in files; null for a grouper
  std::shared_ptr<const ExternalMethod> external = {};  ///< another program, to be called; null for a grouper

  /// The answers of another program, the program itself, or the library of a plug-in; none of a grouper.
  std::vector<std::string> foreign_files() const;

  bool operator==(const GroupingTask& other) const {
    return method == other.method && options == other.options && repeat == other.repeat;
  }
};

/// One pair matched in one way: the unit of work. It serves every experiment that needs it, and its result depends only on
/// its files and on these fields.
struct WorkUnit {
  std::string dataset;
  DatasetPair pair;                   ///< paths from the working directory
  MatchSettings matching;             ///< with one thread
  std::vector<GroupingTask> tasks;    ///< each once
  std::vector<double> thresholds_pr;  ///< at which the selections are scored, ascending
  bool dense = false;
  bool is_in_metres = false;                           ///< the data set says so
  bool shares_source = false, shares_target = false;   ///< another unit describes that mesh in the same way
  std::map<std::string, std::vector<int>> selections;  ///< file in the study folder -> tasks whose selections it holds
  bool all_rows = false, by_surface = false, confidence = false;  ///< as of Experiment
  std::string scene = {};                                         ///< scene_of the pair
  StudyExtent extent = StudyExtent::Scores;                       ///< the furthest of its experiments

  /// Those of the pair, then those of the answers of other programs and of the programs themselves.
  std::vector<std::string> files() const;
};

/// A sample of an experiment that a unit provides: all groupers on one pair at one level.
struct StudySample {
  int experiment = 0, unit = 0;
  int level = -1;               ///< -1: determined later by the number of matches
  std::optional<double> value;  ///< of the swept attribute, if it is known beforehand
  double threshold_pr = 4;
  std::string selection;   ///< file in the study folder; empty where none is kept
  std::vector<int> tasks;  ///< of the unit: the methods in order, and of each its repeats
};

struct WorkList {
  std::vector<Experiment> experiments;  ///< by name, each once; `info.dataset` is the name in the set's manifest
  std::vector<WorkUnit> units;          ///< by data set, pair and settings
  std::vector<StudySample> samples;     ///< by experiment, level and unit
};

/// The work of experiments: a pure function of them and of the manifests. A folder that is itself a data set serves every
/// experiment; else each uses the subfolder with the name of its set.
/// Throws    IoError: no such data set, a cell that is no number, two experiments of one name, no pair at all for one.
WorkList make_work_list(std::vector<Experiment> experiments, const std::string& data_folder);

/// The level that holds a value: equal to rounding, or in the interval (half open, the last one closed); -1 if none does.
int level_of(const std::vector<StudyLevel>& levels, double value);

/// What the result of a unit depends on besides its files, as text.
std::string unit_text(const WorkUnit& unit);
std::string matching_text(const MatchSettings& matching);

}  // namespace corral
