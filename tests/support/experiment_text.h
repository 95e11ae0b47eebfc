// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "apps/study/specification.h"
#include "tests/io/scratch.h"

namespace corral::testing {

/// An experiment without an error, to be varied.
inline constexpr char kGood[] = R"toml(name = "mine"
dataset = "b3r"
attribute = "noise_pr"
levels = [0.05, 1]
groupers = ["st", "gc"]
[filter]
density = ["", "1"]
[options.gc]
tolerance_pr = 2
cluster = "clique"
[options.harris]
radius_pr = 2
[matching]
normals = "origin"
)toml";

/// What is wrong with one; empty if nothing is.
inline std::string error_of(const std::string& text) {
  return io_error_of([&] { parse_experiment("x.toml", text); });
}

}  // namespace corral::testing
