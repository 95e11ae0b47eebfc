// SPDX-License-Identifier: MIT
#include "kernel/surface/scan/visibility.h"

#include <algorithm>
#include <numeric>

#include "kernel/surface/search/nearest_points.h"

namespace corral {
namespace {

/// For each point under the motion the nearest of others, -1 if none is within the threshold.
Indices nearest_within(const Points& points, const Points& others, const RigidTransform& motion, double threshold) {
  const PointTree tree(others);
  return NearestTracker(tree).nearest(motion.apply(points), threshold);
}

double face_area(const Mesh& mesh, Eigen::Index face) {
  const auto corner = [&](int i) -> Eigen::Vector3d { return mesh.vertices.row(mesh.triangles(face, i)); };
  return triangle_area(corner(0), corner(1), corner(2));
}

}  // namespace

Points overlap_points(const Points& source, const PointIndex& target_index, const RigidTransform& target_from_source,
                      double threshold) {
  const Points moved = target_from_source.apply(source);
  Indices shared;
  for (Eigen::Index row = 0; row < source.rows(); ++row) {
    const auto nearest = target_index.nearest(moved.row(row).transpose(), 1);
    if (!nearest.empty() && nearest.front().squared_distance <= threshold * threshold)
      shared.push_back(static_cast<int>(row));
  }
  return source(shared, Eigen::all);
}

double overlap_share(const Points& source, const Points& target, const RigidTransform& target_from_source,
                     double threshold) {
  const auto least = std::min(source.rows(), target.rows());
  if (least == 0) return 0;
  const auto count = [&](const Points& from, const Points& to, const RigidTransform& motion) {
    const Indices nearest = nearest_within(from, to, motion, threshold);
    return std::count_if(nearest.begin(), nearest.end(), [](int row) { return row >= 0; });
  };
  const auto shared =
      std::min(count(source, target, target_from_source), count(target, source, target_from_source.inverse()));
  return static_cast<double>(shared) / static_cast<double>(least);
}

std::optional<double> shared_area(const Mesh& surface, const Points& other, const RigidTransform& other_from_surface,
                                  double threshold) {
  const Indices nearest = nearest_within(surface.vertices, other, other_from_surface, threshold);
  const auto is_near = [&](int vertex) { return nearest[static_cast<std::size_t>(vertex)] >= 0; };
  double shared = 0, whole = 0;
  for (Eigen::Index face = 0; face < surface.triangles.rows(); ++face) {
    const double area = face_area(surface, face);
    whole += area;
    if (is_near(surface.triangles(face, 0)) && is_near(surface.triangles(face, 1)) &&
        is_near(surface.triangles(face, 2)))
      shared += area;
  }
  if (!(whole > 0)) return std::nullopt;
  return shared / whole;
}

double surface_area(const Mesh& mesh) {
  double area = 0;
  for (Eigen::Index face = 0; face < mesh.triangles.rows(); ++face) area += face_area(mesh, face);
  return area;
}

std::vector<Visibility> measure_visibility(const PosedSurfaces& scene, const RangeScan& scan) {
  const double whole = std::accumulate(scan.patch_areas.begin(), scan.patch_areas.end(), 0.0);
  std::vector<Visibility> shown;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const double patch = scan.patch_areas[i];
    shown.push_back({1 - patch / surface_area(scene[i].surface->mesh()), whole > 0 ? 1 - patch / whole : 1});
  }
  return shown;
}

}  // namespace corral
