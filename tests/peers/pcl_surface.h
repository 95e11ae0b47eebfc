// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "kernel/local_reference_frame.h"
#include "kernel/types.h"

namespace corral::peers {

/// SHOT descriptors of some keypoints, all of them: a row or column that PCL could not compute is NaN and not valid.
struct Shot {
  Eigen::MatrixXf features;     ///< 352 x N, bins in PCL's order
  LocalReferenceFrames frames;  ///< N, rows x, y, z
  std::vector<bool> valid;      ///< N: frame and descriptor are finite
};

/// The steps from a point cloud to descriptors as the Point Cloud Library takes them, with the calls and parameters of the
/// paper's own program. The conversion to its cloud happens once, in the constructor, so that the methods can be timed:
/// each builds its own kd-tree, as that program does.
class PclSurface {
 public:
  explicit PclSurface(const Points& vertices);  ///< coordinates are rounded to float
  ~PclSurface();
  PclSurface(PclSurface&&) noexcept;
  PclSurface(const PclSurface&) = delete;

  /// Mean distance to the second of the two nearest points (the first is the point itself, or a duplicate of it).
  double resolution() const;

  /// Plane normals of k neighbours, turned to the origin; kept for shot().
  void estimate_normals(int k = 20);
  void set_normals(const Points& normals);  ///< instead of those; a zero row becomes NaN, PCL's sign for "none"
  Points normals() const;                   ///< V x 3, NaN where there is none

  /// Harris keypoints as vertices, ascending; one radius for normals, response and suppression; one thread.
  Indices harris(double radius) const;
  Eigen::VectorXf harris_response(double radius) const;  ///< of every vertex, without suppression

  /// ISS keypoints as vertices, ascending; thresholds 0.975, at least 5 neighbours, no test for borders; one thread.
  Indices iss(double salient_radius, double non_max_radius) const;

  /// FPFH of some vertices, 33 x N, by the estimator without OpenMP; needs normals.
  Eigen::MatrixXf fpfh(const Indices& keypoints, double radius) const;

  /// Descriptors of some vertices; needs normals. On one thread the estimator without OpenMP: its answers are the same, and
  /// it is the faster one (the other searches every neighbourhood once more).
  Shot shot(const Indices& keypoints, double radius, int threads = 1) const;

 private:
  struct Clouds;
  std::unique_ptr<Clouds> clouds_;
};

/// The paper's whole line for two clouds: resolutions, normals, keypoints at 3 pr and descriptors at 15 pr of both, the
/// two nearest target descriptors of each of the source (exact kd-tree).
struct PclMatch {
  double resolution = 0;                     ///< mean of both
  Indices source_keypoints;                  ///< described ones
  Indices target_keypoints;                  ///< described ones
  std::vector<std::size_t> nearest, second;  ///< columns of the target per source column
};
PclMatch match_with_pcl(PclSurface& source, PclSurface& target);

}  // namespace corral::peers
