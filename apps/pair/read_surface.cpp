// SPDX-License-Identifier: MIT
#include "apps/pair/read_surface.h"

#include <cmath>

#include "io/mesh/mesh_file.h"
#include "kernel/bounding_box.h"
#include "kernel/error.h"

namespace corral {

StoredMesh read_surface(const std::string& path) {
  StoredMesh mesh = read_mesh(path);
  const double diagonal = bounding_box(mesh.vertices).diagonal();
  if (!std::isfinite(diagonal))
    throw IoError(path, "", "its coordinates are too large for distances, expected an extent whose square is finite");
  std::string notes;
  for (const std::string& note : mesh.notes) notes += "; " + note;
  if (mesh.vertices.rows() == 0) throw IoError(path, "", "has no vertices, expected a surface" + notes);
  if (!(diagonal > 0))
    throw IoError(path, "",
                  "all its " + std::to_string(mesh.vertices.rows()) + " vertices coincide, expected " +
                      "at least two distinct ones (the resolution would be zero)");
  return mesh;
}

}  // namespace corral
