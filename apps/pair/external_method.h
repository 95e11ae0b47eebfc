// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/pair/evaluate_pair.h"

namespace corral {

/// A grouper that is another program, called on every table of matches.
struct ExternalMethod {
  std::string name;
  std::string command;             ///< its words, in which {matches}, {group} and {pose} stand for files
  double timeout_s = 60;           ///< of a call
  std::uint64_t memory_bytes = 0;  ///< address space of each of its processes; 0: no limit

  /// The options that a record of its results needs.
  std::vector<OptionValue> options() const;
  /// Files that the command names, such as the script that it runs: results depend on them.
  std::vector<std::string> files() const;
};

/// "NAME=COMMAND". The name has letters, digits and . _ + -, and is no grouper's; the command names {matches}, and {group} or
/// {pose} or both. Throws InvalidInput.
ExternalMethod parse_external(const std::string& text);

/// Letters, digits and . _ + -, none of the names that every study has.
bool is_method_name(const std::string& name);

/// What a call gave.
struct ExternalAnswer {
  GroupingResult found;
  double time_ms = 0;  ///< wall time of the call, its start-up included
};

/// Calls the program: the table is written to {matches} as read_matches reads it, then {group} is read (read_selection: a
/// group file, labels or rows), and {pose}, if it was written (read_transform). A pose alone selects every match within
/// kStatedPosePr.
/// Throws    std::runtime_error saying what is wrong: the status or signal that it ended with, the limit that it met, a file that it
///           did not write, or what is in that. The end of its messages is part of it.
ExternalAnswer call_external(const ExternalMethod& method, const CorrespondenceSet& matches);

/// Wall time of a call with a table without rows, whatever its answer: what it takes to start. Taken once for each command.
double start_up_ms(const ExternalMethod& method);

/// Calls it, scores, refines and judges (evaluate_method). Its time is the median of the calls, less its start-up. A call that
/// goes wrong is the failure of this method alone.
MethodRecord evaluate_external(const ExternalMethod& method, const CorrespondenceSet& matches,
                               const std::optional<PairTruth>& truth, int repeat);

}  // namespace corral
