// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kernel/surface/scan/view_triangulation.h"

namespace corral {

/// What one sensor saw, as an image of the nearest depths: in front of a surface that it saw there was nothing.
///
/// The image is that of triangulate_view, in square cells; it has at most 1024 x 1024 of them (a larger view gets larger
/// cells).
class DepthImage {
 public:
  /// `cell`: side of a cell at the mean distance of the points, mesh units; about 2 pr, so that a surface leaves no cell
  /// empty. Of `options` only the sensor or direction is used. Throws InvalidInput as triangulate_view does, or if there
  /// are no points.
  DepthImage(const Points& view, double cell, const ViewOptions& options = {});

  /// Share of the points (N x 3, in the coordinates of the view; not 0) that the view contradicts: more than `margin` (mesh
  /// units) in front of all that was seen in their cell and the eight around it. Points in empty cells are not contradicted.
  double share_in_front(const Points& points, double margin) const;

 private:
  struct Place {
    double u, v, depth;  // cells and mesh units; depth is NaN behind the sensor
  };
  Place place(const Eigen::Vector3d& point) const;

  Eigen::Vector3d sensor_, forward_, right_, up_;
  bool is_perspective_;
  double distance_, cell_, first_u_ = 0, first_v_ = 0;
  Eigen::Index columns_ = 0, rows_ = 0;
  Eigen::ArrayXXd nearest_;  // infinite where nothing was seen; a border of one cell around
};

}  // namespace corral
