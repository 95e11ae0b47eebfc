// SPDX-License-Identifier: MIT
#pragma once

#include "grouping/mac.h"
#include "tests/support/reference/groupers.h"

namespace corral::reference {

/// Without the bound on the steps; not for Fs.
Selection mac(const CorrespondenceSet& matches, const MacOptions& options);

/// How many cliques the rows name.
int mac_hypotheses(const CorrespondenceSet& matches, const MacOptions& options);

}  // namespace corral::reference
