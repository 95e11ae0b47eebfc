// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "grouping/grouper.h"
#include "tests/support/reference/groupers.h"

namespace corral::testing {

/// Which turns of the target a method does not see.
enum class Turns {
  Any,
  AxesToAxes,   ///< its cells are parallel to the axes
  AxesInCycle,  ///< and they start at the lowest corner: axes must keep their direction
};

/// What becomes of the selection if every row is there twice.
enum class Copies {
  Unlike,  ///< something that depends on the method's counts
  Both,    ///< a row is selected with its copy or not at all
  First,   ///< a row is selected as before, its copy never: copies are in conflict
};

/// What a definition promises beside the rows themselves; by default that which most of them do.
struct Promises {
  bool symmetric = true;      ///< source and target may change places
  bool numbers_rows = false;  ///< the number of a row is more than a way to settle ties
  bool knows_origin = false;  ///< translations matter
  Turns turns = Turns::Any;
  Copies copies = Copies::Unlike;
};

/// A grouper with certain options, the slow one written from its definition, and what else the definition promises.
struct GrouperVariant {
  std::string name;
  GroupFunction group;
  std::function<reference::Selection(const CorrespondenceSet&)> reference;
  Promises promises;
};

/// Every grouper with the values of its options that make it another method.
const std::vector<GrouperVariant>& grouper_variants();

/// Those that fit.
std::vector<GrouperVariant> variants_where(const std::function<bool(const Promises&)>& fits);

inline void PrintTo(const GrouperVariant& variant, std::ostream* stream) { *stream << variant.name; }

}  // namespace corral::testing
