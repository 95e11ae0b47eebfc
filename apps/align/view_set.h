// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "kernel/parallel.h"
#include "kernel/rigid_transform.h"
#include "kernel/surface/mesh/mesh.h"
#include "kernel/surface/scan/depth_image.h"
#include "kernel/surface/search/nearest_points.h"

namespace corral {

/// How well the surfaces of two views agree under a pose, without any ground truth.
struct ViewAgreement {
  double overlap = 0;               ///< overlap_share within 2 pr
  std::optional<double> median_pr;  ///< median distance of the points of a in the overlap to the nearest of b
  double in_front = 0;  ///< share of the points of a view in front of what the other saw, the larger of both directions
};

/// Views of one object, each in the coordinates of its own sensor, prepared for aligning one with another.
class ViewSet {
 public:
  /// The meshes must outlive this; one without faces gets those of triangulate_view. `sensor`: position or viewing direction
  /// of the sensor of every view; where it is not known, that of view_side for each.
  /// Throws    InvalidInput: a view that is not in front of its sensor, or a single point.
  ViewSet(const std::vector<Mesh>& views, const std::optional<ViewOptions>& sensor, const ParallelFor& parallel);

  int size() const { return static_cast<int>(views_.size()); }
  double resolution() const { return resolution_; }  ///< mean of all views, mesh units per pr
  const Mesh& mesh(int view) const { return at(view).mesh; }
  const ViewOptions& side(int view) const { return sensors_[static_cast<std::size_t>(view)]; }
  Eigen::Vector3d sensor(int view) const;  ///< a position from which the view may have been taken, mesh units

  /// Whether one view contradicts the pose: tested first, because it is cheap.
  double share_in_front(int a, int b, const RigidTransform& b_from_a) const;
  ViewAgreement agreement(int a, int b, const RigidTransform& b_from_a) const;

  /// Aligns the whole surface of a with that of b, from coarse to fine; absent where refine_surface gives no pose, or the
  /// views contradict the pose of its coarse levels.
  std::optional<RigidTransform> lay(int a, int b, const RigidTransform& start) const;

 private:
  struct Prepared {
    Mesh mesh;
    Points normals;
    PointTree tree;
    DepthImage seen;
  };
  const Prepared& at(int view) const { return *views_[static_cast<std::size_t>(view)]; }
  Prepared prepare(const Mesh& mesh, const ViewOptions& sensor) const;

  std::vector<ViewOptions> sensors_;
  double resolution_ = 0;
  std::vector<std::optional<Prepared>> views_;
};

}  // namespace corral
