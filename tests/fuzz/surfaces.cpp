// SPDX-License-Identifier: MIT
// Small meshes and clouds for everything between a mesh and its matches.
#include <array>
#include <cmath>

#include "kernel/surface/feature_matching.h"
#include "kernel/surface/mesh/topology.h"
#include "kernel/surface/normals.h"
#include "kernel/surface/registry.h"
#include "tests/fuzz/crooked_mesh.h"
#include "tests/fuzz/target.h"

namespace corral::fuzz {
namespace {

void check_normals(const Points& normals) {
  for (Eigen::Index row = 0; row < normals.rows(); ++row) {
    const double length = normals.row(row).norm();
    require(length == 0 || std::abs(length - 1) < 1e-9, "a normal has length 1 or 0");
  }
}

void check_features(const Descriptors& found, const Mesh& mesh) {
  require(found.features.cols() == static_cast<Eigen::Index>(found.vertices.size()), "a feature for each keypoint");
  require(found.features.allFinite(), "features are finite");
  for (const int vertex : found.vertices)
    require(vertex >= 0 && vertex < mesh.vertices.rows(), "a keypoint is a vertex");
  for (const LocalReferenceFrame& frame : found.frames)
    require((frame * frame.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-6, "a frame is a rotation");
}

Descriptors describe(const Mesh& mesh, double resolution, const Descriptor& descriptor, const Detector& detector) {
  const Points normals = estimate_normals(mesh);
  check_normals(normals);
  const Keypoints keypoints = detector.configure({}).detect({mesh, resolution});
  for (std::size_t i = 0; i < keypoints.vertices.size(); ++i)
    require(keypoints.vertices[i] >= 0 && keypoints.vertices[i] < mesh.vertices.rows() &&
                (i == 0 || keypoints.vertices[i] > keypoints.vertices[i - 1]),
            "keypoints ascend and are vertices");
  Descriptors found = descriptor.configure({}).describe({mesh.vertices, normals, keypoints.vertices, resolution});
  check_features(found, mesh);
  return found;
}

void match(const std::string& input) {
  Bytes bytes(input);
  const bool is_wild = bytes.below(4) == 0;
  const Detector& detector = detectors()[static_cast<std::size_t>(bytes.below(static_cast<int>(detectors().size())))];
  const Descriptor& descriptor =
      descriptors()[static_cast<std::size_t>(bytes.below(static_cast<int>(descriptors().size())))];
  const Mesh source = is_wild ? crooked_mesh<&Bytes::coordinate>(bytes) : crooked_mesh<&Bytes::moderate>(bytes);
  const Mesh target = bytes.below(4) == 0 ? crooked_mesh<&Bytes::moderate>(bytes) : source;
  source.validate("source");
  inspect_topology(source);
  const double resolution = point_spacing(source.vertices).resolution;
  require(resolution > 0, "pr is a length");
  if (!std::isfinite(resolution)) return;  // as read_surface refuses it
  const Descriptors of_source = describe(source, resolution, descriptor, detector);
  const Descriptors of_target = describe(target, resolution, descriptor, detector);
  MatchingOptions options;
  options.mutual = bytes.below(2) == 1;
  const CorrespondenceSet matches = make_correspondences({source, of_source}, {target, of_target}, resolution, options);
  matches.validate();
}

}  // namespace

const std::vector<Target>& surface_targets() {
  static const std::vector<Target> all = {{"match", match}};
  return all;
}

}  // namespace corral::fuzz
