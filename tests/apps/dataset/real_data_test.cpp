// SPDX-License-Identifier: MIT
// The published sets themselves, where CORRAL_REAL_DATA names a folder with b3r/ and u3or/ in their published layouts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <set>

#include "apps/dataset/check_dataset.h"
#include "apps/dataset/import_b3r.h"
#include "apps/dataset/import_u3or.h"
#include "apps/runtime/workers.h"
#include "io/disk/file.h"
#include "io/mesh/mesh_file.h"
#include "io/pose/transform_file.h"
#include "kernel/surface/mesh/half_edges.h"
#include "kernel/surface/mesh/perturbation.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::ScratchFolder;

class PublishedData : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* folder = std::getenv("CORRAL_REAL_DATA");
    if (!folder) GTEST_SKIP() << "CORRAL_REAL_DATA names no folder with the published sets";
    folder_ = folder;
  }

  Dataset import_b3r_to(const std::string& output, bool stored) const {
    Progress progress(kB3rScenes);
    import_b3r({folder_ + "/b3r", output, stored, 1, workers(0)}, progress);
    return read_dataset(output);
  }
  Dataset import_u3or_to(const std::string& output) const {
    Progress progress(kU3orPairs);
    import_u3or({folder_ + "/u3or", output, workers(0)}, progress);
    return read_dataset(output);
  }

  static std::vector<Finding> check(const Dataset& dataset) {
    Progress progress(1);
    return check_dataset(dataset, workers(0), progress);
  }

  /// Every truth is confirmed, and its inverse flagged for every pair.
  static void expect_truths_hold(Dataset dataset) {
    for (const Finding& finding : check(dataset))
      ADD_FAILURE() << finding.pair << "/" << finding.file << ": " << finding.problem;
    std::set<std::string> inverted;
    for (DatasetPair& pair : dataset.pairs) {
      const std::string path = dataset.path(pair.name + "-inverse.xf");
      write_file(path, transform_text(read_transform(dataset.path(pair.truth)).inverse()));
      pair.truth = pair.name + "-inverse.xf";
    }
    for (const Finding& finding : check(dataset)) {
      EXPECT_THAT(finding.problem, HasSubstr("the truth fits inverted"));
      inverted.insert(finding.pair);
    }
    EXPECT_EQ(inverted.size(), dataset.pairs.size());
  }

  std::string folder_;
  ScratchFolder output_;
};

TEST_F(PublishedData, EveryTruthOfTheStoredRetrievalScenesHolds) {
  const Dataset dataset = import_b3r_to(output_ / "b3r", true);
  EXPECT_GE(dataset.pairs.size(), 36U);
  expect_truths_hold(dataset);
}

TEST_F(PublishedData, EveryTruthOfTheRecognitionScenesHolds) {
  const Dataset dataset = import_u3or_to(output_ / "u3or");
  EXPECT_GE(dataset.pairs.size(), 4U);
  expect_truths_hold(dataset);
}

TEST_F(PublishedData, TheNoiseOfTheStoredScenesIsMeasuredBack) {
  const Dataset dataset = import_b3r_to(output_ / "b3r", true);
  for (const DatasetPair& pair : dataset.pairs) {
    const Mesh model = read_mesh(dataset.path(pair.source));
    const Mesh clean = move_mesh(model, read_transform(dataset.path(pair.truth)));
    const double stated = attribute_number(dataset, pair, "stated_noise_edges").value();
    const double edge = inspect_half_edges(model).mean_edge_length;
    EXPECT_NEAR(noise_deviation(clean, read_mesh(pair.target)) / edge, stated, 0.05 * stated) << pair.name;
  }
}

TEST_F(PublishedData, TheTableOfOcclusionsIsThePublishedOne) {
  const auto lines = read_occlusion_table(folder_ + "/u3or/gt/occlusion.txt");
  EXPECT_EQ(lines.size(), static_cast<std::size_t>(kU3orPairs));
  std::vector<int> bins(7);
  std::map<std::string, int> models;
  for (const OcclusionLine& line : lines) {
    ++bins[static_cast<std::size_t>((std::stod(line.percent) - 60) / 5)];
    ++models[line.model];
  }
  EXPECT_THAT(bins, ElementsAre(21, 29, 41, 42, 42, 11, 2));  // [60,65) .. [90,95)
  EXPECT_THAT(models, ElementsAre(::testing::Pair("T-rex", 45), ::testing::Pair("chef", 50),
                                  ::testing::Pair("chicken", 48), ::testing::Pair("parasaurolophus", 45)));
}

TEST_F(PublishedData, ClutterByAreasIsThatOfTheIdentity) {
  const Dataset dataset = import_u3or_to(output_ / "u3or");
  for (const DatasetPair& pair : dataset.pairs)
    EXPECT_NEAR(attribute_number(dataset, pair, "measured_clutter").value(),
                attribute_number(dataset, pair, "clutter").value(), 3)
        << pair.name;
}

}  // namespace
}  // namespace corral
