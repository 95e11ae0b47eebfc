// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "apps/claims/claim_study.h"
#include "apps/reproduce/readings.h"
#include "apps/study/study.h"

namespace corral {

struct ReproduceSettings {
  std::string data;                      ///< a folder of data sets, or one of them
  std::string folder;                    ///< of the results
  std::vector<std::string> experiments;  ///< built-in ones, each once
  std::string cache;                     ///< folder of features and matches; empty: within `folder`
  std::uint64_t cache_limit = 0;         ///< bytes of it; 0: none
  int jobs = 1;
  std::string command_line;
};

/// Which pairs: all, or the half on which combinations are chosen, or the other one. Pairs of one scene are in one half: scenes
/// (of a set without them, pairs) go to the halves by turns, in the order of their names.
enum class Half { All, Chosen, HeldOut };

/// Experiments under a combination, ready to be judged.
struct JudgedTables {
  std::vector<ExperimentTable> tables;
  std::vector<std::vector<RowNumbers>> agreement, keypoints;  ///< as in ClaimTable, of each table
};

/// Runs what combinations need, once each: a study folder for each way of matching and data set, in which every grouper runs
/// with all of its options that some combination has. What a combination differs in beside the matching is put together from
/// these, so that it costs milliseconds.
class ReadingTables {
 public:
  using Progress = std::function<void(const std::string& study, const StudyProgress&)>;

  ReadingTables(std::vector<OpenPoint> points, const ClaimBook& book, ReproduceSettings settings, Progress progress);
  ~ReadingTables();
  ReadingTables(const ReadingTables&) = delete;
  ReadingTables& operator=(const ReadingTables&) = delete;

  /// Runs what is missing. Throws IoError, InvalidInput.
  JudgedTables of(const Combination& combination, Half half);

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace corral
