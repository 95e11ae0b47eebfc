// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include "apps/runtime/json.h"

namespace corral::python {

/// The same as dict, list, str, bool, int, float and None.
pybind11::object as_python(const Json& json);

}  // namespace corral::python
