// SPDX-License-Identifier: MIT
#pragma once

#include "grouping/sc2pcr.h"
#include "tests/support/reference/groupers.h"

namespace corral::reference {

/// Whole matrices S, H and h, and every product of them written out.
Selection sc2pcr(const CorrespondenceSet& matches, const Sc2pcrOptions& options);

/// Its seeds, in the order in which poses are made of them.
Indices sc2pcr_seeds(const CorrespondenceSet& matches, const Sc2pcrOptions& options);

}  // namespace corral::reference
