// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "grouping/grouper.h"
#include "grouping/options.h"

namespace corral {

/// A grouper with its options bound, and what they are.
struct ConfiguredGrouper {
  GroupFunction group;
  std::vector<OptionValue> options;
  std::function<double(int matches)> working_memory = {};  ///< peak bytes (see grouper.h); empty if unknown
};

/// A grouper as the command line, the tests and the documents list it.
struct Grouper {
  std::string name;                                                    ///< "gc"
  std::string title;                                                   ///< "Geometric consistency (GC)"
  std::string principle;                                               ///< one line
  std::string citation;                                                ///< key in paper/references.bib
  std::vector<OptionValue> options;                                    ///< the defaults
  std::function<ConfiguredGrouper(const OptionOverrides&)> configure;  ///< throws InvalidInput as parse_options does
};

/// Every grouper, in the order of the paper.
const std::vector<Grouper>& groupers();

/// Throws InvalidInput for an unknown name, listing the known ones.
const Grouper& find_grouper(const std::string& name);

}  // namespace corral
