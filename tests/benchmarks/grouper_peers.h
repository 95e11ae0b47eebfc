// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "kernel/correspondence_set.h"
#include "tests/benchmarks/ratio_table.h"

namespace corral::benchmarks {

/// Someone else's way to group, or the plainest one.
struct GrouperPeer {
  std::string grouper;  ///< ours, as the registry names it
  std::string library;
  int largest = 0;                                        ///< more matches than this would take too long
  std::function<Call(const CorrespondenceSet&)> prepare;  ///< everything that is not timed
};

/// Those that are installed here, with the options of the paper.
const std::vector<GrouperPeer>& grouper_peers();

}  // namespace corral::benchmarks
