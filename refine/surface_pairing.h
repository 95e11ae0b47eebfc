// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <vector>

#include "refine/gram_fit.h"
#include "refine/pairing_loops.h"
#include "refine/refine_surface.h"

namespace corral {

// The state of refine_surface() at a pose of two surfaces. Only sources include this.

/// The pairs of one pose: their number and sums.
struct Pairing {
  Eigen::Index points = 0, pairs = 0;
  Gram gram = Gram::Zero();                          ///< of steps in pr about the centre
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of the moved points, mesh units

  double overlap() const { return points > 0 ? static_cast<double>(pairs) / static_cast<double>(points) : 0; }
  double squares() const { return gram(12, 12); }  // pr^2
  double rms_pr() const { return pairs > 0 ? std::sqrt(squares() / static_cast<double>(pairs)) : 0; }
  double cost(double limit_pr) const {
    return (squares() + static_cast<double>(points - pairs) * limit_pr * limit_pr) / static_cast<double>(points);
  }
};

/// Mean squared distances between partners, across the surface and along it, pr^2.
struct Spread {
  double across, along;
};

/// Pairs the points of two surfaces, one pose after the other.
class SurfacePairing {
 public:
  /// `surfaces` must outlive this. For points to planes, the normals of a pair have at least this cosine.
  SurfacePairing(const SurfacePair& surfaces, double least_cosine);

  /// Uses every n-th source point in spatial order from now on, n the least for which these are at most `most_points`.
  /// Returns n.
  Eigen::Index take(int most_points);

  /// Root mean square distance of the points used from their mean, pr.
  double size_pr() const { return size_pr_; }

  Pairing pair(SurfaceResidual residual, const RigidTransform& pose, double limit_pr);

  /// For `last`, which must be the last pairing, of points to planes.
  Spread spread(const Pairing& last) const;

  /// Condition of the point-to-plane equations of the `count` last pairs, with points and normals of the target; infinite if
  /// singular.
  double condition(Eigen::Index count);

 private:
  Eigen::MatrixXd sum_of_products(PairProducts products, const AlignedColumn (&places)[3],
                                  const Eigen::Vector3d& centre, double scale) const;
  Gram plane_gram() const;
  Gram point_gram() const;
  void take_source_normals();
  void take_target_normals();
  void compare_normals(const RigidTransform& pose);

  const SurfacePair& surfaces_;
  double least_cosine_;
  double unit_;                                              // mesh units per pr
  Indices order_;                                            // spatial, of the source
  Points source_;                                            // in that order
  std::vector<char> source_has_normal_, target_has_normal_;  // by row

  Eigen::Index taken_step_ = 0;
  Points taken_, moved_;
  Indices taken_rows_;
  AlignedColumn taken_normals_[3];  // once they are asked for
  Eigen::Vector3d taken_mean_ = Eigen::Vector3d::Zero();
  double size_pr_ = 0;

  const PointPairs* pairs_ = nullptr;     // of the last pose
  AlignedColumn is_pair_;                 // 1 or 0 for each of them
  AlignedColumn normals_[3], agreement_;  // of the pairs, and of their two normals
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
};

}  // namespace corral
