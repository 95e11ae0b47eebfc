// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/parallel.h"

namespace corral {

/// Runs the calls on this many threads; 0: as many as there are processors. An exception of a call is rethrown by the loop.
ParallelFor workers(int threads);

}  // namespace corral
