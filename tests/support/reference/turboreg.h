// SPDX-License-Identifier: MIT
#pragma once

#include "grouping/turboreg.h"
#include "tests/support/reference/groupers.h"

namespace corral::reference {

/// All common neighbours of all edges are counted and sorted.
Selection turboreg(const CorrespondenceSet& matches, const TurboregOptions& options);

}  // namespace corral::reference
