// SPDX-License-Identifier: MIT
#include "apps/dataset/import_u3m.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "apps/runtime/workers.h"
#include "io/disk/file.h"
#include "io/mesh/mesh_file.h"
#include "io/pairs/dataset_file.h"
#include "io/pose/transform_file.h"
#include "kernel/number_text.h"
#include "kernel/surface/search/resolution.h"
#include "tests/io/scratch.h"
#include "tests/support/object_views.h"

namespace corral {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::io_error_of;
using ::testing::IsEmpty;
using testing::object_views;
using testing::ObjectViews;
using testing::put_text;
using testing::ScratchFolder;

std::string list_of(const Points& points) {
  std::string text;
  for (Eigen::Index row = 0; row < points.rows(); ++row)
    text += to_text(points(row, 0)) + " " + to_text(points(row, 1)) + " " + to_text(points(row, 2)) + "\n";
  return text;
}

/// The first views of an object in the published layout, with transforms into one frame.
struct Published {
  explicit Published(int count) {
    make_folder(scratch / "views");
    make_folder(scratch / "gt");
    for (int i = 0; i < count; ++i) {
      const auto view = static_cast<std::size_t>(i);
      const std::string name = "blob_view00" + std::to_string(i + 1);
      put_text(scratch / ("views/" + name + ".txt"), list_of(object.views[view].vertices));
      put_text(scratch / ("gt/" + name + "-to-model.xf"), transform_text(object.world_from_view[view]));
    }
    put_text(scratch / "views/README.txt", "not a view\n");
  }

  std::vector<std::string> import(const std::string& truth, double least_overlap = 0.3,
                                  double most_overlap = 0.9) const {
    ImportU3mOptions options;
    options.folder = scratch.path();
    options.output = scratch / "set";
    if (!truth.empty()) options.truth = scratch / truth;
    options.least_overlap = least_overlap;
    options.most_overlap = most_overlap;
    options.parallel = workers(0);
    Progress progress(1);
    return import_u3m(options, progress);
  }
  Dataset set() const { return read_dataset(scratch / "set"); }

  ScratchFolder scratch;
  ObjectViews object = object_views(9, 3);
};

/// Definition of the overlap in double loops.
double plain_overlap(const Points& source, const Points& target, double threshold) {
  const auto count = [&](const Points& from, const Points& to) {
    int near = 0;
    for (Eigen::Index row = 0; row < from.rows(); ++row)
      near += (to.rowwise() - from.row(row)).rowwise().squaredNorm().minCoeff() <= threshold * threshold;
    return near;
  };
  return double(std::min(count(source, target), count(target, source))) /
         double(std::min(source.rows(), target.rows()));
}

TEST(ImportU3m, PublishedTransformsBecomeTheTruthOfPairs) {
  const Published published(3);
  EXPECT_THAT(published.import("gt"), IsEmpty());
  const Dataset set = published.set();
  EXPECT_EQ(set.kind, "registration");
  EXPECT_THAT(set.attributes, ElementsAre("model", "source_view", "target_view", "overlap"));
  ASSERT_GE(set.pairs.size(), 2U);
  double resolution = 0;
  for (int i = 0; i < 3; ++i) resolution += point_resolution(published.object.views[std::size_t(i)].vertices) / 3;
  for (const DatasetPair& pair : set.pairs) {
    const int a = pair.attributes[1].back() - '1', b = pair.attributes[2].back() - '1';
    EXPECT_EQ(pair.attributes[0], "blob");
    const Mesh source = read_mesh(set.path(pair.source)), target = read_mesh(set.path(pair.target));
    EXPECT_EQ(source.vertices, published.object.views[std::size_t(a)].vertices);
    EXPECT_GT(source.triangles.rows(), source.vertices.rows());
    const RigidTransform truth = read_transform(set.path(pair.truth)), expected = published.object.between(a, b);
    EXPECT_TRUE(truth.rotation.isApprox(expected.rotation, 1e-12));
    EXPECT_TRUE(truth.translation.isApprox(expected.translation, 1e-9));
    const double overlap = *attribute_number(set, pair, "overlap");
    EXPECT_NEAR(overlap, 100 * plain_overlap(truth.apply(source.vertices), target.vertices, 2 * resolution), 0.02);
    EXPECT_GE(overlap, 30);
    EXPECT_LE(overlap, 90);
  }
}

TEST(ImportU3m, PairsThatShareTooLittleOrTooMuchAreLeftOut) {
  const Published published(3);
  published.import("gt", 0.01, 1);
  const Dataset all = published.set();
  ASSERT_EQ(all.pairs.size(), 3U);
  std::vector<double> overlaps;
  for (const DatasetPair& pair : all.pairs) overlaps.push_back(*attribute_number(all, pair, "overlap") / 100);
  std::sort(overlaps.begin(), overlaps.end());
  published.import("gt", overlaps[1] - 1e-9, overlaps[1] + 1e-9);
  ASSERT_EQ(published.set().pairs.size(), 1U);
  EXPECT_NEAR(*attribute_number(published.set(), published.set().pairs[0], "overlap"), 100 * overlaps[1], 1e-6);
  EXPECT_THAT(io_error_of([&] { published.import("gt", 0.99, 1); }), HasSubstr("no two views overlap enough"));
}

TEST(ImportU3m, WithoutTransformsTheTruthIsMade) {
  const Published published(4);
  EXPECT_THAT(published.import(""), Each(HasSubstr(": unchecked, off by 0.00 pr"))) << "a chain";
  const Dataset set = published.set();
  ASSERT_GE(set.pairs.size(), 3U);
  for (const DatasetPair& pair : set.pairs) {
    const int a = pair.attributes[1].back() - '1', b = pair.attributes[2].back() - '1';
    const RigidTransform truth = read_transform(set.path(pair.truth));
    const Points& points = published.object.views[std::size_t(a)].vertices;
    EXPECT_LT((truth.apply(points) - published.object.between(a, b).apply(points)).rowwise().norm().mean(),
              1.5 * point_resolution(points))
        << pair.name;
  }
}

TEST(ImportU3m, APublishedTruthThatTheViewsContradictIsShown) {
  const Published published(2);
  RigidTransform inverted = published.object.world_from_view[1];
  inverted.rotation.col(0) *= -1;
  inverted.rotation.col(1) *= -1;  // half a turn about the ray through the object
  put_text(published.scratch / "gt/blob_view002-to-model.xf", transform_text(inverted));
  EXPECT_THAT(published.import("gt", 0),
              ElementsAre(HasSubstr("blob_view001 -> blob_view002: the views contradict the truth")));
  EXPECT_EQ(published.set().pairs.size(), 1U) << "what is published is kept";
}

TEST(ImportU3m, WhatIsWrongIsNamed) {
  const Published published(2);
  const auto refusal = [&](const std::string& truth) { return io_error_of([&] { published.import(truth); }); };
  EXPECT_THAT(refusal("nowhere"), HasSubstr("nowhere"));
  EXPECT_THAT(refusal("views"), HasSubstr("no transforms of blob"));
  put_text(published.scratch / "views/blob_view001.xyz", "1 2 3\n");
  EXPECT_THAT(refusal("gt"), HasSubstr("a second view of this name"));
  ScratchFolder empty;
  ImportU3mOptions options;
  options.folder = empty.path();
  options.output = empty / "set";
  Progress progress(1);
  EXPECT_THAT(io_error_of([&] { import_u3m(options, progress); }), HasSubstr("no views"));
}

}  // namespace
}  // namespace corral
