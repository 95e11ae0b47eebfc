// SPDX-License-Identifier: MIT
#pragma once

#include "grouping/tcf.h"
#include "tests/support/reference/groupers.h"

namespace corral::reference {

/// For tables that are not sampled, written in canonical order; score and keep are ignored. Draws from the same stream.
Selection tcf(const CorrespondenceSet& matches, const TcfOptions& options);

}  // namespace corral::reference
