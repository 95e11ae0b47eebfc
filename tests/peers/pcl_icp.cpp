// SPDX-License-Identifier: MIT
#include <pcl/point_types.h>
#include <pcl/registration/icp.h>

#include "tests/peers/icp.h"

namespace corral::peers {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

/// PCL keeps how many rounds it took to itself.
struct CountingIcp : pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> {
  int rounds() const { return nr_iterations_; }
};

Cloud::Ptr cloud_of(const Points& points) {
  const Cloud::Ptr cloud(new Cloud);
  cloud->reserve(static_cast<std::size_t>(points.rows()));
  for (Eigen::Index row = 0; row < points.rows(); ++row) {
    const Eigen::RowVector3f point = points.row(row).cast<float>();
    cloud->emplace_back(point.x(), point.y(), point.z());
  }
  return cloud;
}

}  // namespace

Icp pcl_icp(const Points& source, const Points& target) {
  return [from = cloud_of(source), to = cloud_of(target)](const RigidTransform& start, double limit, int rounds) {
    CountingIcp icp;
    icp.setInputSource(from);
    icp.setInputTarget(to);
    icp.setMaxCorrespondenceDistance(limit);
    icp.setMaximumIterations(rounds);
    // No other criterion may end it: each counts as met where a change is below its threshold.
    icp.setTransformationEpsilon(-1);
    icp.setTransformationRotationEpsilon(2);
    icp.setEuclideanFitnessEpsilon(-1);
    icp.getConvergeCriteria()->setAbsoluteMSE(-1);
    Eigen::Matrix4f guess = Eigen::Matrix4f::Identity();
    guess.topLeftCorner<3, 3>() = start.rotation.cast<float>();
    guess.topRightCorner<3, 1>() = start.translation.cast<float>();
    Cloud aligned;
    icp.align(aligned, guess);
    const Eigen::Matrix4d pose = icp.getFinalTransformation().cast<double>();
    return IcpResult{{pose.topLeftCorner<3, 3>(), pose.topRightCorner<3, 1>()}, icp.rounds()};
  };
}

}  // namespace corral::peers
