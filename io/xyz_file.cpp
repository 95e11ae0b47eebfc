// SPDX-License-Identifier: MIT
// XYZ: one point per line; further columns (colours, normals, intensities) are not read.
#include "io/line_reader.h"
#include "io/mesh_file.h"

namespace corral {
namespace {

/// A line that contains a comma is separated by commas: a decimal comma then gives fields that are not numbers.
const std::vector<std::string_view>& columns(LineReader& reader) {
  return reader.line().find(',') == std::string_view::npos ? reader.fields() : reader.fields(',');
}

}  // namespace

StoredMesh parse_xyz(const std::string& path, std::string_view content) {
  LineReader reader(path, content, '#');
  std::vector<double> coordinates;
  std::size_t width = 0, first_line = 0;
  while (reader.next()) {
    const auto& fields = columns(reader);
    if (fields.size() < 3)
      reader.fail("found " + quoted(reader.line()) + ", expected at least the three coordinates of a point");
    if (width == 0) {
      width = fields.size();
      first_line = reader.line_number();
    }
    if (fields.size() != width)
      reader.fail("found " + std::to_string(fields.size()) + " columns, expected " + std::to_string(width) +
                  " as in line " + std::to_string(first_line));
    if (static_cast<long long>(coordinates.size() / 3) == kMaximumCount) reader.fail("more points than can be counted");
    for (std::size_t axis = 0; axis < 3; ++axis) coordinates.push_back(reader.finite_number(fields[axis]));
  }
  if (coordinates.empty()) reader.fail("no point, expected lines like '0 0 0'");
  StoredMesh cloud;
  cloud.vertices = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>(
      coordinates.data(), static_cast<Eigen::Index>(coordinates.size() / 3), 3);
  return cloud;
}

}  // namespace corral
