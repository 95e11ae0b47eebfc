// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "kernel/correspondence_set.h"

/// What definitions of groupers cost when they are written down as plain loops in double.
namespace corral::benchmarks::plain {

/// SS less its threshold and selection: one std::sort of the scores.
std::vector<double> sorted_scores(const CorrespondenceSet& matches);

/// NNSR less its selection and checks: one pass over two columns that writes a third, as fast as memory allows.
std::vector<double> ratio_scores(const CorrespondenceSet& matches);

/// GC: every unordered pair looked at once.
Indices largest_star(const CorrespondenceSet& matches, double tolerance);

}  // namespace corral::benchmarks::plain
