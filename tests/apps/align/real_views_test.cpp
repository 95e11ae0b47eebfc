// SPDX-License-Identifier: MIT
// Real range scans, where CORRAL_REAL_DATA names the folder that holds them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <numeric>

#include "apps/align/align_view_set.h"
#include "apps/align/alignment_files.h"
#include "apps/dataset/import_u3m.h"
#include "apps/pair/read_surface.h"
#include "apps/runtime/workers.h"
#include "io/pairs/dataset_file.h"
#include "io/pose/transform_file.h"
#include "kernel/evaluation.h"
#include "kernel/random.h"
#include "kernel/surface/normals.h"
#include "kernel/surface/search/nearest_points.h"
#include "refine/refine_surface.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

namespace fs = std::filesystem;

/// Views of one real object and the published alignment of them.
struct RealViews {
  std::vector<std::string> names;
  std::vector<Mesh> meshes;
  std::vector<RigidTransform> world_from_view;
  ViewOptions sensor;

  RealViews(const std::string& views, const std::string& first_letters, const std::string& truth,
            const std::string& truth_end) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(views))
      if (entry.path().filename().string().rfind(first_letters, 0) == 0 && entry.path().extension() != ".conf")
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) {
      if (file.extension() != ".ply" && file.extension() != ".txt") continue;
      names.push_back(view_name(file.string()));
      meshes.push_back(read_surface(file.string()));
      world_from_view.push_back(read_transform(truth + "/" + names.back() + truth_end));
    }
  }
  int size() const { return static_cast<int>(names.size()); }
  RigidTransform between(int a, int b) const {
    return world_from_view[std::size_t(b)].inverse() * world_from_view[std::size_t(a)];
  }
  /// Mean distance of the vertices of a view from where the published alignment has them in the other, pr.
  double off_pr(int a, int b, const RigidTransform& b_from_a, double resolution) const {
    const Points& points = meshes[std::size_t(a)].vertices;
    return (b_from_a.apply(points) - between(a, b).apply(points)).rowwise().norm().mean() / resolution;
  }
  /// Mean distance of all vertices from where the published alignment has them, pr, in the frame that suits best.
  double error_pr(const AlignedViews& aligned, double resolution) const {
    Eigen::Index count = 0, row = 0;
    for (const Mesh& mesh : meshes) count += mesh.vertices.rows();
    Points found(count, 3), truth(count, 3);
    for (std::size_t i = 0; i < meshes.size(); row += meshes[i].vertices.rows(), ++i) {
      found.middleRows(row, meshes[i].vertices.rows()) = aligned.world_from_view[i].apply(meshes[i].vertices);
      truth.middleRows(row, meshes[i].vertices.rows()) = world_from_view[i].apply(meshes[i].vertices);
    }
    const RigidTransform frame = fit_rigid_transform(found, truth).value();
    return (frame.apply(found) - truth).rowwise().norm().mean() / resolution;
  }
};

std::string real_data() {
  const char* folder = std::getenv("CORRAL_REAL_DATA");
  return folder ? folder : "";
}

class RealData : public ::testing::Test {
 protected:
  void SetUp() override {
    if (real_data().empty()) GTEST_SKIP() << "CORRAL_REAL_DATA does not name a folder of real scans";
  }
};

RealViews uwa(const std::string& object) {
  return {real_data() + "/u3m/views", object, real_data() + "/u3m/gt", "-to-model.xf"};
}

RealViews bunny() {
  const std::string folder = real_data() + "/stanford/bunny/data";
  RealViews views(folder, "", folder + "/gt", "-to-world.xf");
  views.sensor.direction = Eigen::Vector3d(0, 0, -1);
  return views;
}

/// Poses that the surfaces themselves settle in, of every pair that shares a quarter (but for those that slide: they are
/// wrong to begin with); then a share of them is made wrong:
/// any rotation about the middle of the view.
void expect_wrong_poses_named(const RealViews& real, double most_error_pr) {
  const ViewSet set(real.meshes, real.sensor, workers(0));
  std::vector<ViewPair> poses;
  for (int a = 0; a < real.size(); ++a)
    for (int b = a + 1; b < real.size(); ++b)
      if (set.agreement(a, b, real.between(a, b)).overlap >= 0.25)
        if (const auto pose = set.lay(a, b, real.between(a, b)))
          if (real.off_pr(a, b, *pose, set.resolution()) < 2) poses.push_back({a, b, *pose, 1});
  const auto wrong = static_cast<std::size_t>(std::lround(0.2 * double(poses.size())));
  ASSERT_GE(wrong, 4U);
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    RandomStream random(seed);
    std::vector<ViewPair> spoilt = poses;
    std::vector<bool> is_wrong(poses.size());
    for (std::size_t made = 0; made < wrong;) {
      const auto i = static_cast<std::size_t>(random.uniform() * double(poses.size()));
      if (is_wrong[i]) continue;
      const Eigen::Vector3d middle = vertex_centroid(set.mesh(poses[i].a));
      spoilt[i].b_from_a.rotation = random.rotation();
      spoilt[i].b_from_a.translation = poses[i].b_from_a * middle - spoilt[i].b_from_a.rotation * middle;
      is_wrong[i] = true;
      ++made;
    }
    const AlignedViews aligned = align_view_set(set, spoilt, {});
    for (std::size_t i = 0; i < poses.size(); ++i)
      EXPECT_EQ(aligned.pairs[i].judgement.verdict == PairVerdict::Contradicts, is_wrong[i])
          << "draw " << seed << ": " << real.names[std::size_t(poses[i].a)] << " "
          << real.names[std::size_t(poses[i].b)];
    EXPECT_LT(real.error_pr(aligned, set.resolution()), most_error_pr) << "draw " << seed;
  }
}

TEST_F(RealData, WrongPosesOfOneInFiveAreNamedParasaurolophus) { expect_wrong_poses_named(uwa("parasaurolophus"), 1); }
TEST_F(RealData, WrongPosesOfOneInFiveAreNamedBunny) { expect_wrong_poses_named(bunny(), 1); }

/// What is left between the views that share a quarter, points to planes up to 2 pr, in the mean over pairs of views.
template <class Pose>
double left_between(const RealViews& real, const ViewSet& set, const Pose& b_from_a) {
  SurfaceOptions options;
  options.levels = {{2, std::numeric_limits<int>::max(), 1}};
  double sum = 0;
  int pairs = 0;
  for (int a = 0; a < real.size(); ++a)
    for (int b = a + 1; b < real.size(); ++b) {
      if (set.agreement(a, b, real.between(a, b)).overlap < 0.25) continue;
      const Points normals_a = estimate_normals(set.mesh(a)), normals_b = estimate_normals(set.mesh(b));
      const PointTree tree(set.mesh(b).vertices);
      NearestTracker tracker(tree);
      const NearestPairs pair = [&](const Points& queries, double limit) -> const PointPairs& {
        return tracker.pair(queries, limit);
      };
      const SurfacePair surfaces{
          {set.mesh(a).vertices, normals_a}, {set.mesh(b).vertices, normals_b}, set.resolution(), pair};
      sum += refine_surface(surfaces, b_from_a(a, b), options).before.rms_pr;
      ++pairs;
    }
  EXPECT_GE(pairs, 20);
  return sum / pairs;
}

TEST_F(RealData, AlignedFromNothingTheyLieNearerThanPublished) {
  RealViews dragon(real_data() + "/stanford/dragon_stand", "", real_data() + "/stanford/dragon_stand/gt",
                   "-to-world.xf");
  dragon.sensor.direction = Eigen::Vector3d(0, 0, -1);
  for (const RealViews& real : {uwa("parasaurolophus"), uwa("T-rex"), dragon}) {
    const ViewSet set(real.meshes, real.sensor, workers(0));
    const AlignedViews aligned = align_view_set(set, {}, workers(0));
    EXPECT_THAT(aligned.part, ::testing::Each(0));
    EXPECT_LT(real.error_pr(aligned, set.resolution()), 1.5) << real.names[0];
    const auto found = [&](int a, int b) {
      return aligned.world_from_view[std::size_t(b)].inverse() * aligned.world_from_view[std::size_t(a)];
    };
    const double ours = left_between(real, set, found),
                 theirs = left_between(real, set, [&](int a, int b) { return real.between(a, b); });
    EXPECT_LT(ours, theirs) << real.names[0];
    EXPECT_LT(ours, 0.35) << real.names[0];
  }
}

TEST_F(RealData, BunnyIsAlignedFromNothing) {
  const RealViews real = bunny();
  const ViewSet set(real.meshes, real.sensor, workers(0));
  const AlignedViews aligned = align_view_set(set, {}, workers(0));
  EXPECT_THAT(aligned.part, ::testing::Each(0));
  EXPECT_LT(real.error_pr(aligned, set.resolution()), 1);
}

TEST_F(RealData, TruthMadeForUwaViewsIsThePublishedOne) {
  testing::ScratchFolder scratch;
  ImportU3mOptions options;
  options.folder = real_data() + "/u3m";
  options.output = scratch / "set";
  options.parallel = workers(0);
  Progress progress(1);
  import_u3m(options, progress);
  const Dataset set = read_dataset(options.output);
  EXPECT_GE(set.pairs.size(), 30U);
  for (const DatasetPair& pair : set.pairs) {
    const auto published = [&](const std::string& attribute) {
      return read_transform(options.folder + "/gt/" + attribute_text(set, pair, attribute) + "-to-model.xf");
    };
    const RigidTransform truth = published("target_view").inverse() * published("source_view"),
                         made = read_transform(set.path(pair.truth));
    const Points points = read_surface(set.path(pair.source)).vertices;
    const double resolution = 0.575;  // mm, of these views
    EXPECT_LT(rotation_error_deg(made, truth), 1) << pair.name;
    EXPECT_LT((made.apply(points) - truth.apply(points)).rowwise().norm().mean() / resolution, 2) << pair.name;
  }
}

}  // namespace
}  // namespace corral
