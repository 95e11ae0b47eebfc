// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "grouping/grouper.h"
#include "kernel/options.h"

namespace corral {

/// A grouper with its options bound, and what they are.
struct ConfiguredGrouper {
  GroupFunction group;
  std::vector<OptionValue> options;
  std::function<double(int matches)> working_memory = {};  ///< bytes at most (see grouper.h); empty if nobody knows
};

/// One method as the command line, the tests and the README know it.
struct Grouper {
  std::string name;                                                    ///< "gc"
  std::string title;                                                   ///< "Geometric consistency (GC)"
  std::string principle;                                               ///< one line
  std::string citation;                                                ///< key in paper/references.bib
  std::vector<OptionValue> options;                                    ///< the defaults
  std::function<ConfiguredGrouper(const OptionOverrides&)> configure;  ///< throws InvalidInput as parse_options does
};

/// Every method, in the order of the paper.
const std::vector<Grouper>& groupers();

/// Throws InvalidInput for an unknown name, listing the known ones.
const Grouper& find_grouper(const std::string& name);

}  // namespace corral
