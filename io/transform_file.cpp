// SPDX-License-Identifier: MIT
#include "io/transform_file.h"

#include <Eigen/LU>
#include <vector>

#include "io/file.h"
#include "io/line_reader.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

constexpr double kOrthonormal = 1e-4;

void check_rigid(const std::string& path, const Eigen::Matrix4d& matrix) {
  const Eigen::RowVector4d last = matrix.row(3);
  if (!(last - Eigen::RowVector4d(0, 0, 0, 1)).isZero(0))
    throw IoError(path, "row 4",
                  "is " + to_text(last(0)) + " " + to_text(last(1)) + " " + to_text(last(2)) + " " + to_text(last(3)) +
                      ", expected 0 0 0 1");
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  if (is_rotation(rotation, kOrthonormal)) return;
  const double excess = (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  throw IoError(path, "rotation",
                "not rigid: R R^T differs from the identity by " + to_text(excess) + " and det R is " +
                    to_text(rotation.determinant()) + ", expected at most 0.0001 and +1");
}

}  // namespace

RigidTransform read_transform(const std::string& path) {
  std::string content = read_file(path);
  if (content.empty()) throw IoError(path, "", "the file is empty, expected a 4x4 matrix");
  content += '\n';  // the last row must be 0 0 0 1, so that a truncated one is noticed
  LineReader reader(path, content, '#');
  std::vector<double> numbers;
  while (reader.next())
    for (const std::string_view field : reader.fields()) numbers.push_back(reader.finite_number(field));
  if (numbers.size() != 16)
    throw IoError(path, "", "found " + std::to_string(numbers.size()) + " numbers, expected the 16 of a 4x4 matrix");
  const Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
  check_rigid(path, matrix);
  return {matrix.topLeftCorner<3, 3>(), matrix.topRightCorner<3, 1>()};
}

std::string transform_text(const RigidTransform& transform) {
  std::string text;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) text += to_text(transform.rotation(row, column)) + " ";
    text += to_text(transform.translation(row)) + "\n";
  }
  return text + "0 0 0 1\n";
}

}  // namespace corral
