// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>

#include "apps/picture/raster.h"
#include "kernel/rigid_transform.h"
#include "kernel/surface/mesh/mesh.h"

namespace corral {

/// A surface prepared for drawing.
struct PaintedSurface {
  Mesh mesh;
  Points normals;         ///< unit length or zero, one per vertex
  double resolution = 0;  ///< mesh units per pr: the size of the dots of a cloud
};

/// With the normals of its faces, or estimated ones for a cloud.
PaintedSurface painted_surface(Mesh mesh);

/// The same surface moved.
PaintedSurface moved(const PaintedSurface& surface, const RigidTransform& motion);

/// From mesh units to a picture, without perspective.
struct Projection {
  Eigen::Matrix3d view_from_mesh = Eigen::Matrix3d::Identity();  ///< rows point right, up, and to the viewer
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();              ///< of the mesh, in view axes
  double scale = 1;                                              ///< pixels per mesh unit
  Place place = Place::Zero();                                   ///< position of the middle in the picture

  Eigen::Vector3d operator()(const Eigen::Vector3d& point) const;  ///< x, y in pixels, z towards the viewer
};

/// The box around the points in view axes; empty for no points.
Eigen::AlignedBox3d view_box(const Points& points, const Eigen::Matrix3d& view_from_mesh);

struct ChosenView {
  Eigen::Matrix3d view_from_mesh;
  double facing = 0;  ///< share of the area that faces the viewer, foreshortened; above 1/2 only for open surfaces
};

/// A view that shows the surface well: level, with y up, from the first of eight sides from which at least nine tenths of the
/// largest visible area face the viewer; from above or below if that shows half as much again.
ChosenView choose_view(const PaintedSurface& surface);

/// Draws the surface: smoothly shaded faces, or a disc for every point of a cloud.
void paint(Raster& raster, const PaintedSurface& surface, const Projection& projection, const Color& color);

}  // namespace corral
