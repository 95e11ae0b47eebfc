// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kernel/surface/mesh/mesh.h"

namespace corral {

/// The endings of the names that read_mesh accepts, for messages: ".ply, .off, ... or .pcd".
std::string mesh_endings();

/// Whether read_mesh knows the ending of the name.
bool is_mesh_name(const std::string& path);

/// A mesh with what its reader has to say.
struct StoredMesh : Mesh {
  std::vector<std::string> notes = {};  ///< what was left out or skipped, with counts: a sentence each, no full stop
};

/// Reads a mesh or a point cloud; the ending of the name gives the format: .ply (ASCII and both binary forms), .off, .obj,
/// .stl (ASCII and binary), and for clouds only .xyz and .pcd (ASCII and binary, not compressed).
/// Vertices keep their order; polygons become triangle fans. Counts are checked against the bytes that are there before
/// anything is allocated.
///   STL  corners at exactly the same place are one vertex (-0 is +0), numbered as they first appear; a facet that
///        repeats a corner stays. The normals are not read.
///   XYZ  one point per line, separated by white space or commas; columns after the third are not read.
///   PCD  points whose x, y and z are all nan are missing returns of the sensor and left out. The pose of the sensor
///        (VIEWPOINT) is not applied.
/// Throws    IoError that names the file, the line or byte, and what was expected there: missing, empty, cut short, more or
///           less than the header promises, a coordinate that is not finite, a face with a vertex that does not exist.
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
StoredMesh parse_xyz(const std::string& path, std::string_view content);
StoredMesh parse_pcd(const std::string& path, std::string_view content);

/// The most vertices or faces a mesh may have: they are counted in int.
constexpr long long kMaximumCount = 2147483647;

/// Collects polygons as triangle fans around their first corner.
class TriangleBuilder {
 public:
  void add_polygon(const Indices& corners);
  Triangles build() const;

 private:
  Indices corners_;
};

}  // namespace corral
