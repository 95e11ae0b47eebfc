// SPDX-License-Identifier: MIT
#include "tests/peers/pcl_grouping.h"

#include <pcl/console/print.h>
#include <pcl/correspondence.h>
#include <pcl/point_types.h>
#include <pcl/recognition/cg/geometric_consistency.h>
#include <pcl/recognition/cg/hough_3d.h>
#include <pcl/sample_consensus/ransac.h>
#include <pcl/sample_consensus/sac_model_registration.h>

#include <algorithm>
#include <stdexcept>

namespace corral::peers {
namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;
using FrameCloud = pcl::PointCloud<pcl::ReferenceFrame>;

Cloud::Ptr cloud_of(const Points& points) {
  Cloud::Ptr cloud(new Cloud);
  for (Eigen::Index row = 0; row < points.rows(); ++row)
    cloud->emplace_back(static_cast<float>(points(row, 0)), static_cast<float>(points(row, 1)),
                        static_cast<float>(points(row, 2)));
  return cloud;
}

FrameCloud::Ptr cloud_of(const LocalReferenceFrames& frames) {
  FrameCloud::Ptr cloud(new FrameCloud);
  for (const LocalReferenceFrame& frame : frames) {
    pcl::ReferenceFrame& axes = cloud->emplace_back();
    Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(axes.rf) = frame.cast<float>();
  }
  return cloud;
}

/// PCL's own loop, which counts its iterations and keeps the number to itself.
class CountedRansac : public pcl::RandomSampleConsensus<Point> {
 public:
  using pcl::RandomSampleConsensus<Point>::RandomSampleConsensus;
  int iterations() const { return iterations_; }
};

/// What both groupers of the recognition module are asked.
template <class Grouping>
Indices largest_cluster(Grouping& grouping) {
  std::vector<pcl::Correspondences> clusters;
  grouping.cluster(clusters);
  Indices rows;
  for (const pcl::Correspondences& cluster : clusters) {
    if (cluster.size() <= rows.size()) continue;
    rows.clear();
    for (const pcl::Correspondence& match : cluster) rows.push_back(match.index_query);
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

}  // namespace

struct PclGrouping::Clouds {
  Cloud::Ptr source, target;
  FrameCloud::Ptr source_frames, target_frames;
  pcl::CorrespondencesPtr matches{new pcl::Correspondences};
  pcl::Indices rows;
};

PclGrouping::PclGrouping(const CorrespondenceSet& matches) : clouds_(std::make_unique<Clouds>()) {
  // A cluster too narrow for a triple is no news worth two lines on stderr for each.
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  clouds_->source = cloud_of(matches.source_points);
  clouds_->target = cloud_of(matches.target_points);
  clouds_->source_frames = cloud_of(matches.source_frames);
  clouds_->target_frames = cloud_of(matches.target_frames);
  for (int row = 0; row < matches.size(); ++row) {
    clouds_->matches->emplace_back(row, row, static_cast<float>(matches.feature_distance(row)));
    clouds_->rows.push_back(row);
  }
}

PclGrouping::~PclGrouping() = default;

Indices PclGrouping::ransac(double threshold, int iterations) const {
  using Model = pcl::SampleConsensusModelRegistration<Point>;
  const Model::Ptr model(new Model(clouds_->source, clouds_->rows));
  model->setInputTarget(clouds_->target, clouds_->rows);
  CountedRansac ransac(model, threshold);
  ransac.setProbability(1.0);               // log(1 - 1): the number of iterations that it deems enough is infinite
  ransac.setMaxIterations(iterations - 1);  // it goes on until it has done more than that
  ransac.computeModel();
  if (ransac.iterations() != iterations) throw std::runtime_error("PCL's RANSAC found no more triples to try");
  pcl::Indices inliers;
  ransac.getInliers(inliers);
  return Indices(inliers.begin(), inliers.end());
}

Indices PclGrouping::geometric_consistency(double size) const {
  pcl::GeometricConsistencyGrouping<Point, Point> grouping;
  grouping.setInputCloud(clouds_->source);
  grouping.setSceneCloud(clouds_->target);
  grouping.setModelSceneCorrespondences(clouds_->matches);
  grouping.setGCSize(size);
  grouping.setGCThreshold(3);
  return largest_cluster(grouping);
}

Indices PclGrouping::hough_voting(double bin_size) const {
  pcl::Hough3DGrouping<Point, Point> grouping;
  grouping.setInputCloud(clouds_->source);
  grouping.setInputRf(clouds_->source_frames);
  grouping.setSceneCloud(clouds_->target);
  grouping.setSceneRf(clouds_->target_frames);
  grouping.setModelSceneCorrespondences(clouds_->matches);
  grouping.setHoughBinSize(bin_size);
  return largest_cluster(grouping);
}

}  // namespace corral::peers
