// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "kernel/local_reference_frame.h"
#include "kernel/parallel.h"
#include "kernel/surface/mesh/mesh.h"
#include "kernel/vectorized.h"

namespace corral {

/// Length of a SHOT descriptor: 8 azimuth x 2 radial x 2 elevation volumes with 11 cosine bins each.
constexpr int kShotSize = 352;

struct ShotOptions {
  double radius_pr = 15;          ///< of the support
  int minimum_support = 10;       ///< fewest vertices in the support, the keypoint excluded
  std::string form = "additive";  ///< additive | pcl | product: see shot_histogram

  /// Throws InvalidInput.
  void validate() const;
};

/// The support of a point: the vertices around it, column by column, without those at the point itself.
struct Support {
  AlignedColumn x, y, z;     ///< from the point, mesh units
  AlignedColumn distance;    ///< > 0
  AlignedColumn nx, ny, nz;  ///< unit normals; zero where there is none
  int count = 0;

  /// Adds a vertex, unless it is at distance 0.
  void add(const Eigen::Vector3d& offset, const Eigen::Vector3d& normal);
};

/// The repeatable frame of the surface around a point (rows x, y, z).
///
///   M = sum (R - d_i) x_i x_i^T / sum (R - d_i)  over 0 < d_i = |x_i| <= R, x_i from the point
///
/// x and z are the eigenvectors of the largest and the smallest eigenvalue, turned to the side where at least half of the
/// support lies; on an exact tie to the side of most of the five vertices around the median distance. y = z cross x.
/// Source    [tombari2010shot].
/// Returns   absent for fewer than 5 vertices, or where no finite frame exists.
std::optional<LocalReferenceFrame> shot_frame(const Support& support, double radius);

/// The SHOT histogram of a support, unit length; absent if no vertex with a normal is in it.
///
/// For each vertex the cosine between its normal and the frame's z axis is counted in the volume that the vertex lies in.
/// Along each of the four axes (cosine, radius, elevation, azimuth) the neighbouring bin gets a share that grows with the
/// distance from the centre of the vertex's own bin, up to a half; beyond the last centre of a bounded axis the share is lost.
///   additive  the four shares are added one axis at a time, and the vertex's own bin gets the rest of each
///   product   the shares multiply, over up to 16 bins
///   pcl       additive, with the slip of that library: what bin 9 of the cosine gives to bin 10 goes to bin 0 (and
///             describe_shot() leaves vertices at exactly R out of the support)
/// Order     bin = ((azimuth * 2 + shell) * 2 + above) * 11 + cosine; azimuth sectors from -180 degrees counter-clockwise,
///           shell 1 beyond R / 2, above 1 for z > 0. A sector holds its upper border. On the z axis, where there is no
///           azimuth, the vote is in sector 0: that of the other three axes, or all of it (product).
/// Source    [tombari2010shot]; additive shares, L2 norm and order as in the library that [yang2017evaluation] ran.
/// Departs   From that library: the cosine ends with its last bin (`pcl` wraps), and double decides what float does there.
std::optional<Eigen::VectorXd> shot_histogram(const Support& support, const LocalReferenceFrame& frame, double radius,
                                              const std::string& form = "additive");

/// Descriptors of those keypoints that have one.
struct Descriptors {
  Indices vertices;               ///< vertex of each column, in the order of the keypoints
  LocalReferenceFrames frames;    ///< frame of each column
  Eigen::MatrixXd features;       ///< 352 x N, one column per keypoint, unit length
  int dropped_small_support = 0;  ///< keypoints with too few vertices around them
  int dropped_no_frame = 0;       ///< keypoints without a frame
  int dropped_no_histogram = 0;   ///< keypoints with an empty histogram
};

/// Frames and SHOT descriptors of chosen vertices; `normals` V x 3 (zero rows are ignored). Any number of threads, and any
/// numbering of the vertices, gives the same bits.
/// Throws    InvalidInput if an option, the resolution or a keypoint is out of range, or the normals are not as many as
///           the vertices.
Descriptors describe_shot(const Points& vertices, const Points& normals, const Indices& keypoints, double resolution,
                          const ShotOptions& options = {}, const ParallelFor& parallel = one_by_one);

}  // namespace corral
