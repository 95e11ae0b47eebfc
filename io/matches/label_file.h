// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "io/array/number_table.h"
#include "kernel/types.h"

namespace corral {

/// Whether each of `rows` matches is said to be correct, or is selected, by another program: a number 0 or 1 for each, in
/// lines, in one line or as an array; or the rows (from 0) for which it is true, each once.
/// Throws    IoError naming file and line where it is neither.
std::vector<bool> read_labels(const std::string& name, int rows);
/// The same of numbers that have been read.
std::vector<bool> labels_of(const NumberTable& table, int rows);

/// The rows that another program selected, as labels; or a group file (read_group) of so many rows.
Indices read_selection(const std::string& name, int rows);

/// Whether there are numbers, and all are 0 or 1.
bool is_binary(const Eigen::Ref<const Eigen::MatrixXd>& numbers);

}  // namespace corral
