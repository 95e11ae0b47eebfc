// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/pair/match_pair.h"
#include "apps/results/run_folder.h"
#include "kernel/options.h"

namespace corral {

/// Only pairs whose attribute is one of these take part; "" is an empty cell, numbers are compared as numbers.
struct AttributeFilter {
  std::string attribute;
  std::vector<std::string> accepted;
};

/// What the levels of an experiment are levels of.
enum class Sweep {
  Column,          ///< a column of pairs.csv: each level has pairs of its own
  Threshold,       ///< threshold_pr: the same answers, scored anew
  Matches,         ///< matches: how many there turned out to be, over several keypoint radii
  KeypointRadius,  ///< keypoint_radius_pr
  Option,          ///< method.option
  TableSize,       ///< table_size: the time of groupers on tables of so many rows
};

/// One experiment: a file such as paper/experiments/noise.toml, whose keys paper/README.md explains.
struct Experiment {
  ExperimentInfo info;
  Sweep sweep = Sweep::Column;
  std::vector<AttributeFilter> filters;
  MatchSettings matching;                          ///< its resolution holds if `resolution` is given
  std::optional<std::string> resolution;           ///< else that of the data set
  std::vector<double> keypoint_radii_pr;           ///< of Sweep::Matches
  std::map<std::string, OptionOverrides> options;  ///< by method, beside the defaults (the paper's)
  int repeats = 1;                                 ///< of methods that draw; of all methods for times
  std::uint64_t seed = 1;
  bool dense = false;  ///< lay the surfaces on each other too
  int tables = 1;      ///< of Sweep::TableSize: pairs whose tables are timed
};

/// Reads an experiment: a file, or the name of one that the program carries (see built_in_experiments). Throws IoError naming
/// file, line and key; an unknown key or name comes with the nearest one.
Experiment read_experiment(const std::string& name_or_path);
/// The same of text that is in memory; `path` is for the messages.
Experiment parse_experiment(const std::string& path, const std::string& text);

/// The names of the experiments of paper/experiments/, sorted.
std::vector<std::string> built_in_experiments();

/// The options that a method runs with in the experiment at a level, seeds left out.
OptionOverrides method_options(const Experiment& experiment, const std::string& method, const StudyLevel& level);

/// "[65,70)" for an interval, "[90,95]" for the last.
std::string bin_label(double low, double high, bool is_last);

}  // namespace corral
