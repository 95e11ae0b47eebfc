// SPDX-License-Identifier: MIT
#include "apps/python/module/records.h"

namespace corral::python {

namespace py = pybind11;

py::object as_python(const Json& json) {
  if (json.is_object()) {
    py::dict object;
    for (const auto& [key, value] : json.items()) object[py::str(key)] = as_python(value);
    return std::move(object);
  }
  if (json.is_array()) {
    py::list list;
    for (const Json& value : json) list.append(as_python(value));
    return std::move(list);
  }
  if (json.is_boolean()) return py::bool_(json.get<bool>());
  if (json.is_number_unsigned()) return py::int_(json.get<std::uint64_t>());
  if (json.is_number_integer()) return py::int_(json.get<std::int64_t>());
  if (json.is_number()) return py::float_(json.get<double>());
  if (json.is_string()) return py::str(json.get<std::string>());
  return py::none();
}

}  // namespace corral::python
