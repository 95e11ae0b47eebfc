// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "grouping/grouper.h"
#include "kernel/table_entry.h"

namespace corral {

/// A grouper with its options bound, and what they are.
struct ConfiguredGrouper {
  GroupFunction group;
  std::vector<OptionValue> options;
  std::function<double(int matches)> working_memory = {};  ///< peak bytes (see grouper.h); empty if unknown
};

/// A grouper as the command line, the tests and the documents list it.
using Grouper = TableEntry<ConfiguredGrouper>;

/// Every grouper, in the order of the paper.
const std::vector<Grouper>& groupers();

/// Throws InvalidInput for an unknown name, listing the known ones.
const Grouper& find_grouper(const std::string& name);

}  // namespace corral
