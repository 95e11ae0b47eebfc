// SPDX-License-Identifier: MIT
#include "kernel/surface/mesh/sound_triangles.h"

#include <utility>

#include "kernel/rigid_transform.h"

namespace corral {
namespace {

bool is_degenerate(const Mesh& mesh, int face) {
  const int a = mesh.triangles(face, 0), b = mesh.triangles(face, 1), c = mesh.triangles(face, 2);
  if (a == b || b == c || c == a) return true;
  return !(triangle_area(mesh.vertices.row(a), mesh.vertices.row(b), mesh.vertices.row(c)) > 0);
}

}  // namespace

SoundTriangles::SoundTriangles(const Mesh& mesh) : given_(mesh.triangles) {
  const auto faces = static_cast<int>(given_.rows());
  for (int face = 0; face < faces; ++face) degenerate_ += is_degenerate(mesh, face);
  if (degenerate_ > 0) {
    Indices sound;
    for (int face = 0; face < faces; ++face)
      if (!is_degenerate(mesh, face)) sound.push_back(face);
    changed_ = given_(sound, Eigen::all);
  }
  joined_ = join_sides((*this)(), mesh.vertices.rows());
  const Indices against = wound_against_majority((*this)(), joined_.across);
  reversed_ = static_cast<int>(against.size());
  if (reversed_ == 0) return;
  if (!changed_) changed_ = given_;
  for (const int face : against) turn(face);
}

void SoundTriangles::turn(int face) {
  std::swap((*changed_)(face, 1), (*changed_)(face, 2));  // its first and last side change places
  const auto [first, second, last] = Ends(*changed_).sides_of(face);
  std::swap(joined_.across[index(first)], joined_.across[index(last)]);
  for (const int side : {first, last})
    if (const int other = joined_.across[index(side)]; other >= 0) joined_.across[index(other)] = side;
}

}  // namespace corral
