// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/pair/external_method.h"
#include "apps/pair/match_settings.h"
#include "apps/results/study_folder.h"
#include "kernel/options.h"

namespace corral {

/// The pairs whose attribute, or name ("pair"), is one of these values; "" is an empty cell, numbers are compared as numbers.
struct AttributeFilter {
  std::string attribute;
  std::vector<std::string> values;
};

/// A method of another program. Its answers are in files (an entry of methods.toml: patterns with {pair} and columns of
/// pairs.csv, empty where it gives none), or it is called.
struct ForeignMethod {
  std::string name, title;
  std::string labels, poses, times;
  std::optional<double> time_ms;
  std::shared_ptr<const ExternalMethod> external = {};  ///< then there are no files
};

/// The quantity that an experiment sweeps.
enum class Sweep {
  Column,     ///< a column of pairs.csv: each level has pairs of its own
  Threshold,  ///< threshold_pr: the same selections, scored again
  Matches,    ///< matches: pairs are binned by their number, over the values of a varied option
  Ratio,      ///< inlier_ratio: pairs are binned by the share of correct matches, in percent
  Choice,     ///< a choice of the matching: detector, descriptor, frames or normals
  Option,     ///< name.option of a grouper, detector or descriptor
  TableSize,  ///< table_size: the time of groupers on tables of so many rows
};

/// Whether the value of a pair is known only when it has been matched.
constexpr bool is_measured(Sweep sweep) { return sweep == Sweep::Matches || sweep == Sweep::Ratio; }

/// How far the work on a selection goes. Each includes those behind it.
enum class StudyExtent {
  Poses,       ///< poses are fitted to it, refined and judged on the surfaces
  Selections,  ///< it is kept in a file
  Scores,      ///< its correct matches are counted
};

/// One experiment: a file such as paper/experiments/noise.toml, whose keys paper/README.md explains.
struct Experiment {
  ExperimentInfo info;
  Sweep sweep = Sweep::Column;
  std::vector<AttributeFilter> filters;
  std::vector<AttributeFilter> exceptions;  ///< pairs whose attribute is one of these are left out
  MatchSettings matching;                   ///< its resolution holds if `resolution` is given; without options
  std::optional<std::string> resolution;    ///< else that of the data set
  OptionsByName options;  ///< of groupers, detectors and descriptors, beside the defaults (the paper's)
  std::string varied;     ///< of a measured sweep: "harris.radius_pr"; empty if there is none
  std::vector<double> varied_values;
  int repeats = 1;  ///< of stochastic groupers; of all groupers for times
  std::uint64_t seed = 1;
  bool dense = false;                       ///< also refine on the whole surfaces
  bool all_rows = false;                    ///< also refine over all matches
  bool confidence = false;                  ///< also the probability that each pose is right (rate_poses)
  bool by_surface = false;                  ///< surfaces choose among the poses of a grouper (SurfaceChoice)
  StudyExtent extent = StudyExtent::Poses;  ///< how far the work on selections goes
  int tables = 1;                           ///< of Sweep::TableSize: pairs whose tables are timed
  std::vector<ForeignMethod> foreign;       ///< behind the groupers in `info.methods`
};

/// The text of an experiment: a file, or the name of a built-in one (see built_in_experiments). Throws IoError, with a
/// suggestion for an unknown name.
std::string experiment_text(const std::string& name_or_path);
/// Reads that text; `path` is for the messages. Throws IoError naming file, line and key, with a suggestion for an unknown key.
Experiment parse_experiment(const std::string& path, const std::string& text);
/// Both in one.
Experiment read_experiment(const std::string& name_or_path);

/// The names of the experiments of paper/experiments/, sorted.
std::vector<std::string> built_in_experiments();

/// "[65,70)" for an interval, "[90,95]" for the last.
std::string bin_label(double low, double high, bool is_last);

}  // namespace corral
