// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "kernel/correspondence_set.h"

namespace corral::testing {

struct DegenerateTable {
  std::string name;
  CorrespondenceSet matches;
};

/// What a method may meet once in its life: hardly any rows, all of them alike, without volume, symmetric, out of all
/// proportion, without a frame. Every column is filled.
std::vector<DegenerateTable> degenerate_tables();

}  // namespace corral::testing
