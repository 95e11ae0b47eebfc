// SPDX-License-Identifier: MIT
// PCD, the format of the Point Cloud Library: a text header that names the fields of a point, then the points as lines of
// text or as packed little-endian bytes.
#include <cmath>

#include "io/mesh_file.h"
#include "io/pcd_header.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

/// Collects points; those without any coordinate are missing returns of the sensor and are left out.
class CloudBuilder {
 public:
  explicit CloudBuilder(std::int64_t points) : points_(points, 3) {}

  /// What is wrong with the point; empty if it was added or left out.
  std::string add(const Eigen::RowVector3d& point) {
    if (point.allFinite())
      points_.row(used_++) = point;
    else if (!point.array().isNaN().all())
      return "found the point " + to_text(point(0)) + " " + to_text(point(1)) + " " + to_text(point(2)) +
             ", expected three finite coordinates, or three nan where the sensor saw nothing";
    return "";
  }
  StoredMesh take() {
    points_.conservativeResize(used_, 3);
    StoredMesh cloud;
    cloud.vertices = std::move(points_);
    return cloud;
  }

 private:
  Points points_;
  Eigen::Index used_ = 0;
};

StoredMesh read_text(const PcdHeader& header, LineReader& reader) {
  const std::size_t values = header.values_per_point(), bytes = reader.rest().size();
  // The shortest value takes two bytes: a digit and a separator.
  if (static_cast<std::size_t>(header.points) > bytes / (2 * values))
    reader.fail("the header promises " + std::to_string(header.points) + " points of " + std::to_string(values) +
                " values, but only " + std::to_string(bytes) + " bytes follow");
  CloudBuilder cloud(header.points);
  for (std::int64_t row = 0; row < header.points; ++row) {
    reader.need("point " + std::to_string(row) + " of " + std::to_string(header.points));
    const auto& found = reader.fields();
    if (found.size() != values)
      reader.fail("found " + std::to_string(found.size()) + " values, expected " + std::to_string(values));
    Eigen::RowVector3d point;
    std::size_t next = 0;
    for (const PcdField& field : header.fields)
      for (std::int64_t i = 0; i < field.count; ++i) {
        const double value = parse_number(reader, found[next++], field.type, field.type_name);
        if (field.axis >= 0) point(field.axis) = value;
      }
    const std::string problem = cloud.add(point);
    if (!problem.empty()) reader.fail(problem);
  }
  if (reader.next())
    reader.fail("found " + quoted(reader.line()) + " after the last point, expected the end of the file");
  return cloud.take();
}

/// The library's own writer pads a file: after the last point follow as many zero bytes as the header leaves free in a page
/// of memory.
bool is_page_filler(std::string_view left, std::size_t header_bytes) {
  for (const std::size_t page : {4096U, 16384U, 65536U})
    if (header_bytes + left.size() == page) return left.find_first_not_of('\0') == std::string_view::npos;
  return false;
}

StoredMesh read_binary(const PcdHeader& header, std::string_view body, const std::string& path,
                       std::size_t header_bytes) {
  const auto points = static_cast<std::size_t>(header.points);
  const std::size_t stride = header.bytes_per_point();
  if (points > body.size() / stride)
    throw IoError(path, "header",
                  "promises " + std::to_string(points) + " points of " + std::to_string(stride) + " bytes, but only " +
                      std::to_string(body.size()) + " bytes follow");
  const std::string_view left = body.substr(points * stride);
  if (!left.empty() && !is_page_filler(left, header_bytes))
    throw IoError(path, "byte " + std::to_string(points * stride) + " after the header",
                  std::to_string(left.size()) + " bytes follow the last point, expected the end of the file");
  CloudBuilder cloud(header.points);
  for (std::size_t row = 0; row < points; ++row) {
    Eigen::RowVector3d point;
    std::size_t at = row * stride;
    for (const PcdField& field : header.fields) {
      if (field.axis >= 0) point(field.axis) = decode_number(field.type, body.data() + at);
      at += static_cast<std::size_t>(field.count) * field.type.bytes;
    }
    const std::string problem = cloud.add(point);
    if (!problem.empty())
      throw IoError(path, "byte " + std::to_string(row * stride) + " after the header",
                    problem + " (point " + std::to_string(row) + " of " + std::to_string(points) + ")");
  }
  return cloud.take();
}

}  // namespace

StoredMesh parse_pcd(const std::string& path, std::string_view content) {
  LineReader reader(path, content, '#');
  const PcdHeader header = parse_pcd_header(reader);
  if (header.encoding == PcdEncoding::Ascii) return read_text(header, reader);
  const std::string_view body = reader.rest();
  return read_binary(header, body, path, content.size() - body.size());
}

}  // namespace corral
