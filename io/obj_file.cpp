// SPDX-License-Identifier: MIT
// OBJ: lines of vertices (v) and faces (f) among others without geometry; corners count from 1, or backwards from -1.
#include <array>

#include "io/line_reader.h"
#include "io/mesh_file.h"

namespace corral {
namespace {

/// Keywords of lines without geometry.
bool is_ignored(std::string_view keyword) {
  constexpr std::array<std::string_view, 19> kIgnored = {
      "vn", "vt",     "vp",     "g",   "o",     "s",        "usemtl",   "mtllib",     "l",        "p",
      "mg", "usemap", "maplib", "lod", "bevel", "c_interp", "d_interp", "shadow_obj", "trace_obj"};
  for (const std::string_view ignored : kIgnored)
    if (keyword == ignored) return true;
  return false;
}

int corner_of(const LineReader& reader, std::string_view field, std::int64_t vertices) {
  const std::string_view index = field.substr(0, field.find('/'));
  const bool backwards = index.substr(0, 1) == "-";
  const std::int64_t low = backwards ? -vertices : 1, high = backwards ? -1 : vertices;
  const std::int64_t corner = reader.integer(index, low, high, "a corner");
  return static_cast<int>(corner > 0 ? corner - 1 : vertices + corner);
}

}  // namespace

StoredMesh parse_obj(const std::string& path, std::string_view content) {
  LineReader reader(path, content, '#');
  std::vector<double> coordinates;
  TriangleBuilder triangles;
  Indices corners;
  while (reader.next()) {
    const auto& fields = reader.fields();
    const auto vertices = static_cast<std::int64_t>(coordinates.size() / 3);
    if (fields[0] == "v") {
      if (fields.size() < 4)
        reader.fail("found " + std::to_string(fields.size() - 1) + " fields, expected three coordinates");
      if (vertices == kMaximumCount) reader.fail("more vertices than can be counted");
      for (std::size_t axis = 1; axis <= 3; ++axis) coordinates.push_back(reader.finite_number(fields[axis]));
    } else if (fields[0] == "f") {
      if (fields.size() < 4)
        reader.fail("found " + std::to_string(fields.size() - 1) + " corners, expected at least three");
      corners.clear();
      for (std::size_t i = 1; i < fields.size(); ++i) corners.push_back(corner_of(reader, fields[i], vertices));
      triangles.add_polygon(corners);
    } else if (!is_ignored(fields[0])) {
      reader.fail("found " + quoted(fields[0]) + ", expected an OBJ keyword");
    }
  }
  if (coordinates.empty()) reader.fail("no vertex line, expected lines like 'v 0 0 0'");
  StoredMesh mesh;
  mesh.vertices = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>(
      coordinates.data(), static_cast<Eigen::Index>(coordinates.size() / 3), 3);
  mesh.triangles = triangles.build();
  return mesh;
}

}  // namespace corral
