// SPDX-License-Identifier: MIT
#include "apps/python/module/arrays.h"

#include <limits>

#include "kernel/error.h"

namespace corral::python {
namespace {

constexpr char kWho[] = "corral";
constexpr py::ssize_t kAny = -1;

[[noreturn]] void reject(const char* argument, const std::string& found, const std::string& expected) {
  throw InvalidInput(kWho, argument, found, expected);
}

std::string text_of(const py::handle& value) { return py::str(value).cast<std::string>(); }

/// The value as an array, of whatever numbers it holds.
py::array real_array(const py::handle& value, const char* argument) {
  const auto array = py::array::ensure(py::reinterpret_borrow<py::object>(value));
  if (!array)
    reject(argument, "a " + text_of(py::type::handle_of(value).attr("__name__")) + " that is no array", "real numbers");
  const char kind = array.dtype().kind();
  if (kind != 'f' && kind != 'i' && kind != 'u') reject(argument, "of dtype " + text_of(array.dtype()), "real numbers");
  return array;
}

void check_shape(const py::array& array, const char* argument, const std::vector<py::ssize_t>& expected,
                 const char* in_words) {
  bool fits = array.ndim() == static_cast<py::ssize_t>(expected.size());
  for (std::size_t axis = 0; fits && axis < expected.size(); ++axis)
    fits = expected[axis] == kAny || array.shape(static_cast<py::ssize_t>(axis)) == expected[axis];
  if (!fits) reject(argument, "of shape " + text_of(array.attr("shape")), std::string("shape ") + in_words);
  if (array.ndim() > 0 && array.shape(0) > std::numeric_limits<int>::max())
    reject(argument, std::to_string(array.shape(0)) + " rows long", "at most 2147483647 rows");
}

using Doubles = py::array_t<double, py::array::forcecast>;

Doubles doubles_of(const py::handle& value, const char* argument, const std::vector<py::ssize_t>& shape,
                   const char* in_words) {
  const py::array array = real_array(value, argument);
  check_shape(array, argument, shape, in_words);
  return Doubles(array);
}

/// Whole numbers that an int holds.
py::array_t<std::int64_t> integers_of(const py::handle& value, const char* argument,
                                      const std::vector<py::ssize_t>& shape, const char* in_words) {
  py::array array = py::array::ensure(py::reinterpret_borrow<py::object>(value));
  if (!array || (array.size() > 0 && array.dtype().kind() != 'i' && array.dtype().kind() != 'u'))
    reject(argument, array ? "of dtype " + text_of(array.dtype()) : "no array",
           "whole numbers (numpy.flatnonzero makes rows of a mask)");
  check_shape(array, argument, shape, in_words);
  return py::array_t<std::int64_t, py::array::forcecast>(array);
}

int as_int(std::int64_t number, const char* argument) {
  if (number < 0 || number > std::numeric_limits<int>::max())
    reject((std::string("a number of ") + argument).c_str(), std::to_string(number), "a row, counted from 0");
  return static_cast<int>(number);
}

template <class Array>
Array read_only(Array array) {
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

constexpr py::ssize_t kDouble = sizeof(double);

}  // namespace

double number_of(const py::handle& value, const char* argument) {
  return doubles_of(value, argument, {}, "() (one number)").data()[0];
}

Points points_of(const py::handle& value, const char* argument) {
  const Doubles array = doubles_of(value, argument, {kAny, 3}, "(N, 3)");
  const auto read = array.unchecked<2>();
  Points points(read.shape(0), 3);
  for (py::ssize_t row = 0; row < read.shape(0); ++row)
    for (py::ssize_t axis = 0; axis < 3; ++axis) points(row, axis) = read(row, axis);
  return points;
}

Eigen::VectorXd column_of(const py::handle& value, const char* argument) {
  const Doubles array = doubles_of(value, argument, {kAny}, "(M,)");
  const auto read = array.unchecked<1>();
  Eigen::VectorXd column(read.shape(0));
  for (py::ssize_t row = 0; row < read.shape(0); ++row) column(row) = read(row);
  return column;
}

LocalReferenceFrames frames_of(const py::handle& value, const char* argument) {
  const Doubles array = doubles_of(value, argument, {kAny, 3, 3}, "(M, 3, 3)");
  const auto read = array.unchecked<3>();
  LocalReferenceFrames frames(static_cast<std::size_t>(read.shape(0)));
  for (py::ssize_t row = 0; row < read.shape(0); ++row)
    for (py::ssize_t i = 0; i < 9; ++i) frames[static_cast<std::size_t>(row)](i / 3, i % 3) = read(row, i / 3, i % 3);
  return frames;
}

Eigen::Vector3d place_of(const py::handle& value, const char* argument) {
  const Doubles array = doubles_of(value, argument, {3}, "(3,)");
  const auto read = array.unchecked<1>();
  return {read(0), read(1), read(2)};
}

Eigen::Matrix<int, Eigen::Dynamic, 3> triangles_of(const py::handle& value, const char* argument) {
  const auto array = integers_of(value, argument, {kAny, 3}, "(F, 3)");
  const auto read = array.unchecked<2>();
  Eigen::Matrix<int, Eigen::Dynamic, 3> triangles(read.shape(0), 3);
  for (py::ssize_t row = 0; row < read.shape(0); ++row)
    for (py::ssize_t corner = 0; corner < 3; ++corner) triangles(row, corner) = as_int(read(row, corner), argument);
  return triangles;
}

Indices rows_of(const py::handle& value, const char* argument) {
  const auto array = integers_of(value, argument, {kAny}, "(K,)");
  const auto read = array.unchecked<1>();
  Indices rows(static_cast<std::size_t>(read.shape(0)));
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = as_int(read(static_cast<py::ssize_t>(i)), argument);
  return rows;
}

RigidTransform pose_of(const py::handle& value, const char* argument) {
  const Doubles array = doubles_of(value, argument, {4, 4}, "(4, 4)");
  const auto read = array.unchecked<2>();
  Eigen::Matrix4d matrix;
  for (py::ssize_t i = 0; i < 16; ++i) matrix(i / 4, i % 4) = read(i / 4, i % 4);
  if (!(matrix.row(3) == Eigen::RowVector4d(0, 0, 0, 1))) reject(argument, "no pose", "0 0 0 1 as its last row");
  const RigidTransform pose{matrix.topLeftCorner<3, 3>(), matrix.topRightCorner<3, 1>()};
  if (!is_rotation(pose.rotation, 1e-4) || !pose.translation.allFinite())
    reject(argument, "no rigid motion", "a rotation to 1e-4 with determinant +1 and a finite translation");
  return pose;
}

OptionOverrides overrides_of(const py::dict& options, const std::string& who) {
  OptionOverrides overrides;
  for (const auto& [key, value] : options) {
    const std::string name = text_of(key);
    py::detail::make_caster<bool> truth;
    std::string text;
    if (truth.load(value, false))
      text = static_cast<bool>(truth) ? "true" : "false";
    else if (py::isinstance<py::str>(value))
      text = value.cast<std::string>();
    else if (PyIndex_Check(value.ptr()))
      text = text_of(py::int_(py::reinterpret_borrow<py::object>(value)));
    else if (PyFloat_Check(value.ptr()) || py::hasattr(value, "dtype"))
      text = to_text(number_of(value, name.c_str()));
    else
      throw InvalidInput(who, name, "a " + text_of(py::type::handle_of(value).attr("__name__")),
                         "a number, a truth value or a name");
    overrides[name] = text;
  }
  return overrides;
}

py::array array_of(const Indices& rows) {
  py::array_t<std::int64_t> array(static_cast<py::ssize_t>(rows.size()));
  std::copy(rows.begin(), rows.end(), array.mutable_data());
  return std::move(array);
}

py::array array_of(const std::vector<bool>& labels) {
  py::array_t<bool> array(static_cast<py::ssize_t>(labels.size()));
  std::copy(labels.begin(), labels.end(), array.mutable_data());
  return std::move(array);
}

py::array array_of(const std::vector<double>& numbers) {
  return py::array_t<double>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
}

py::array array_of(const RigidTransform& pose) {
  py::array_t<double> array({4, 4});
  Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> matrix(array.mutable_data());
  matrix.setIdentity();
  matrix.topLeftCorner<3, 3>() = pose.rotation;
  matrix.topRightCorner<3, 1>() = pose.translation;
  return std::move(array);
}

py::array view_of(const Points& points, const py::handle& owner) {
  return read_only(
      py::array_t<double>({points.rows(), py::ssize_t{3}}, {kDouble, kDouble * points.rows()}, points.data(), owner));
}

py::array view_of(const Eigen::VectorXd& column, const py::handle& owner) {
  return read_only(py::array_t<double>({column.size()}, {kDouble}, column.data(), owner));
}

py::array view_of(const LocalReferenceFrames& frames, const py::handle& owner) {
  static_assert(sizeof(LocalReferenceFrame) == 9 * sizeof(double));
  const double* first = frames.empty() ? nullptr : frames.front().data();
  return read_only(py::array_t<double>({static_cast<py::ssize_t>(frames.size()), py::ssize_t{3}, py::ssize_t{3}},
                                       {9 * kDouble, kDouble, 3 * kDouble}, first, owner));
}

py::array view_of(const Indices& keypoints, const py::handle& owner) {
  return read_only(py::array_t<int>({static_cast<py::ssize_t>(keypoints.size())}, {py::ssize_t{sizeof(int)}},
                                    keypoints.data(), owner));
}

py::object or_none(const std::optional<RigidTransform>& pose) {
  return pose ? py::object(array_of(*pose)) : py::object(py::none());
}

}  // namespace corral::python
