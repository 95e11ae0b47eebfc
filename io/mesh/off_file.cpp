// SPDX-License-Identifier: MIT
// OFF: a keyword, three counts, one line per vertex, one line per face (its size first; what follows the corners is
// colour).
#include <algorithm>

#include "io/mesh/mesh_cleanup.h"
#include "io/text/line_reader.h"

namespace corral {
namespace {

struct Header {
  std::int64_t vertices = 0, faces = 0;
  int normal = -1;  ///< the column of a vertex's normal, if it has one
};

/// Where a keyword such as OFF, NOFF, STCNOFF ends; npos if the line does not begin with one. Letters in front of OFF tell what
/// follows the coordinates: C colours, N normals, ST texture.
std::size_t keyword_end(std::string_view line) {
  const std::size_t end = line.find("OFF");
  if (end == std::string_view::npos) return end;
  const std::string_view letters = line.substr(0, end);
  return letters.find_first_not_of("STCN4n") == std::string_view::npos ? end + 3 : std::string_view::npos;
}

/// Geomview writes normals in front of colours and says CN; MeshLab writes them behind four values of colour and says NC.
int normal_column(std::string_view letters) {
  const std::size_t normal = letters.find('N'), colour = letters.find('C');
  if (normal == std::string_view::npos) return -1;
  return colour != std::string_view::npos && normal < colour ? 7 : 3;
}

std::int64_t count_of(LineReader& reader, const std::string& what) {
  return reader.integer(reader.take(), 0, kMaximumCount, "the number of " + what);
}

Header read_header(LineReader& reader) {
  reader.need("the keyword OFF");
  const std::string_view line = reader.line();
  const std::size_t end = keyword_end(line);
  if (end == std::string_view::npos) reader.fail("found " + quoted(reader.take()) + ", expected the keyword OFF");
  const std::string_view letters = line.substr(0, end - 3);
  if (letters.find_first_of("4n") != std::string_view::npos)
    reader.fail("found " + quoted(line.substr(0, end)) +
                ", vertices of more or fewer than three coordinates: expected OFF");
  Header header;
  header.normal = normal_column(letters);
  reader.skip_letters(end);  // ModelNet's files have no space between the keyword and the counts
  if (reader.untaken().find("BINARY") != std::string_view::npos)
    reader.fail("binary OFF is not supported, expected text");
  if (reader.untaken().empty()) reader.need("the numbers of vertices, faces and edges");
  header.vertices = count_of(reader, "vertices");
  header.faces = count_of(reader, "faces");
  if (const std::string_view edges = reader.take(); !edges.empty())
    reader.integer(edges, 0, 4 * kMaximumCount, "the number of edges");
  if (!reader.take().empty()) reader.fail("found more fields, expected the numbers of vertices, faces and edges");
  // The shortest line of a vertex takes 6 bytes ("0 0 0\n"), of a face 2 ("0\n"); the last may lack its end.
  const auto bytes = static_cast<std::int64_t>(reader.rest().size());
  if (6 * header.vertices + 2 * header.faces > bytes + 1)
    reader.fail("the header promises " + std::to_string(header.vertices) + " vertices and " +
                std::to_string(header.faces) + " faces, but only " + std::to_string(bytes) + " bytes follow");
  return header;
}

void read_vertex(LineReader& reader, const Header& header, Eigen::Index row, StoredMesh& mesh) {
  for (int column = 0; column < std::max(3, header.normal + 3); ++column) {
    const std::string_view field = reader.take();
    if (field.empty())
      reader.fail("found " + std::to_string(column) + " fields, expected three coordinates" +
                  (header.normal < 0    ? ""
                   : header.normal == 3 ? " and a normal"
                                        : ", four values of colour and a normal"));
    if (column < 3)
      mesh.vertices(row, column) = reader.coordinate(field);
    else if (column >= header.normal)
      mesh.normals(row, column - header.normal) = reader.number(field);
  }
}

}  // namespace

StoredMesh parse_off(const std::string& path, std::string_view content) {
  LineReader reader(path, content, '#');
  reader.allow_comments_behind();
  reader.allow_open_end();
  const Header header = read_header(reader);
  StoredMesh mesh;
  mesh.vertices.resize(header.vertices, 3);
  if (header.normal >= 0) mesh.normals.resize(header.vertices, 3);
  for (Eigen::Index row = 0; row < header.vertices; ++row) {
    if (!reader.next()) reader.fail_at_end("vertex " + std::to_string(row) + " of " + std::to_string(header.vertices));
    read_vertex(reader, header, row, mesh);
  }
  TriangleBuilder triangles;
  triangles.reserve(header.faces);
  std::vector<std::int64_t> corners;
  for (std::int64_t face = 0; face < header.faces; ++face) {
    if (!reader.next()) reader.fail_at_end("face " + std::to_string(face) + " of " + std::to_string(header.faces));
    const std::int64_t size = reader.integer(reader.take(), 3, kMaximumCount, "the size of a face");
    for (corners.clear(); static_cast<std::int64_t>(corners.size()) < size;) {
      const std::string_view field = reader.take();
      if (field.empty())
        reader.fail("found " + std::to_string(corners.size()) + " corners, expected " + std::to_string(size));
      corners.push_back(reader.integer(field, 0, header.vertices - 1, "a corner"));
    }
    triangles.add_polygon(corners);
  }
  note_ending(reader, header.faces > 0 ? "face" : "vertex", mesh.notes);
  mesh.triangles = triangles.build();
  return cleaned(std::move(mesh));
}

}  // namespace corral
