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

/// Every grouper: those of [yang2017evaluation] in its order, then what came after.
const std::vector<Grouper>& groupers();

/// The names that a list of names means: "paper" stands for the seven of [yang2017evaluation], "all" for every grouper.
/// Others are kept as they are, known or not.
std::vector<std::string> expand_groupers(const std::vector<std::string>& names);

/// Throws InvalidInput for an unknown name, listing the known ones.
const Grouper& find_grouper(const std::string& name);

}  // namespace corral
