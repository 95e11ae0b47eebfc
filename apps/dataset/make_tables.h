// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "apps/pair/match_settings.h"
#include "apps/runtime/progress.h"
#include "kernel/parallel.h"

namespace corral {

struct MakeTablesOptions {
  std::string data, output;  ///< folders of a set with surfaces and of the new set
  MatchSettings matching;    ///< its rule of pr is that of the set
  ParallelFor parallel = one_by_one;
};

/// A set of tables of matches out of a set of surfaces: each pair matched once, its truth and attributes kept. A pair that has a table
/// already keeps that. Tables are what groupers are compared on where nobody is to match again: scoreboards, challenges, other
/// programs. Deterministic. An interrupted call continues. Throws IoError, InvalidInput; a pair that cannot be matched is an error.
void make_tables(const MakeTablesOptions& options, Progress& progress);

int count_tables(const MakeTablesOptions& options);  ///< how many pairs it has

}  // namespace corral
