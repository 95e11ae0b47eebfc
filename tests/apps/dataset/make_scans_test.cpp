// SPDX-License-Identifier: MIT
// Made scenes and views: sets that read back, with truths that fit, the same bytes however they come about.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "apps/dataset/make_u3m.h"
#include "apps/dataset/make_u3or.h"
#include "apps/runtime/workers.h"
#include "io/mesh/mesh_file.h"
#include "io/pairs/dataset_file.h"
#include "io/pose/transform_file.h"
#include "kernel/bounding_box.h"
#include "kernel/error.h"
#include "kernel/surface/search/nearest_points.h"
#include "kernel/surface/search/resolution.h"
#include "tests/io/scratch.h"
#include "tests/support/meshes.h"

namespace corral {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::ScratchFolder;

/// Five knobbly things in a folder.
std::vector<std::string> put_models(const ScratchFolder& folder) {
  std::vector<std::string> files;
  for (int i = 0; i < 5; ++i) {
    Mesh mesh = testing::bumpy_sphere(3, static_cast<std::uint64_t>(i));
    mesh.vertices.col(i % 3) *= 0.5;
    mesh.vertices.rowwise() += Eigen::RowVector3d(3, -2, 1);
    files.push_back(folder / ("thing" + std::to_string(i) + ".ply"));
    write_mesh(files.back(), mesh);
  }
  return files;
}

/// All files of a folder by their names, with what is in them.
std::map<std::string, std::string> contents(const std::string& folder) {
  std::map<std::string, std::string> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      found[fs::relative(entry.path(), folder).string()] = testing::text_of(entry.path().string());
  return found;
}

VisibilityCounts make_scenes(const std::vector<std::string>& models, const std::string& output, int threads = 1,
                             std::uint64_t seed = 1, int scenes = 2) {
  MakeU3orOptions options;
  options.models = models;
  options.output = output;
  options.scenes = scenes;
  options.seed = seed;
  options.parallel = workers(threads);
  Progress progress(1);
  return make_u3or(options, progress);
}

void make_views(const std::vector<std::string>& models, const std::string& output, int threads = 1, int views = 5) {
  MakeU3mOptions options;
  options.models = models;
  options.output = output;
  options.views = views;
  options.parallel = workers(threads);
  Progress progress(1);
  make_u3m(options, progress);
}

/// The median distance from a vertex of the view to the source under the truth, in pr of the view; from the target if the
/// source is the view.
double misfit(const Dataset& dataset, const DatasetPair& pair) {
  const Mesh source = read_mesh(dataset.path(pair.source)), target = read_mesh(dataset.path(pair.target));
  const Points moved = read_transform(dataset.path(pair.truth)).apply(source.vertices);
  const PointTree tree(target.vertices);
  NearestTracker tracker(tree);
  const double resolution = point_resolution(target.vertices);
  std::vector<double> distances;
  const Indices& nearest = tracker.nearest(moved, 2 * resolution);
  for (Eigen::Index row = 0; row < moved.rows(); ++row) {
    const int found = nearest[static_cast<std::size_t>(row)];
    if (found >= 0) distances.push_back((moved.row(row) - target.vertices.row(found)).norm() / resolution);
  }
  EXPECT_GT(distances.size(), 30U) << pair.name;
  if (distances.empty()) return 1e9;
  std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2),
                   distances.end());
  return distances[distances.size() / 2];
}

TEST(MakeU3or, ASetOfScenesWhoseTruthsFit) {
  const ScratchFolder folder;
  const VisibilityCounts counts = make_scenes(put_models(folder), folder / "set");
  const Dataset dataset = read_dataset(folder / "set");
  EXPECT_EQ(dataset.kind, "recognition");
  EXPECT_EQ(dataset.resolution, "mean");
  EXPECT_THAT(dataset.attributes, ElementsAre("scene", "model", "clutter", "occlusion"));
  ASSERT_GE(dataset.pairs.size(), 7U) << "of 4 + 5";
  std::map<std::string, double> shown;
  VisibilityCounts again;
  for (const DatasetPair& pair : dataset.pairs) {
    EXPECT_EQ(pair.name, pair.attributes[1] + "-" + pair.attributes[0]);
    EXPECT_LT(misfit(dataset, pair), 1) << pair.name;
    const double clutter = *attribute_number(dataset, pair, "clutter"),
                 occlusion = *attribute_number(dataset, pair, "occlusion");
    EXPECT_GT(occlusion, 50) << "one view of a closed surface";
    EXPECT_LE(occlusion, 95);
    shown[pair.attributes[0]] += 100 - clutter;
    again.add(occlusion / 100, clutter / 100);
    EXPECT_NEAR(bounding_box(read_mesh(dataset.path(pair.source)).vertices).diagonal(), 200, 1e-9);
  }
  EXPECT_EQ(again.occlusion, counts.occlusion);
  EXPECT_EQ(again.outside, counts.outside);
  for (const auto& [scene, share] : shown) {
    EXPECT_LE(share, 100.05) << scene;
    EXPECT_GT(share, 80) << scene << ": but for what is hidden too much to be a pair, the models are the scene";
    const Mesh view = read_mesh(dataset.path("scenes/" + scene + ".ply"));
    EXPECT_GT(view.triangles.rows(), view.vertices.rows());
    EXPECT_GT(view.vertices.rows(), 8000) << "dense enough, although the models are coarse";
    EXPECT_LT(view.vertices.col(2).maxCoeff(), 0) << "the sensor is at the origin";
  }
}

TEST(MakeU3or, TheSameBytesOnAnyThreadsAndAfterAnInterruption) {
  const ScratchFolder folder;
  const std::vector<std::string> models = put_models(folder);
  make_scenes(models, folder / "set");
  const auto expected = contents(folder / "set");
  make_scenes(models, folder / "other", 3);
  EXPECT_EQ(contents(folder / "other"), expected);
  // What an interruption in the second scene leaves; a wrong first scene shows that it is not made again.
  for (const char* gone : {"set/scenes/s02.csv", "set/scenes/s02.ply", "set/pairs.csv", "set/dataset.toml"})
    fs::remove(folder / gone);
  testing::put_text(folder / "set/scenes/s01.ply", "as it was");
  make_scenes(models, folder / "set");
  auto resumed = contents(folder / "set");
  EXPECT_EQ(resumed["scenes/s01.ply"], "as it was");
  resumed["scenes/s01.ply"] = expected.at("scenes/s01.ply");
  EXPECT_EQ(resumed, expected);
}

TEST(MakeU3or, AnotherSeedIsAnotherSet) {
  const ScratchFolder folder;
  const std::vector<std::string> models = put_models(folder);
  make_scenes(models, folder / "one", 1, 1, 1);
  make_scenes(models, folder / "two", 1, 2, 1);
  EXPECT_NE(contents(folder / "one").at("scenes/s01.ply"), contents(folder / "two").at("scenes/s01.ply"));
  EXPECT_THAT(testing::io_error_of([&] { make_scenes(models, folder / "one", 1, 2, 1); }),
              HasSubstr("expected an empty folder or the same ones"));
}

TEST(MakeU3or, RefusesModelsWithoutFacesOrOfOneName) {
  const ScratchFolder folder;
  std::vector<std::string> models = put_models(folder);
  fs::create_directory(folder / "twin");
  fs::copy_file(models[0], folder / "twin/thing0.ply");
  models.push_back(folder / "twin/thing0.ply");
  EXPECT_THAT(testing::io_error_of([&] { make_scenes(models, folder / "set"); }),
              HasSubstr("a second model named thing0"));
  models.back() = testing::put_text(folder / "cloud.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  EXPECT_THAT(testing::io_error_of([&] { make_scenes(models, folder / "set"); }), HasSubstr("cloud.xyz: has no faces"));
  EXPECT_THROW(make_scenes({}, folder / "set"), InvalidInput);
  EXPECT_FALSE(fs::exists(folder / "set"));
}

TEST(MakeU3m, ASetOfViewsWhoseTruthsFit) {
  const ScratchFolder folder;
  std::vector<std::string> models = put_models(folder);
  models.resize(2);
  make_views(models, folder / "set", 1, 8);
  const Dataset dataset = read_dataset(folder / "set");
  EXPECT_EQ(dataset.kind, "registration");
  EXPECT_THAT(dataset.attributes, ElementsAre("model", "source_view", "target_view", "overlap"));
  EXPECT_GE(dataset.pairs.size(), 16U) << "all neighbours on both rings at least";
  for (const DatasetPair& pair : dataset.pairs) {
    EXPECT_EQ(pair.name, pair.attributes[0] + "-" + pair.attributes[1] + "-" + pair.attributes[2]);
    EXPECT_LT(misfit(dataset, pair), 1) << pair.name;
    EXPECT_GE(*attribute_number(dataset, pair, "overlap"), 30);
    EXPECT_LE(*attribute_number(dataset, pair, "overlap"), 90);
  }
}

TEST(MakeU3m, TheSameBytesOnAnyThreadsAndAfterAnInterruption) {
  const ScratchFolder folder;
  std::vector<std::string> models = put_models(folder);
  models.resize(2);
  make_views(models, folder / "set");
  const auto expected = contents(folder / "set");
  make_views(models, folder / "other", 3);
  EXPECT_EQ(contents(folder / "other"), expected);
  for (const char* gone : {"set/views/thing1.csv", "set/views/thing1-v02.ply", "set/dataset.toml"})
    fs::remove(folder / gone);
  for (const char* kept : {"set/views/thing0-v01.ply", "set/views/thing1-v01.ply"})
    testing::put_text(folder / kept, "as it was");
  make_views(models, folder / "set");
  auto resumed = contents(folder / "set");
  for (const char* kept : {"views/thing0-v01.ply", "views/thing1-v01.ply"}) {
    EXPECT_EQ(resumed[kept], "as it was") << kept;
    resumed[kept] = expected.at(kept);
  }
  EXPECT_EQ(resumed, expected);
}

TEST(MakeU3m, ATableOfAPartThatIsAnotherIsNamed) {
  const ScratchFolder folder;
  std::vector<std::string> models = put_models(folder);
  models.resize(1);
  make_views(models, folder / "set");
  testing::put_text(folder / "set/views/thing0.csv", "pair,source,target\na,b,c\n");
  EXPECT_THAT(testing::io_error_of([&] { make_views(models, folder / "set"); }), HasSubstr("thing0.csv"));
}

TEST(MakeU3m, RefusesTooFewViews) {
  const ScratchFolder folder;
  EXPECT_THROW(make_views(put_models(folder), folder / "set", 1, 1), InvalidInput);
  EXPECT_FALSE(fs::exists(folder / "set"));
}

}  // namespace
}  // namespace corral
