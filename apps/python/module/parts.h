// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

// What the module consists of. The Python files of package/ are its only caller: they have the signatures, defaults and
// docstrings. Functions here take their arguments in order.
namespace corral::python {

void add_tables(pybind11::module_& module);    ///< tables of matches, groupers
void add_scores(pybind11::module_& module);    ///< what a truth says of a selection and a pose
void add_surfaces(pybind11::module_& module);  ///< meshes, matching; only in the full package
void add_poses(pybind11::module_& module);     ///< refinement, every grouper on one table; only in the full package

}  // namespace corral::python
