// SPDX-License-Identifier: MIT
// From the numbers of a file to a rigid motion, or to the reason why they are none.
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <charconv>
#include <cmath>

#include "io/pose/pose_entry.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

constexpr double kOrthonormal = 1e-4;
constexpr int kFewestDigits = 3;

/// For messages: six significant digits.
std::string short_text(double value) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 6).ptr};
}

/// For messages: a length below 1.
std::string fixed_text(double value, int digits) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, digits).ptr};
}

/// How many digits stand behind the decimal point of the shortest text of a number.
int decimals(double value) {
  char buffer[32];
  const char* const end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::scientific).ptr;
  const std::string text(static_cast<const char*>(buffer), end);
  const std::size_t point = text.find('.'), exponent = text.find('e');
  const int mantissa = point == std::string::npos ? 0 : static_cast<int>(exponent - point) - 1;
  return std::max(0, mantissa - static_cast<int>(parse_int(std::string_view(text).substr(exponent + 1)).value_or(0)));
}

/// Digits behind the decimal point with which the entries were printed. Where they have the same number of significant
/// digits instead, it is that of the large ones which bounds the error.
int printed_digits(const double* entries, int count) {
  int of_large = 0, of_all = 0;
  for (int i = 0; i < count; ++i) {
    of_all = std::max(of_all, decimals(entries[i]));
    if (std::abs(entries[i]) >= 0.1) of_large = std::max(of_large, decimals(entries[i]));
  }
  return of_large >= kFewestDigits ? of_large : of_all;
}

/// The error of an entry, half a unit in its last place.
double rounding(int digits) { return 0.5 * std::pow(10.0, -digits); }

double excess_of(const Eigen::Matrix3d& matrix) {
  return (matrix * matrix.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
}

/// The largest entry of R R^T - I if every entry of R is off by its rounding: with R = Q + E for a rotation Q it is
/// Q E^T + E Q^T + E E^T, and the entries of a row of Q add up to at most sqrt(3).
double explained_excess(int digits) {
  const double error = rounding(digits);
  return 2 * std::sqrt(3.0) * error + 3 * error * error;
}

/// The orthogonal factor of the polar decomposition, the nearest rotation in the Frobenius norm (det R > 0).
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

/// Why a matrix is no rotation, after a colon; empty if that cannot be told.
std::string cause(const Eigen::Matrix3d& matrix, int digits) {
  const double determinant = matrix.determinant(), scale = std::cbrt(std::abs(determinant));
  if (digits > 0 && digits < kFewestDigits && determinant > 0 && excess_of(matrix) <= explained_excess(digits))
    return ": it is printed with too few digits, expected at least 3 behind the point";
  if (!std::isfinite(scale) || !(excess_of(matrix / scale) <= explained_excess(kFewestDigits))) return "";
  std::string text;
  if (determinant < 0) text += " and mirrored";
  if (std::abs(scale - 1) > rounding(kFewestDigits)) text += " and scaled by " + short_text(scale);
  return text.empty() ? "" : ": it is" + text.substr(4);
}

std::string within(const PoseEntry& entry, const std::string& part) {
  return entry.place.empty() ? part : entry.place + ", " + part;
}

void check_last_row(const std::string& path, const PoseEntry& entry, const Eigen::Matrix4d& matrix) {
  const Eigen::RowVector4d last = matrix.row(3);
  if ((last - Eigen::RowVector4d(0, 0, 0, 1)).isZero(0)) return;
  const bool is_transposed = last(3) == 1 && matrix.topRightCorner<3, 1>().isZero(0);
  throw IoError(path, within(entry, "row 4"),
                "is " + to_text(last(0)) + " " + to_text(last(1)) + " " + to_text(last(2)) + " " + to_text(last(3)) +
                    ", expected 0 0 0 1" +
                    (is_transposed ? ": the matrix is transposed, its translation stands in the last row" : ""));
}

StoredTransform from_matrix(const std::string& path, const PoseEntry& entry) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  for (std::size_t i = 0; i < entry.numbers.size(); ++i)
    matrix(static_cast<int>(i / 4), static_cast<int>(i % 4)) = entry.numbers[i];
  check_last_row(path, entry, matrix);
  StoredTransform pose{{matrix.topLeftCorner<3, 3>(), matrix.topRightCorner<3, 1>()}, entry.notes};
  if (is_rotation(pose.rotation, kOrthonormal)) return pose;
  const Eigen::Matrix3d printed = pose.rotation;
  const int digits = printed_digits(printed.data(), 9);
  const double excess = excess_of(printed), determinant = printed.determinant();
  if (digits < kFewestDigits || !(excess <= explained_excess(digits)) || !(determinant > 0))
    throw IoError(path, within(entry, "rotation"),
                  "not rigid: R R^T differs from the identity by " + to_text(excess) + " and det R is " +
                      to_text(determinant) + ", expected at most 0.0001 and +1" + cause(printed, digits));
  pose.rotation = nearest_rotation(printed);
  pose.notes.push_back("the rotation is printed with " + std::to_string(digits) +
                       " digits: taken to the nearest rotation (entries change by at most " +
                       fixed_text((pose.rotation - printed).cwiseAbs().maxCoeff(), digits + 2) + ")");
  return pose;
}

StoredTransform from_quaternion(const std::string& path, const PoseEntry& entry) {
  const double* const q = entry.numbers.data() + 3;
  const Eigen::Quaterniond quaternion(q[3], q[0], q[1], q[2]);
  const double off = std::abs(quaternion.norm() - 1);
  const int digits = printed_digits(q, 4);
  // Four entries that are off by their rounding change the length by at most twice as much.
  if (!(off <= kOrthonormal) && !(digits >= kFewestDigits && off <= 2 * rounding(digits)))
    throw IoError(path, within(entry, "quaternion"),
                  "has the length " + short_text(quaternion.norm()) + ", expected 1 within 0.0001");
  StoredTransform pose{{quaternion.normalized().toRotationMatrix(),
                        Eigen::Vector3d(entry.numbers[0], entry.numbers[1], entry.numbers[2])},
                       entry.notes};
  if (!(off <= kOrthonormal))
    pose.notes.push_back("the quaternion is printed with " + std::to_string(digits) + " digits: normalised from " +
                         short_text(quaternion.norm()));
  return pose;
}

}  // namespace

StoredTransform rigid_pose(const std::string& path, const PoseEntry& entry) {
  return entry.numbers.size() == 7 ? from_quaternion(path, entry) : from_matrix(path, entry);
}

}  // namespace corral
