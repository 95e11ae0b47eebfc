// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/pair/foreign_answer.h"
#include "apps/study/specification.h"
#include "io/pairs/dataset_file.h"

namespace corral {

/// Reads methods.toml, whose keys paper/README.md explains: an entry for each method of another program, with the patterns of
/// its files. `path` is for the messages; patterns are from its folder. Throws IoError naming file, line and key.
std::vector<ForeignMethod> parse_methods(const std::string& path, const std::string& text);

/// The files of a pair: {pair}, {dataset} and {COLUMN}, a column of pairs.csv, are replaced. Throws IoError for a name that is
/// none of them.
ForeignAnswer answer_to(const ForeignMethod& method, const Dataset& dataset, const DatasetPair& pair);

/// Appends them to the methods of the experiment. Throws IoError if it takes times.
void add_methods(Experiment& experiment, const std::vector<ForeignMethod>& methods);

}  // namespace corral
