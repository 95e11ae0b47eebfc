// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/numpy.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kernel/correspondence_set.h"
#include "kernel/options.h"
#include "kernel/rigid_transform.h"

// Between numpy and the types of kernel/. Everything that Python hands in passes through here: what is no array of real numbers,
// or of another shape than expected, is InvalidInput that names the argument. An array of doubles is read where it lies, whatever
// its strides; other real numbers are converted first.
namespace corral::python {

namespace py = pybind11;

double number_of(const py::handle& value, const char* argument);
Points points_of(const py::handle& value, const char* argument);                                    ///< (N, 3)
Eigen::VectorXd column_of(const py::handle& value, const char* argument);                           ///< (M,)
LocalReferenceFrames frames_of(const py::handle& value, const char* argument);                      ///< (M, 3, 3)
Eigen::Vector3d place_of(const py::handle& value, const char* argument);                            ///< (3,)
Eigen::Matrix<int, Eigen::Dynamic, 3> triangles_of(const py::handle& value, const char* argument);  ///< (F, 3)
Indices rows_of(const py::handle& value, const char* argument);         ///< (K,), whole numbers
RigidTransform pose_of(const py::handle& value, const char* argument);  ///< (4, 4), rigid to 1e-4

/// What `convert` makes of the value; absent for None.
template <class Value>
std::optional<Value> unless_none(const py::handle& value, const char* argument,
                                 Value (*convert)(const py::handle&, const char*)) {
  if (value.is_none()) return std::nullopt;
  return convert(value, argument);
}

/// Truth values, numbers and names as the texts of options. Throws InvalidInput naming the option.
OptionOverrides overrides_of(const py::dict& options, const std::string& who);

py::array array_of(const Indices& rows);                 ///< (K,) int64
py::array array_of(const std::vector<bool>& labels);     ///< (M,) bool
py::array array_of(const std::vector<double>& numbers);  ///< (M,) float64
py::array array_of(const RigidTransform& pose);          ///< (4, 4) float64

/// Something made in C++ that an array looks at, and with it the array owns it.
template <class Value, class View>
py::array owned(Value value, const View& view) {
  auto* kept = new Value(std::move(value));
  return view(*kept, py::capsule(kept, [](void* pointer) { delete static_cast<Value*>(pointer); }));
}

/// Read-only arrays on the memory of the table; `owner` is kept alive by them.
py::array view_of(const Points& points, const py::handle& owner);                ///< (M, 3)
py::array view_of(const Eigen::VectorXd& column, const py::handle& owner);       ///< (M,)
py::array view_of(const LocalReferenceFrames& frames, const py::handle& owner);  ///< (M, 3, 3)
py::array view_of(const Indices& keypoints, const py::handle& owner);            ///< (M,) int32

py::object or_none(const std::optional<RigidTransform>& pose);
template <class Value>
py::object or_none(const std::optional<Value>& value) {
  return value ? py::cast(*value) : py::object(py::none());
}

}  // namespace corral::python
