// SPDX-License-Identifier: MIT
#include "apps/align/view_set.h"

#include <algorithm>
#include <utility>

#include "kernel/surface/normals.h"
#include "kernel/surface/scan/view_side.h"
#include "kernel/surface/scan/visibility.h"
#include "kernel/surface/search/resolution.h"
#include "refine/refine_surface.h"

namespace corral {
namespace {

constexpr double kCellPr = 2;              // of the depth images
constexpr double kInFrontPr = 5;           // beyond noise and the error of a nearly correct pose
constexpr double kHopelessInFront = 0.06;  // worse poses are dropped before the finest level, most of the work
constexpr double kFarPr = 1e5;             // a sensor beyond this counts as infinitely far away

}  // namespace

ViewSet::ViewSet(const std::vector<Mesh>& views, const std::optional<ViewOptions>& sensor, const ParallelFor& parallel)
    : views_(views.size()) {
  for (const Mesh& view : views) sensors_.push_back(sensor ? *sensor : view_side(view));
  std::vector<double> resolutions(views.size());
  parallel(size(), [&](int i) {
    const auto view = static_cast<std::size_t>(i);
    resolutions[view] = point_resolution(views[view].vertices);
  });
  for (const double each : resolutions) resolution_ += each / static_cast<double>(views.size());
  parallel(size(), [&](int i) {
    const auto view = static_cast<std::size_t>(i);
    views_[view].emplace(prepare(views[view], sensors_[view]));
  });
}

ViewSet::Prepared ViewSet::prepare(const Mesh& mesh, const ViewOptions& sensor) const {
  Mesh faced = mesh;
  if (mesh.triangles.rows() == 0) faced.triangles = triangulate_view(mesh.vertices, resolution_, sensor).triangles;
  NormalOptions by_faces;
  by_faces.side = NormalSide::Mesh;
  Points normals = estimate_normals(faced, by_faces);
  return {std::move(faced), std::move(normals), PointTree(mesh.vertices),
          DepthImage(mesh.vertices, kCellPr * resolution_, sensor)};
}

Eigen::Vector3d ViewSet::sensor(int view) const {
  const ViewOptions& from = side(view);
  if (!from.direction) return from.sensor;
  return vertex_centroid(mesh(view)) - kFarPr * resolution_ * from.direction->stableNormalized();
}

double ViewSet::share_in_front(int a, int b, const RigidTransform& b_from_a) const {
  const double margin = kInFrontPr * resolution_;
  return std::max(at(b).seen.share_in_front(b_from_a.apply(mesh(a).vertices), margin),
                  at(a).seen.share_in_front(b_from_a.inverse().apply(mesh(b).vertices), margin));
}

ViewAgreement ViewSet::agreement(int a, int b, const RigidTransform& b_from_a) const {
  const Points &source = mesh(a).vertices, &target = mesh(b).vertices;
  ViewAgreement agreement{overlap_share(source, target, b_from_a, kOverlapSharePr * resolution_), std::nullopt,
                          share_in_front(a, b, b_from_a)};
  const Points moved = b_from_a.apply(source);
  NearestTracker tracker(at(b).tree);
  const Indices& nearest = tracker.nearest(moved, kOverlapSharePr * resolution_);
  std::vector<double> distances;
  for (std::size_t i = 0; i < nearest.size(); ++i)
    if (nearest[i] >= 0)
      distances.push_back((moved.row(static_cast<Eigen::Index>(i)) - target.row(nearest[i])).norm() / resolution_);
  if (distances.empty()) return agreement;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  agreement.median_pr = *middle;
  return agreement;
}

std::optional<RigidTransform> ViewSet::lay(int a, int b, const RigidTransform& start) const {
  NearestTracker tracker(at(b).tree);
  const SurfacePair surfaces{
      {mesh(a).vertices, at(a).normals},
      {mesh(b).vertices, at(b).normals},
      resolution_,
      [&](const Points& queries, double limit) -> const PointPairs& { return tracker.pair(queries, limit); }};
  SurfaceOptions coarse, fine;
  fine.levels = {coarse.levels.back()};
  coarse.levels.pop_back();
  const auto near = refine_surface(surfaces, start, coarse).target_from_source;
  if (!near || share_in_front(a, b, *near) > kHopelessInFront) return std::nullopt;
  return refine_surface(surfaces, *near, fine).target_from_source;
}

}  // namespace corral
