// SPDX-License-Identifier: MIT
#pragma once

#include "grouping/clique.h"
#include "tests/support/reference/groupers.h"

namespace corral::reference {

/// Without the bound on the steps.
Selection clique(const CorrespondenceSet& matches, const CliqueOptions& options);

}  // namespace corral::reference
