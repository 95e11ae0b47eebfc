// SPDX-License-Identifier: MIT
#pragma once

#include "grouping/grouper.h"

namespace corral {

/// The rows of a table in an order that depends on what they hold, not on where they stand: by source point, target point,
/// feature distance, second feature distance, source frame and target frame, each by its numbers in turn; rows that are
/// alike in all of them by their number. A grouper that works in this order is a function of the set of rows: its sums,
/// ties, draws and searches do not depend on how the table was written.
Indices canonical_order(const CorrespondenceSet& matches);

/// The answer of `group` for the table in canonical order, in the rows of the table itself.
GroupingResult group_in_canonical_order(const CorrespondenceSet& matches, const GroupFunction& group);

/// Bytes that this takes beside those of `group`.
double canonical_order_memory(int matches);

}  // namespace corral
