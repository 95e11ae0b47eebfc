// SPDX-License-Identifier: MIT
#pragma once

namespace corral::benchmarks {

/// What one core reaches with the vectors of Highway's best target in single precision, in GFLOP/s: independent chains of a * b + c in
/// registers, two operations each, fused where the target has the instruction. The best of several short runs.
double multiply_add_peak();

}  // namespace corral::benchmarks
