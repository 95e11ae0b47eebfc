// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "io/mesh/mesh_file.h"
#include "io/text/line_reader.h"

namespace corral {

/// What every reader of meshes does last, the same for all formats.
///   missing points  vertices of which a coordinate is nan are left out with the faces that use them
///   misses          two or more vertices at exactly the origin are told, and stay
///   normals         one that is not finite is unknown (zero); if all are unknown there are none
/// Coordinates must not be infinite, and the corners of faces must be vertices.
StoredMesh cleaned(StoredMesh mesh);

/// For notes: "1 vertex", "2 vertices".
std::string counted(long long count, const std::string& one, const std::string& many);

/// The note on what follows the last element that the file promises.
std::string unread_note(std::size_t bytes, const std::string& after);

/// The note on a last line that is whole, as far as counts can tell.
extern const char* const kOpenEndNote;

/// Notes what follows the last element of a text, or that its line lacks its end.
void note_ending(LineReader& reader, const std::string& after, std::vector<std::string>& notes);

/// Rows of three numbers.
Points points_of_rows(const std::vector<double>& numbers);

}  // namespace corral
