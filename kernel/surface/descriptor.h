// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "kernel/local_reference_frame.h"
#include "kernel/surface/mesh.h"
#include "kernel/surface/neighborhood.h"

namespace corral {

/// Length of a SHOT descriptor: 8 azimuth x 2 elevation x 2 radial volumes with 11 cosine bins each.
constexpr int kShotSize = 352;

/// The repeatable frame of the surface around a point (rows x, y, z).
///
///   M = sum (R - d_i)(x_i - p)(x_i - p)^T / sum (R - d_i)  over 0 < d_i = |x_i - p| <= R
///
/// x and z are the eigenvectors of the largest and the smallest eigenvalue, turned to the side where at least half of the
/// neighbours lie; on an exact tie to the side of most of the five neighbours around the median distance. y = z cross x.
/// `neighbors`  the vertices within `radius` of the point (those at distance 0 are left out), in any order.
/// Source    [tombari2010shot].
/// Returns   absent for fewer than 5 neighbours, or where all lie so that no frame is finite.
std::optional<LocalReferenceFrame> shot_frame(const Points& vertices, const Eigen::Vector3d& point,
                                              const std::vector<Neighbor>& neighbors, double radius);

/// The SHOT histogram of the surface around a point, unit length; absent if no neighbour with a normal falls into it.
///
/// For each neighbour the cosine between its normal and the frame's z axis goes into the volume it lies in; what it gives
/// to the neighbouring bin along each of the four axes (cosine, radius, elevation, azimuth) is added one axis at a time.
///
/// Order     bin = ((azimuth * 2 + elevation) * 2 + radius) * 11 + cosine; azimuth sectors from -180 degrees counter-
///           clockwise, elevation 0 above (z > 0), radius 0 inside R/2.
/// Source    [tombari2010shot]; additive interpolation and L2 norm as in the library that [yang2017evaluation] ran.
/// Departs   The neighbour of the last cosine bin is clamped; that library wraps it to bin 0. Its order of bins differs.
std::optional<Eigen::VectorXd> shot_histogram(const Points& vertices, const Points& normals,
                                              const Eigen::Vector3d& point, const LocalReferenceFrame& frame,
                                              const std::vector<Neighbor>& neighbors, double radius);

/// Descriptors of those keypoints that have one.
struct Descriptors {
  Indices vertices;              ///< vertex of each column, in the order of the keypoints
  LocalReferenceFrames frames;   ///< frame of each column
  Eigen::MatrixXd features;      ///< 352 x N, one column per keypoint, unit length
  int dropped_no_frame = 0;      ///< keypoints without a frame
  int dropped_no_histogram = 0;  ///< keypoints with an empty histogram
};

/// Frames and SHOT descriptors of chosen vertices; `normals` V x 3 (zero rows take no part), radius in pr (paper: 15).
/// Throws    InvalidInput if radius or resolution is not finite and positive.
Descriptors describe_shot(const Mesh& mesh, const Points& normals, const PointIndex& index, const Indices& keypoints,
                          double resolution, double radius_pr = 15);

}  // namespace corral
