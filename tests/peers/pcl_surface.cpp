// SPDX-License-Identifier: MIT
#include "tests/peers/pcl_surface.h"

#include <pcl/console/print.h>
#include <pcl/features/fpfh.h>
#include <pcl/features/normal_3d.h>
#include <pcl/features/shot.h>
#include <pcl/features/shot_omp.h>
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/keypoints/harris_3d.h>
#include <pcl/keypoints/iss_3d.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/peers/flann_matching.h"

namespace corral::peers {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using NormalCloud = pcl::PointCloud<pcl::Normal>;
constexpr int kBins = 352;

struct PclSurface::Clouds {
  Cloud::Ptr points{new Cloud};
  NormalCloud::Ptr normals{new NormalCloud};
};

PclSurface::PclSurface(const Points& vertices) : clouds_(std::make_unique<Clouds>()) {
  // A keypoint without a frame is no news worth a line on stderr for each.
  pcl::console::setVerbosityLevel(pcl::console::L_ERROR);
  clouds_->points->reserve(static_cast<std::size_t>(vertices.rows()));
  for (Eigen::Index row = 0; row < vertices.rows(); ++row)
    clouds_->points->emplace_back(static_cast<float>(vertices(row, 0)), static_cast<float>(vertices(row, 1)),
                                  static_cast<float>(vertices(row, 2)));
}

PclSurface::~PclSurface() = default;
PclSurface::PclSurface(PclSurface&&) noexcept = default;

double PclSurface::resolution() const {
  pcl::KdTreeFLANN<pcl::PointXYZ> tree;
  tree.setInputCloud(clouds_->points);
  pcl::Indices indices(2);
  std::vector<float> squared(2);
  double sum = 0;
  for (const pcl::PointXYZ& point : *clouds_->points) {
    tree.nearestKSearch(point, 2, indices, squared);
    sum += std::sqrt(squared[1]);
  }
  return sum / static_cast<double>(clouds_->points->size());
}

void PclSurface::estimate_normals(int k) {
  pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(clouds_->points);
  estimation.setKSearch(k);
  estimation.setViewPoint(0, 0, 0);
  estimation.compute(*clouds_->normals);
}

void PclSurface::set_normals(const Points& normals) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  clouds_->normals->clear();
  for (Eigen::Index row = 0; row < normals.rows(); ++row) {
    const Eigen::RowVector3f normal = normals.row(row).cast<float>();
    if (normal.isZero(0))
      clouds_->normals->emplace_back(kNone, kNone, kNone);
    else
      clouds_->normals->emplace_back(normal.x(), normal.y(), normal.z());
  }
}

Points PclSurface::normals() const {
  Points normals(static_cast<Eigen::Index>(clouds_->normals->size()), 3);
  for (Eigen::Index row = 0; row < normals.rows(); ++row) {
    const pcl::Normal& normal = (*clouds_->normals)[static_cast<std::size_t>(row)];
    normals.row(row) << normal.normal_x, normal.normal_y, normal.normal_z;
  }
  return normals;
}

namespace {

using HarrisDetector = pcl::HarrisKeypoint3D<pcl::PointXYZ, pcl::PointXYZI>;

pcl::PointCloud<pcl::PointXYZI> detect(HarrisDetector& detector, const Cloud::Ptr& cloud, double radius) {
  detector.setInputCloud(cloud);
  detector.setRadius(static_cast<float>(radius));
  detector.setRadiusSearch(radius);
  detector.setRefine(false);
  detector.setNumberOfThreads(1);  // with more, the order of the points is not the same twice
  pcl::PointCloud<pcl::PointXYZI> corners;
  detector.compute(corners);
  return corners;
}

template <typename Described = pcl::SHOT352, typename Estimation>
pcl::PointCloud<Described> describe(Estimation&& estimation, const Cloud::Ptr& cloud, const NormalCloud::Ptr& normals,
                                    const Indices& keypoints, double radius) {
  estimation.setInputCloud(cloud);
  estimation.setInputNormals(normals);
  estimation.setIndices(pcl::IndicesPtr(new pcl::Indices(keypoints.begin(), keypoints.end())));
  estimation.setRadiusSearch(radius);
  pcl::PointCloud<Described> described;
  estimation.compute(described);
  return described;
}

}  // namespace

Indices PclSurface::harris(double radius) const {
  HarrisDetector detector;
  detector.setNonMaxSupression(true);
  detect(detector, clouds_->points, radius);
  const auto& rows = detector.getKeypointsIndices()->indices;
  return Indices(rows.begin(), rows.end());
}

Eigen::VectorXf PclSurface::harris_response(double radius) const {
  HarrisDetector detector;
  detector.setNonMaxSupression(false);
  const auto corners = detect(detector, clouds_->points, radius);
  Eigen::VectorXf response(static_cast<Eigen::Index>(corners.size()));
  for (std::size_t row = 0; row < corners.size(); ++row)
    response(static_cast<Eigen::Index>(row)) = corners[row].intensity;
  return response;
}

Indices PclSurface::iss(double salient_radius, double non_max_radius) const {
  pcl::ISSKeypoint3D<pcl::PointXYZ, pcl::PointXYZ> detector(salient_radius);
  detector.setInputCloud(clouds_->points);
  detector.setNonMaxRadius(non_max_radius);
  detector.setThreshold21(0.975);
  detector.setThreshold32(0.975);
  detector.setMinNeighbors(5);
  detector.setNumberOfThreads(1);
  Cloud keypoints;
  detector.compute(keypoints);
  const auto& rows = detector.getKeypointsIndices()->indices;
  return Indices(rows.begin(), rows.end());
}

Eigen::MatrixXf PclSurface::fpfh(const Indices& keypoints, double radius) const {
  const auto described =
      describe<pcl::FPFHSignature33>(pcl::FPFHEstimation<pcl::PointXYZ, pcl::Normal, pcl::FPFHSignature33>(),
                                     clouds_->points, clouds_->normals, keypoints, radius);
  Eigen::MatrixXf features(33, static_cast<Eigen::Index>(described.size()));
  for (std::size_t i = 0; i < described.size(); ++i)
    features.col(static_cast<Eigen::Index>(i)) = Eigen::Map<const Eigen::VectorXf>(described[i].histogram, 33);
  return features;
}

Shot PclSurface::shot(const Indices& keypoints, double radius, int threads) const {
  using Serial = pcl::SHOTEstimation<pcl::PointXYZ, pcl::Normal, pcl::SHOT352>;
  using Parallel = pcl::SHOTEstimationOMP<pcl::PointXYZ, pcl::Normal, pcl::SHOT352>;
  const auto described = threads == 1 ? describe(Serial(), clouds_->points, clouds_->normals, keypoints, radius)
                                      : describe(Parallel(static_cast<unsigned>(threads)), clouds_->points,
                                                 clouds_->normals, keypoints, radius);
  Shot shot;
  shot.features.resize(kBins, static_cast<Eigen::Index>(described.size()));
  for (std::size_t i = 0; i < described.size(); ++i) {
    auto column = shot.features.col(static_cast<Eigen::Index>(i));
    column = Eigen::Map<const Eigen::VectorXf>(described[i].descriptor, kBins);
    const Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>> frame(described[i].rf);
    shot.frames.push_back(frame.cast<double>());
    shot.valid.push_back(frame.allFinite() && column.allFinite());
  }
  return shot;
}

namespace {

struct Described {
  Indices vertices;
  Eigen::MatrixXf features;
};

Described describe_keypoints(PclSurface& surface, double resolution) {
  surface.estimate_normals();
  const Indices keypoints = surface.harris(3 * resolution);
  const Shot shot = surface.shot(keypoints, 15 * resolution);
  Described described;
  Indices columns;
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    if (!shot.valid[i]) continue;
    described.vertices.push_back(keypoints[i]);
    columns.push_back(static_cast<int>(i));
  }
  described.features = shot.features(Eigen::all, columns);
  return described;
}

}  // namespace

PclMatch match_with_pcl(PclSurface& source, PclSurface& target) {
  PclMatch match;
  match.resolution = (source.resolution() + target.resolution()) / 2;
  Described on_source = describe_keypoints(source, match.resolution);
  Described on_target = describe_keypoints(target, match.resolution);
  FlannNearest found = match_with_flann_tree(on_source.features, on_target.features);
  match.source_keypoints = std::move(on_source.vertices);
  match.target_keypoints = std::move(on_target.vertices);
  match.nearest = std::move(found.first);
  match.second = std::move(found.second);
  return match;
}

}  // namespace corral::peers
