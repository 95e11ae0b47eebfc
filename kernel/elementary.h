// SPDX-License-Identifier: MIT
#pragma once

namespace corral {

// Elementary functions of additions, multiplications, divisions and square roots in a fixed order: the same bits on every
// machine, where those of C libraries differ in the last digit from one to another. Within a few units of the last place.

/// e^x for x <= 0; 0 below -700, and for what is no number.
double exponential(double x);

/// ln x for 0 < x <= 1.
double logarithm(double x);

/// x^(1/3) for x >= 0.
double cube_root(double x);

/// The angle of this sine, for 0 <= x <= 1.
double arc_sine(double x);

}  // namespace corral
