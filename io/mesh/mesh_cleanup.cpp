// SPDX-License-Identifier: MIT
#include "io/mesh/mesh_cleanup.h"

#include <utility>
#include <vector>

namespace corral {
namespace {

/// The new number of each vertex, -1 for those without a place.
Indices numbers_of_kept(const Points& vertices) {
  Indices numbers(static_cast<std::size_t>(vertices.rows()));
  int next = 0;
  for (Eigen::Index row = 0; row < vertices.rows(); ++row)
    numbers[static_cast<std::size_t>(row)] = vertices.row(row).array().isNaN().any() ? -1 : next++;
  return numbers;
}

void keep_rows(Points& points, const Indices& numbers, Eigen::Index kept) {
  if (points.rows() == 0) return;
  for (std::size_t row = 0; row < numbers.size(); ++row)
    if (numbers[row] >= 0) points.row(numbers[row]) = points.row(static_cast<Eigen::Index>(row)).eval();
  points.conservativeResize(kept, 3);
}

void keep_faces(Triangles& triangles, const Indices& numbers) {
  Eigen::Index kept = 0;
  for (Eigen::Index face = 0; face < triangles.rows(); ++face) {
    Eigen::RowVector3i corners;
    for (int i = 0; i < 3; ++i) corners(i) = numbers[static_cast<std::size_t>(triangles(face, i))];
    if ((corners.array() >= 0).all()) triangles.row(kept++) = corners;
  }
  triangles.conservativeResize(kept, 3);
}

void leave_out_missing(StoredMesh& mesh) {
  if (!mesh.vertices.hasNaN()) return;
  const Eigen::Index vertices = mesh.vertices.rows(), faces = mesh.triangles.rows();
  const Indices numbers = numbers_of_kept(mesh.vertices);
  Eigen::Index kept = 0;
  for (const int number : numbers) kept += number >= 0;
  keep_rows(mesh.vertices, numbers, kept);
  keep_rows(mesh.normals, numbers, kept);
  keep_faces(mesh.triangles, numbers);
  std::string note = counted(vertices - kept, "vertex", "vertices") + " with a nan coordinate";
  if (mesh.triangles.rows() < faces)
    note += " and " + counted(faces - mesh.triangles.rows(), "face", "faces") + " that used them";
  mesh.notes.push_back(note + (vertices - kept == 1 && mesh.triangles.rows() == faces ? " was" : " were") +
                       " left out");
}

void tell_misses(StoredMesh& mesh) {
  const auto is_zero = mesh.vertices.array() == 0;
  const auto misses = (is_zero.col(0) && is_zero.col(1) && is_zero.col(2)).count();
  if (misses < 2) return;
  mesh.notes.push_back(
      std::to_string(misses) +
      " vertices are at exactly (0, 0, 0), where many sensors write missing returns: if these are not on "
      "the surface, take them out of the file or write nan for them");
}

void check_normals(StoredMesh& mesh) {
  Eigen::Index unknown = 0;
  if (!mesh.normals.allFinite())
    for (Eigen::Index row = 0; row < mesh.normals.rows(); ++row) {
      if (mesh.normals.row(row).allFinite()) continue;
      mesh.normals.row(row).setZero();
      ++unknown;
    }
  if ((mesh.normals.array() == 0).all())
    mesh.normals.resize(0, 3);
  else if (unknown > 0)
    mesh.notes.push_back(counted(unknown, "normal is", "normals are") + " not finite: taken as unknown");
}

}  // namespace

const char* const kOpenEndNote = "the last line lacks its newline: the file may have been cut short there";

std::string counted(long long count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

std::string unread_note(std::size_t bytes, const std::string& after) {
  return counted(static_cast<long long>(bytes), "byte", "bytes") + " after the last " + after +
         " that the file promises " + (bytes == 1 ? "was" : "were") + " not read";
}

void note_ending(LineReader& reader, const std::string& after, std::vector<std::string>& notes) {
  if (reader.lacks_end()) return notes.push_back(kOpenEndNote);
  const std::size_t left = reader.rest().size();
  if (reader.next()) notes.push_back(unread_note(left, after));
}

Points points_of_rows(const std::vector<double>& numbers) {
  return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>(
      numbers.data(), static_cast<Eigen::Index>(numbers.size() / 3), 3);
}

StoredMesh cleaned(StoredMesh mesh) {
  leave_out_missing(mesh);
  tell_misses(mesh);
  check_normals(mesh);
  return mesh;
}

}  // namespace corral
