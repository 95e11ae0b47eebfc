// SPDX-License-Identifier: MIT
// PLY: a text header that names elements and their properties, then the elements as lines of text or as packed bytes.
#include <algorithm>

#include "io/mesh/mesh_cleanup.h"
#include "io/mesh/ply_body.h"
#include "kernel/error.h"
#include "kernel/surface/scan/grid_triangulation.h"

namespace corral {
namespace {

using Values = std::vector<std::int64_t>;

class MeshReader {
 public:
  MeshReader(const std::string& path, const PlyHeader& header, PlyBody& body)
      : path_(path), header_(header), body_(body) {
    for (const PlyElement& element : header_.elements)
      if (element.name == "vertex") vertices_ = element.count;
  }

  StoredMesh read() {
    if (vertices_ < 0) throw IoError(path_, "header", "no element vertex, expected one");
    for (const PlyElement& element : header_.elements) {
      check_size(element);
      if (!element.properties.empty() || element.name == "vertex") body_.read(element, wanted(element));
    }
    body_.note_end(mesh_.notes);
    add_grid();
    mesh_.triangles = triangles_.build();
    return cleaned(std::move(mesh_));
  }

 private:
  /// An element cannot hold more than the bytes that are there.
  void check_size(const PlyElement& element) const {
    const std::size_t smallest = body_.smallest(element);
    if (smallest > 0 && static_cast<std::size_t>(element.count) > body_.bytes_left() / smallest + 1)
      throw IoError(path_, "header",
                    "promises " + std::to_string(element.count) + " of element " + quoted(element.name) +
                        ", but only " + std::to_string(body_.bytes_left()) + " bytes follow");
  }

  PlyWanted wanted(const PlyElement& element) {
    if (element.name == "vertex") return wanted_of_vertices(element);
    if (element.name == "face") {
      triangles_.reserve(element.count);
      return {{}, corners_of(element), [this](const Values& corners) { add_face(corners); }};
    }
    if (element.name == "tristrips")
      return {{}, corners_of(element), [this](const Values& strips) { add_strips(strips); }};
    if (element.name == "range_grid") {
      cells_.reserve(static_cast<std::size_t>(element.count));
      return {{}, corners_of(element), [this](const Values& cell) { add_cell(cell); }};
    }
    return {};
  }

  PlyWanted wanted_of_vertices(const PlyElement& element) {
    PlyWanted wanted;
    const auto add = [&](Points& points, const char* const(&names)[3], bool are_coordinates) {
      int places[3];
      for (int axis = 0; axis < 3; ++axis) {
        places[axis] = element.find(names[axis]);
        if (places[axis] < 0 || element.properties[static_cast<std::size_t>(places[axis])].count_type) return false;
      }
      points.resize(element.count, 3);
      for (int axis = 0; axis < 3; ++axis)
        wanted.columns.push_back({places[axis], points.col(axis).data(), are_coordinates});
      return true;
    };
    if (!add(mesh_.vertices, {"x", "y", "z"}, true))
      throw IoError(path_, "header", "element vertex lacks a coordinate, expected properties x, y and z");
    add(mesh_.normals, {"nx", "ny", "nz"}, false);
    return wanted;
  }

  int corners_of(const PlyElement& element) const {
    const int place = std::max(element.find("vertex_indices"), element.find("vertex_index"));
    if (place < 0 || !element.properties[static_cast<std::size_t>(place)].count_type ||
        element.properties[static_cast<std::size_t>(place)].type->kind == 'f')
      throw IoError(path_, "header",
                    "element " + element.name + " lacks its corners, expected a list of whole numbers vertex_indices");
    return place;
  }

  void check_corner(std::int64_t corner) const {
    if (corner < 0 || corner >= vertices_)
      body_.fail("a corner is " + (corner < 0 ? std::to_string(corner) : "vertex " + std::to_string(corner)) +
                 ", expected " +
                 (vertices_ > 0 ? "0 .. " + std::to_string(vertices_ - 1) : "none: there are no vertices"));
  }

  void add_face(const Values& corners) {
    if (corners.size() < 3)
      body_.fail("a face of " + std::to_string(corners.size()) + " corners, expected at least three");
    for (const std::int64_t corner : corners) check_corner(corner);
    triangles_.add_polygon(corners);
  }

  /// Each corner and the two before it are a triangle, wound the other way at every second; -1 begins another strip. A strip
  /// that repeats a corner turns there: that is no triangle.
  void add_strips(const Values& strips) {
    std::size_t first = 0;
    for (std::size_t i = 0; i < strips.size(); ++i) {
      if (strips[i] == -1) {
        first = i + 1;
        continue;
      }
      check_corner(strips[i]);
      if (i < first + 2) continue;
      const bool is_turned = (i - first) % 2 == 1;
      const auto corner = [&](std::size_t at) { return static_cast<int>(strips[at]); };
      const int a = corner(i - 2 + is_turned), b = corner(i - 1 - is_turned), c = corner(i);
      if (a != b && b != c && c != a) triangles_.add(a, b, c);
    }
  }

  void add_cell(const Values& cell) {
    if (cell.size() > 1)
      body_.fail("a cell of " + std::to_string(cell.size()) + " vertices in the range grid, expected none or one");
    if (!cell.empty()) check_corner(cell[0]);
    cells_.push_back(cell.empty() ? -1 : static_cast<int>(cell[0]));
  }

  void add_grid() {
    if (cells_.empty()) return;
    if (!triangles_.empty()) {
      mesh_.notes.push_back("the range grid was not read, as the file has faces of its own");
      return;
    }
    const auto cells = static_cast<std::int64_t>(cells_.size());
    if (header_.grid_columns < 1 || header_.grid_columns * header_.grid_rows != cells) {
      mesh_.notes.push_back("the range grid of " + std::to_string(cells) +
                            " cells gives no faces: expected obj_info num_cols and num_rows whose product that is");
      return;
    }
    const Triangles faces = triangulate_grid(mesh_.vertices, cells_, header_.grid_columns);
    for (Eigen::Index face = 0; face < faces.rows(); ++face)
      triangles_.add(faces(face, 0), faces(face, 1), faces(face, 2));
  }

  const std::string& path_;
  const PlyHeader& header_;
  PlyBody& body_;
  StoredMesh mesh_;
  std::int64_t vertices_ = -1;
  TriangleBuilder triangles_;
  Indices cells_;  // the vertex of each cell of the range grid, -1 for none
};

}  // namespace

StoredMesh parse_ply(const std::string& path, std::string_view content) {
  LineReader reader(path, content);
  const PlyHeader header = parse_ply_header(reader);
  const auto body = header.encoding == PlyEncoding::Ascii
                        ? ply_text_body(reader)
                        : ply_binary_body(path, reader.rest(), header.encoding == PlyEncoding::Big);
  return MeshReader(path, header, *body).read();
}

}  // namespace corral
