// SPDX-License-Identifier: MIT
// What aligns surfaces: two to four small views into one frame, with and without given poses.
#include <Eigen/LU>
#include <cmath>

#include "apps/align/align_view_set.h"
#include "tests/fuzz/crooked_mesh.h"
#include "tests/fuzz/target.h"

namespace corral::fuzz {
namespace {

void check_pose(const RigidTransform& pose) {
  require(pose.translation.allFinite(), "a pose is finite");
  require((pose.rotation * pose.rotation.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-6 &&
              pose.rotation.determinant() > 0,
          "a pose is a rotation");
}

bool is_share(double number) { return number >= 0 && number <= 1; }

void check(const AlignedViews& aligned, int views) {
  require(static_cast<int>(aligned.world_from_view.size()) == views && static_cast<int>(aligned.part.size()) == views,
          "a pose and a part for each view");
  for (const RigidTransform& pose : aligned.world_from_view) check_pose(pose);
  for (const AlignedPair& pair : aligned.pairs) {
    require(pair.pose.a >= 0 && pair.pose.a < pair.pose.b && pair.pose.b < views, "a pair is one of two views");
    check_pose(pair.pose.b_from_a);
    require(is_share(pair.agreement.overlap) && is_share(pair.agreement.in_front), "shares are from 0 to 1");
    require(!pair.confidence || is_share(*pair.confidence), "a probability is from 0 to 1");
  }
}

void align(const std::string& input) {
  Bytes bytes(input);
  const int count = 2 + bytes.below(3);
  const bool is_given = bytes.below(3) == 0;
  std::optional<ViewOptions> sensor;
  if (bytes.below(2) == 0) {
    sensor = ViewOptions();
    for (double& coordinate : sensor->sensor) coordinate = bytes.moderate();
  }
  std::vector<Mesh> meshes;
  for (int view = 0; view < count; ++view) {
    const bool is_copy = view > 0 && bytes.below(2) == 0;
    meshes.push_back(is_copy ? meshes.front() : crooked_mesh<&Bytes::moderate>(bytes));
  }
  const ViewSet views(meshes, sensor, one_by_one);
  if (!is_given) return check(align_view_set(views, {}, one_by_one), count);
  std::vector<ViewPair> poses;
  for (int b = 1; b < count; ++b)
    poses.push_back({b - 1, b, {Eigen::Matrix3d::Identity(), {bytes.moderate(), bytes.moderate(), 0}}});
  check(align_view_set(views, poses, {}), count);
}

}  // namespace

const std::vector<Target>& view_targets() {
  static const std::vector<Target> all = {{"align", align}};
  return all;
}

}  // namespace corral::fuzz
