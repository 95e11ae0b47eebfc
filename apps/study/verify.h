// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/study/study.h"

namespace corral {

struct VerifySettings {
  std::string folder, data;        ///< of the study; of its data sets, if they are not where they were
  std::optional<int> sample = 10;  ///< pairs to compute again; absent: all
  std::uint64_t seed = 1;          ///< of the draw
  int jobs = 0;                    ///< pairs at a time; 0: as many as the machine has processors
  bool programs = false;           ///< call the programs that the study names as methods
};

struct VerifyOutcome {
  std::size_t pairs = 0, of = 0;         ///< that were computed again, of all of the study
  std::size_t records = 0, files = 0;    ///< of these pairs, that were compared
  std::vector<std::string> differences;  ///< a sentence each; empty if all is as it was
};

/// Computes pairs of a finished study again from their inputs, with nothing from its cache, and compares what does not depend
/// on the clock: the hashes of their files, every cell of their records, and their files of selections and poses byte by byte. All other
/// lines of records.csv are compared with the journals.
/// Throws    IoError: no such study, one of another program or of data sets that have become others, or one that calls programs
///           which it may not.
VerifyOutcome verify_study(const VerifySettings& settings, const std::function<void(const StudyProgress&)>& progress);

}  // namespace corral
