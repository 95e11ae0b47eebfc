// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "apps/commands/command_options.h"
#include "apps/pair/confidence_signals.h"
#include "apps/pair/evaluate_pair.h"
#include "apps/pair/explain.h"
#include "apps/pair/match_pair.h"
#include "apps/pair/truth_fit.h"

namespace corral {

/// What `corral run` is asked for.
struct RunSettings {
  std::string source, target;  ///< meshes; both empty if `matches` is all there is
  std::string matches;         ///< a table of matches; empty if the meshes are to be matched
  std::string methods = "all", output;
  TruthSettings truth;
  double threshold_pr = 4;
  int repeat = 1;
  std::uint64_t memory_limit = 0;
  MatchSettings match;
  ExternalSettings external;
  std::vector<std::string> set;
  std::string rows = "selected", select = "score";
  bool drop_stray = false, dense = false, explain = false, json = false, verbose = false;
};

/// Names of groupers between commas, each once; "all" and "paper" as expand_groupers() takes them. Throws UsageError.
std::vector<std::string> method_names(const std::string& text);

/// What a terminal is told before a grouper is called so many times: its name, and the time that the plan of a study expects
/// where that is 10 s or more.
std::string call_text(const std::string& method, int matches, int repeat);

/// What came of it.
struct PairRun {
  std::vector<std::string> methods;
  std::vector<ConfiguredGrouper> groupers;  ///< of the first of these
  std::vector<ExternalMethod> externals;    ///< of the others
  MatchedPair pair;
  std::optional<PairTruth> truth;
  std::vector<MethodRecord> records;
  std::vector<std::optional<ConfidenceSignals>> signals;  ///< of the records whose pose was rated here
  std::vector<MethodRecord> bounds;                       ///< with a truth: the oracle and the baseline
  std::vector<bool> labels;                               ///< with a truth: which matches are correct
  std::optional<FrameRepeatability> frames;               ///< with a truth
  std::optional<TruthFit> fit;                            ///< with a truth
  std::optional<double> opposed_share;    ///< of normals, with a truth by which the pair is lost before the grouping
  PairCounts counts;                      ///< with --explain
  std::vector<Explanation> explanations;  ///< with --explain: of the pair, then of each grouper

  std::optional<int> true_matches() const {
    if (!truth) return std::nullopt;
    return static_cast<int>(std::count(labels.begin(), labels.end(), true));
  }
};

/// Matches, unless a table is given, then groups, refines and judges. Throws as what it calls.
PairRun evaluate(const RunSettings& settings);

}  // namespace corral
