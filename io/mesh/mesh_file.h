// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kernel/surface/mesh/mesh.h"

namespace corral {

/// The endings of the names that read_mesh accepts, for messages: ".ply, .off, ... or .csv (also with .gz behind)".
std::string mesh_endings();

/// Whether a file of this name is a mesh or point cloud, to find those in a folder: not for .txt, .asc and .csv, which other
/// files end in too.
bool is_mesh_name(const std::string& path);

/// A mesh with what its reader has to say.
struct StoredMesh : Mesh {
  std::vector<std::string> notes = {};  ///< what was left out or skipped, with counts: a sentence each, no full stop
};

/// Reads a mesh or a point cloud; the ending of the name gives the format: .ply, .off, .obj, .stl, and for clouds only .pcd,
/// .xyz, .pts, .asc, .txt and .csv; each may be compressed by gzip (.ply.gz). README.md of this folder says what is read of
/// each. Vertices keep their order; polygons become triangle fans. Counts are checked against the bytes that are there before
/// anything is allocated.
/// In all formats vertices of which a coordinate is nan are missing points: left out with the faces that use them, and
/// noted. Also noted are two or more vertices at exactly the origin, where sensors write misses, and what follows the last
/// element that a file promises.
/// Throws    IoError that names the file, the line or byte, and what was expected there: missing, empty, cut short, less than
///           the header promises, a coordinate that is infinite, a face with a vertex that does not exist.
StoredMesh read_mesh(const std::string& path);

/// The mesh as ASCII PLY in double precision; reading it back gives the same mesh.
std::string ply_text(const Mesh& mesh);

/// The same as binary little-endian PLY: about half the size, and much faster to write and read.
std::string binary_ply_text(const Mesh& mesh);

/// Writes the ASCII form to a name that ends in .ply. Throws IoError.
void write_mesh(const std::string& path, const Mesh& mesh);

/// Throws IoError unless the name ends in .ply, the only format that is written.
void check_ply_name(const std::string& path);

// One parser per format, on the whole content of a file; `path` is used in messages.
StoredMesh parse_ply(const std::string& path, std::string_view content);
StoredMesh parse_off(const std::string& path, std::string_view content);
StoredMesh parse_obj(const std::string& path, std::string_view content);
StoredMesh parse_stl(const std::string& path, std::string_view content);
StoredMesh parse_pcd(const std::string& path, std::string_view content);
StoredMesh parse_xyz(const std::string& path, std::string_view content);  // every list of points

/// The most vertices or faces a mesh may have: they are counted in int.
constexpr long long kMaximumCount = 2147483647;

/// Collects polygons as triangle fans around their first corner.
class TriangleBuilder {
 public:
  void reserve(std::int64_t triangles);
  void add(int a, int b, int c);
  void add_polygon(const std::vector<std::int64_t>& corners);
  bool empty() const { return corners_.empty(); }
  Triangles build() const;

 private:
  Indices corners_;
};

}  // namespace corral
