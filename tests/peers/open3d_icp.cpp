// SPDX-License-Identifier: MIT
#include <omp.h>
#include <open3d/geometry/PointCloud.h>
#include <open3d/pipelines/registration/Registration.h>

#include <memory>

#include "tests/peers/icp.h"

namespace corral::peers {
namespace {

using open3d::geometry::PointCloud;

std::shared_ptr<PointCloud> cloud_of(const Points& points) {
  auto cloud = std::make_shared<PointCloud>();
  for (Eigen::Index row = 0; row < points.rows(); ++row) cloud->points_.emplace_back(points.row(row).transpose());
  return cloud;
}

}  // namespace

Icp open3d_icp(const Points& source, const Points& target) {
  return [from = cloud_of(source), to = cloud_of(target)](const RigidTransform& start, double limit, int rounds) {
    namespace registration = open3d::pipelines::registration;
    omp_set_num_threads(1);
    Eigen::Matrix4d guess = Eigen::Matrix4d::Identity();
    guess.topLeftCorner<3, 3>() = start.rotation;
    guess.topRightCorner<3, 1>() = start.translation;
    // It ends where both changes are below their thresholds: never.
    const registration::ICPConvergenceCriteria all_rounds(0, 0, rounds);
    const auto found = registration::RegistrationICP(
        *from, *to, limit, guess, registration::TransformationEstimationPointToPoint(false), all_rounds);
    const Eigen::Matrix4d& pose = found.transformation_;
    return IcpResult{{pose.topLeftCorner<3, 3>(), pose.topRightCorner<3, 1>()}, rounds};
  };
}

}  // namespace corral::peers
