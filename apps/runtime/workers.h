// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/parallel.h"

namespace corral {

/// Spreads the calls over so many threads; 0: as many as the machine has. What a call throws, the loop throws.
ParallelFor workers(int threads);

}  // namespace corral
