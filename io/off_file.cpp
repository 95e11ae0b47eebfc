// SPDX-License-Identifier: MIT
// OFF: a keyword, three counts, one line per vertex, one line per face (its size first; what follows the corners is
// colour).
#include "io/line_reader.h"
#include "io/mesh_file.h"

namespace corral {
namespace {

/// With these keywords normals or colours follow the coordinates.
bool is_keyword(std::string_view word) { return word == "OFF" || word == "COFF" || word == "NOFF" || word == "CNOFF"; }

struct Counts {
  std::int64_t vertices, faces;
};

Counts read_counts(LineReader& reader) {
  reader.need("the keyword OFF");
  auto fields = reader.fields();
  if (!is_keyword(fields[0])) reader.fail("found " + quoted(fields[0]) + ", expected the keyword OFF");
  if (fields.size() > 1 && fields[1] == "BINARY") reader.fail("binary OFF is not supported, expected text");
  if (fields.size() == 1) {
    reader.need("the numbers of vertices, faces and edges");
    fields = reader.fields();
  } else {
    fields.erase(fields.begin());
  }
  if (fields.size() < 2 || fields.size() > 3)
    reader.fail("found " + std::to_string(fields.size()) +
                " fields, expected the numbers of vertices, faces and edges");
  // The shortest line of a vertex takes 6 bytes ("0 0 0\n"), of a face 2 ("0\n").
  const auto bytes = static_cast<std::int64_t>(reader.rest().size());
  const Counts counts{reader.integer(fields[0], 0, kMaximumCount, "the number of vertices"),
                      reader.integer(fields[1], 0, kMaximumCount, "the number of faces")};
  if (fields.size() == 3) reader.integer(fields[2], 0, 4 * kMaximumCount, "the number of edges");
  if (6 * counts.vertices + 2 * counts.faces > bytes)
    reader.fail("the header promises " + std::to_string(counts.vertices) + " vertices and " +
                std::to_string(counts.faces) + " faces, but only " + std::to_string(bytes) + " bytes follow");
  return counts;
}

}  // namespace

StoredMesh parse_off(const std::string& path, std::string_view content) {
  LineReader reader(path, content, '#');
  const Counts counts = read_counts(reader);
  StoredMesh mesh;
  mesh.vertices.resize(counts.vertices, 3);
  for (Eigen::Index row = 0; row < counts.vertices; ++row) {
    reader.need("vertex " + std::to_string(row) + " of " + std::to_string(counts.vertices));
    const auto& fields = reader.fields();
    if (fields.size() < 3)
      reader.fail("found " + std::to_string(fields.size()) + " fields, expected three coordinates");
    for (int axis = 0; axis < 3; ++axis)
      mesh.vertices(row, axis) = reader.finite_number(fields[static_cast<std::size_t>(axis)]);
  }
  TriangleBuilder triangles;
  Indices corners;
  for (std::int64_t face = 0; face < counts.faces; ++face) {
    reader.need("face " + std::to_string(face) + " of " + std::to_string(counts.faces));
    const auto& fields = reader.fields();
    const auto size = static_cast<std::size_t>(reader.integer(fields[0], 3, kMaximumCount, "the size of a face"));
    if (fields.size() - 1 < size)
      reader.fail("found " + std::to_string(fields.size() - 1) + " corners, expected " + std::to_string(size));
    corners.clear();
    for (std::size_t i = 1; i <= size; ++i)
      corners.push_back(static_cast<int>(reader.integer(fields[i], 0, counts.vertices - 1, "a corner")));
    triangles.add_polygon(corners);
  }
  if (reader.next())
    reader.fail("found " + quoted(reader.line()) + " after the last face, expected the end of the file");
  mesh.triangles = triangles.build();
  return mesh;
}

}  // namespace corral
