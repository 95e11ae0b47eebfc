// SPDX-License-Identifier: MIT
// Transforms in the layouts that are written.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "io/pose/transform_file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

std::string listed(const std::vector<double>& numbers, const char* separator) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : separator) + to_text(number);
  return text;
}

/// The rows of the 3x4 matrix.
std::string rows(const RigidTransform& transform, const char* separator, const char* between) {
  std::string text;
  for (int row = 0; row < 3; ++row) {
    const Eigen::Vector3d axis = transform.rotation.row(row);
    text += (row > 0 ? between : "") + listed({axis(0), axis(1), axis(2), transform.translation(row)}, separator);
  }
  return text;
}

/// Translation and quaternion x y z w, w not negative.
std::string with_quaternion(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& t) {
  Eigen::Quaterniond q = Eigen::Quaterniond(rotation).normalized();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return listed({t(0), t(1), t(2), q.x(), q.y(), q.z(), q.w()}, " ");
}

std::string in_bop(const RigidTransform& transform, std::int64_t image) {
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> r = transform.rotation;
  const Eigen::Vector3d& t = transform.translation;
  return "{\n  \"" + std::to_string(image) + "\": [{\"cam_R_m2c\": [" + listed({r.data(), r.data() + 9}, ", ") +
         "], \"cam_t_m2c\": [" + listed({t.data(), t.data() + 3}, ", ") + "], \"obj_id\": 1}]\n}\n";
}

[[noreturn]] void refuse_key(const std::string& key, const std::string& accepted) {
  throw InvalidInput("transform_text", "key", "'" + key + "'", accepted);
}

std::int64_t whole_number(const std::string& text, const std::string& key, const std::string& accepted) {
  const std::optional<std::int64_t> number = parse_int(text);
  if (!number || *number < 0 || *number >= 1000000000) refuse_key(key, accepted);
  return *number;
}

std::string in_log(const RigidTransform& transform, const std::string& key) {
  const std::string accepted = "two different whole numbers, SOURCE,TARGET";
  const std::size_t comma = std::min(key.find(','), key.size());
  const std::int64_t source = whole_number(key.substr(0, comma), key, accepted),
                     target = whole_number(key.substr(std::min(comma + 1, key.size())), key, accepted);
  if (source == target) refuse_key(key, accepted);
  return std::to_string(target) + " " + std::to_string(source) + " " + std::to_string(std::max(source, target) + 1) +
         "\n" + transform_text(transform);
}

std::string in_conf(const RigidTransform& transform, const std::string& key) {
  if (key.find_first_of(" \t\r\n\v\f,") != std::string::npos) refuse_key(key, "a file without white space and commas");
  return "bmesh " + key + " " + with_quaternion(transform.rotation.transpose(), transform.translation) + "\n";
}

std::string in_tum(const RigidTransform& transform, const std::string& key) {
  const std::optional<double> time = parse_double(key);
  if (!time || !std::isfinite(*time)) refuse_key(key, "a time");
  return key + " " + with_quaternion(transform.rotation, transform.translation) + "\n";
}

}  // namespace

std::string transform_text(const RigidTransform& transform) { return rows(transform, " ", "\n") + "\n0 0 0 1\n"; }

std::string transform_text(const RigidTransform& transform, TransformLayout layout, const std::string& key) {
  switch (layout) {
    case TransformLayout::Tum:
      return in_tum(transform, key.empty() ? "0" : key);
    case TransformLayout::Log:
      return in_log(transform, key.empty() ? "1,0" : key);
    case TransformLayout::Conf:
      return in_conf(transform, key.empty() ? "source.ply" : key);
    case TransformLayout::Bop:
      return in_bop(transform, whole_number(key.empty() ? "0" : key, key, "the number of an image"));
    default:
      break;
  }
  if (!key.empty()) refuse_key(key, "none: a file of this layout has no names");
  if (layout == TransformLayout::Matrix3x4) return rows(transform, " ", "\n") + "\n";
  if (layout == TransformLayout::Kitti) return rows(transform, " ", " ") + "\n";
  if (layout == TransformLayout::JsonRows) return "[[" + rows(transform, ", ", "],\n [") + "],\n [0, 0, 0, 1]]\n";
  return transform_text(transform);
}

}  // namespace corral
