// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/study/specification.h"
#include "io/dataset_file.h"

namespace corral {

/// One call of one grouper: its options with the seed of this very call.
struct GroupingTask {
  std::string method;
  OptionOverrides options;
  int repeat = 0;

  bool operator==(const GroupingTask& other) const {
    return method == other.method && options == other.options && repeat == other.repeat;
  }
};

/// One pair with one way to match it: the piece of work that is done at a time. It serves every experiment that needs it, and
/// what it answers depends on its files and on what stands here alone.
struct WorkUnit {
  std::string dataset;
  DatasetPair pair;                   ///< paths from where the program runs
  MatchSettings matching;             ///< with one thread
  std::vector<GroupingTask> tasks;    ///< each once
  std::vector<double> thresholds_pr;  ///< at which the answers are scored, ascending
  bool dense = false;
  bool shares_source = false, shares_target = false;   ///< another unit describes that mesh in the same way
  std::map<std::string, std::vector<int>> selections;  ///< file below the run's folder -> tasks that it shows
};

/// A place of an experiment that a unit fills: all methods on one pair at one level.
struct StudySample {
  int experiment = 0, unit = 0;
  int level = -1;               ///< -1: the number of matches will say (or is the level)
  std::optional<double> value;  ///< of the swept attribute, if it is known beforehand
  double threshold_pr = 4;
  std::string selection;
  std::vector<int> tasks;  ///< of the unit: the methods in order, and of each its repeats
};

struct WorkList {
  std::vector<Experiment> experiments;  ///< by name, each once; `info.dataset` as the set calls itself
  std::vector<WorkUnit> units;          ///< by data set, pair and settings
  std::vector<StudySample> samples;     ///< by experiment, level and unit
};

/// The work of experiments: a pure function of them and of the manifests. A folder that is itself a data set serves every
/// experiment; else each finds its own in a folder of its name below.
/// Throws    IoError: no such data set, a cell that is no number, two experiments of one name, no pair at all for one.
WorkList make_work_list(std::vector<Experiment> experiments, const std::string& data_folder);

/// The level that holds a value: equal to rounding, or in the interval (half open, the last one closed); -1 if none does.
int level_of(const std::vector<StudyLevel>& levels, double value);

/// What the answer of a unit depends on beside its files, as text.
std::string unit_text(const WorkUnit& unit);
std::string matching_text(const MatchSettings& matching);

}  // namespace corral
