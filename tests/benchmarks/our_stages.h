// SPDX-License-Identifier: MIT
#pragma once

// Every call that is compared with another library, in one place. Each does what a program would: it builds what it
// searches in. The options are the paper's.

#include "apps/pair/match_pair.h"
#include "kernel/surface/feature_matching.h"
#include "kernel/surface/fpfh.h"
#include "kernel/surface/harris.h"
#include "kernel/surface/iss.h"
#include "kernel/surface/normals.h"
#include "kernel/surface/search/neighborhood.h"
#include "kernel/surface/search/point_grid.h"
#include "kernel/surface/search/resolution.h"
#include "kernel/surface/shot.h"

namespace corral::ours {

inline double resolution(const Mesh& mesh) { return point_resolution(mesh.vertices); }

/// How many pairs of vertices lie within a radius, by the grid of the hot loops.
inline double pairs_by_grid(const Mesh& mesh, double radius) {
  const PointGrid grid = PointGrid::for_radius(mesh.vertices, radius, 1);
  const CellNeighborhoods around(grid, 1);
  double pairs = 0;
  vectorized([&](auto kind) {
    using Lanes = typename decltype(kind)::Lanes;
    Lanes count = Lanes::fill(0);
    PackedSlots<3> places;
    for (int cell = 0; cell < grid.cells(); ++cell) {
      places.collect<Lanes>({&grid.x(), &grid.y(), &grid.z()}, around.begin(cell), around.end(cell));
      for (auto slot = static_cast<std::size_t>(grid.begin(cell)); slot < static_cast<std::size_t>(grid.end(cell));
           ++slot)
        visit_within<Lanes>(places, grid.x()[slot], grid.y()[slot], grid.z()[slot], radius * radius,
                            [&](auto inside, Lanes, Lanes, Lanes, int) {
                              count = count + select(inside, Lanes::fill(1), Lanes::fill(0));
                            });
    }
    pairs = sum(count);
  });
  return pairs;
}

/// The same by CGAL's tree.
inline double pairs_by_tree(const Mesh& mesh, double radius) {
  const PointIndex index(mesh.vertices);
  double pairs = 0;
  for (Eigen::Index row = 0; row < mesh.vertices.rows(); ++row)
    pairs += static_cast<double>(index.within(mesh.vertices.row(row).transpose(), radius).size());
  return pairs;
}

/// The 20 nearest of every vertex by CGAL's tree: what our normals would have to begin with.
inline double nearest_by_tree(const Mesh& mesh) {
  const PointIndex index(mesh.vertices);
  double farthest = 0;
  for (Eigen::Index row = 0; row < mesh.vertices.rows(); ++row)
    farthest = std::max(farthest, index.nearest(mesh.vertices.row(row).transpose(), 20).back().squared_distance);
  return farthest;
}

inline Points normals(const Mesh& mesh) { return estimate_normals(mesh); }

inline Indices harris(const Mesh& mesh, double resolution, double radius_pr = 3) {
  return detect_harris(mesh.vertices, resolution, {radius_pr}).vertices;
}

/// The response of every vertex.
inline Eigen::VectorXd response(const Mesh& mesh, double radius) { return harris_response(mesh.vertices, radius); }

inline Descriptors shot(const Mesh& mesh, const Points& normals, const Indices& keypoints, double resolution,
                        ShotForm form = ShotForm::Additive) {
  return describe_shot(mesh.vertices, normals, keypoints, resolution, {15, 10, form});
}

inline Indices iss(const Mesh& mesh, double resolution, IssWeights weights = IssWeights::Density) {
  IssOptions options;
  options.weights = weights;
  return detect_iss(mesh, resolution, options).vertices;
}

inline Descriptors fpfh(const Mesh& mesh, const Points& normals, const Indices& keypoints, double resolution,
                        FpfhForm form = FpfhForm::Paper) {
  return describe_fpfh(mesh.vertices, normals, keypoints, resolution, {15, 10, form});
}

inline FeatureMatches matching(const Descriptors& source, const Descriptors& target) {
  return match_features(source.features, target.features);
}

inline MatchedPair whole_match(const Mesh& source, const Mesh& target) {
  MatchSettings settings;
  settings.threads = 1;
  return match_pair(source, target, settings);
}

}  // namespace corral::ours
