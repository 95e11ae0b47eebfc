// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "tests/benchmarks/natural_tables.h"

namespace corral::benchmarks {

/// One of our groupers on one table.
struct GrouperTime {
  std::string grouper;
  const NaturalTable* table;
  double ms;
};

/// Operations per second of the loops that groupers spend their time in, beside the peak of the same core; for those that do
/// no arithmetic, what they read beside plain reading of as much.
void print_rates(std::FILE* to, const std::vector<GrouperTime>& times);

/// The power of n that each grouper's times grow with: least squares of log time on log n, over all meshes.
void print_exponents(std::FILE* to, const std::vector<GrouperTime>& times);

/// Compares our selections with those of tests/support/reference/groupers wherever that ends within seconds. True if none
/// differs.
bool print_labels(std::FILE* to, const std::vector<GrouperTime>& times);

}  // namespace corral::benchmarks
