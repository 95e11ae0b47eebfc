// SPDX-License-Identifier: MIT
// corral dataset import on small folders laid out as the published ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/pairs/dataset_file.h"
#include "kernel/surface/mesh/perturbation.h"
#include "kernel/surface/scan/visibility.h"
#include "kernel/surface/search/resolution.h"
#include "tests/support/program.h"

namespace corral {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::Workplace;

namespace fs = std::filesystem;

/// Scenes 0 and 7 of one model, scene 2 of a model that is not there, the rest missing.
class ImportB3r : public ::testing::Test {
 protected:
  ImportB3r() {
    for (const char* folder : {"in/models", "in/scenes", "in/gt"}) fs::create_directories(place_ / folder);
    write_mesh(place_ / "in/models/bun_zipper_0.ply", model_);
    for (const int k : {0, 7}) {
      const std::string scene = "Scene" + std::to_string(k);
      put_config(k, "/3D models/Stanford/bunny/bun_zipper.ply");
      for (const char* level : {"0.1", "0.3", "0.5"})
        write_mesh(place_ / ("in/scenes/" + scene + "_" + level + ".ply"),
                   add_gaussian_noise(move_mesh(model_, motion(k)), std::stod(level) * kEdge, 1));
    }
    put_config(2, "/3D models/Stanford/dragon/dragon.ply");
  }

  void put_config(int k, const std::string& model) {
    const std::string scene = "Scene" + std::to_string(k);
    place_.put("in/gt/Config" + scene + ".ini", "[MODELS]\n\nNUMBER = 1\n\nMODEL_0 = \"" + model +
                                                    "\" \nMODEL_0_GROUNDTRUTH = \"x.xf\" \nMODEL_0_CATEGORY = 0\n");
    place_.put("in/gt/" + scene + "-rs0.xf", transform_text(motion(k)));
  }
  RigidTransform motion(int k) const { return random_motion(model_, static_cast<std::uint64_t>(k) + 1); }

  static constexpr double kEdge = 0.05;
  Workplace place_;
  Mesh model_ = testing::bumpy_sphere(3, 1);
};

TEST_F(ImportB3r, MakesTheStudyFromModelsAndTruths) {
  fs::remove_all(place_ / "in/scenes");  // not needed
  const Outcome outcome = place_.corral("dataset import b3r in -o out");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("note: Scene1: no gt/ConfigScene1.ini\n"),
                                 HasSubstr("note: Scene2: no model dragon\n"), HasSubstr("note: Scene17: ")));
  EXPECT_EQ(testing::lines_in(outcome.err), 16U);
  const Dataset set = read_dataset(place_ / "out");
  EXPECT_EQ(set.resolution, "source");
  ASSERT_EQ(set.pairs.size(), 36U);
  EXPECT_EQ(set.pairs[18].name, "Scene7_noise0.05");
  EXPECT_EQ(fs::canonical(set.pairs[18].source), fs::canonical(place_ / "in/models/bun_zipper_0.ply"));
  EXPECT_EQ(read_transform(set.path(set.pairs[18].truth)).rotation, motion(7).rotation);
  EXPECT_EQ(attribute_text(set, set.pairs[18], "model"), "bun_zipper_0");
  EXPECT_EQ(place_.corral("dataset check out").status, 0);
  const std::string scene = place_.text("out/scenes/Scene7_noise0.05.ply");
  EXPECT_EQ(place_.corral("dataset import b3r in -o other --threads 2").status, 0);
  EXPECT_EQ(place_.text("other/scenes/Scene7_noise0.05.ply"), scene);
  EXPECT_EQ(place_.corral("dataset import b3r in -o seeded --seed 2").status, 0);
  EXPECT_NE(place_.text("seeded/scenes/Scene7_noise0.05.ply"), scene);
}

TEST_F(ImportB3r, TakesTheStoredScenesAndMeasuresTheirNoise) {
  fs::remove(place_ / "in/scenes/Scene7_0.3.ply");
  const Outcome outcome = place_.corral("dataset import b3r in -o out --levels stored");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("note: Scene7_0.3: no scenes/Scene7_0.3.ply\n"));
  const Dataset set = read_dataset(place_ / "out");
  ASSERT_EQ(set.pairs.size(), 5U);
  const double resolution = point_resolution(model_.vertices);
  for (const DatasetPair& pair : set.pairs) {
    const double stated = attribute_number(set, pair, "stated_noise_edges").value();
    EXPECT_NEAR(attribute_number(set, pair, "noise_pr").value() * resolution, stated * kEdge, 0.05 * stated * kEdge);
    EXPECT_EQ(fs::path(pair.target).filename(), pair.name + ".ply");
  }
  write_mesh(place_ / "in/scenes/Scene0_0.1.ply", testing::icosphere(2));
  EXPECT_THAT(place_.corral("dataset import b3r in -o again --levels stored").err,
              HasSubstr("Scene0_0.1.ply: has 162 vertices, expected the 642 of its model"));
  EXPECT_FALSE(fs::exists(place_ / "again/dataset.toml"));
}

TEST_F(ImportB3r, RefusesWhatIsNoSuchFolder) {
  EXPECT_THAT(place_.corral("dataset import b3r none -o out").err,
              HasSubstr("none/models: cannot be read as a folder"));
  place_.put("in/gt/ConfigScene0.ini", "[MODELS]\nNUMBER = 1\n");
  EXPECT_THAT(place_.corral("dataset import b3r in -o out").err, HasSubstr("ConfigScene0.ini: no line MODEL_0"));
  place_.put("in/gt/ConfigScene0.ini", "MODEL_0 = bunny\n");
  EXPECT_THAT(place_.corral("dataset import b3r in -o out").err,
              HasSubstr("ConfigScene0.ini, line 1: expected MODEL_0 ="));
  fs::remove_all(place_ / "in/gt");
  EXPECT_THAT(place_.corral("dataset import b3r in -o out").err, HasSubstr("no scene with its model and truth"));
  EXPECT_EQ(place_.corral("dataset import b3r in -o out --levels all").status, 2);
  EXPECT_FALSE(fs::exists(place_ / "out/dataset.toml"));
}

/// The T-rex in scenes 3 and 12; a chef without a model; a chicken without a truth.
class ImportU3or : public ::testing::Test {
 protected:
  ImportU3or() {
    for (const char* folder : {"in/models", "in/scenes", "in/gt"}) fs::create_directories(place_ / folder);
    write_mesh(place_ / "in/models/T-rex_high.ply", model_);
    write_mesh(place_ / "in/models/T-rex_large.ply", testing::bumpy_sphere(4, 1));
    write_mesh(place_ / "in/models/chicken.ply", model_);
    for (const int k : {3, 12}) {
      const RigidTransform motion = random_motion(model_, static_cast<std::uint64_t>(k));
      write_mesh(place_ / ("in/scenes/rs" + std::to_string(k) + (k == 3 ? ".ply" : "_proc.ply")), scene(motion));
      place_.put("in/gt/T-rex-rs" + std::to_string(k) + ".xf", transform_text(motion));
    }
    place_.put("in/gt/T-rex-rs3-old.xf", "outdated");
    place_.put("in/gt/occlusion.txt", kTable);
  }

  /// The model cut at its middle, where it stands in the scene.
  Mesh scene(const RigidTransform& motion) const {
    Indices seen;
    for (int face = 0; face < model_.triangles.rows(); ++face)
      if (model_.vertices(model_.triangles(face, 0), 2) > 0) seen.push_back(face);
    return move_mesh({model_.vertices, model_.triangles(seen, Eigen::all)}, motion);
  }

  const std::string kTable =
      "scene\tobject\t% occlusion\n3\ttrex\t40.5\n3\tchef\t70\n4\ttrex\t77\n12\ttrex\t60\n12\tchicken\t80\n";
  Workplace place_;
  Mesh model_ = testing::bumpy_sphere(3, 1);
};

TEST_F(ImportU3or, TakesThePairsThatAreThere) {
  const Outcome outcome = place_.corral("dataset import u3or in -o out");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(
      outcome.err,
      "note: no model chef\nnote: no model parasaurolophus\nnote: model T-rex: T-rex_high.ply, the largest of 2\n"
      "note: no truth chicken-rs12.xf\nnote: no scenes rs4\nnote: 2 of the 5 pairs of occlusion.txt are complete\n");
  const Dataset set = read_dataset(place_ / "out");
  EXPECT_EQ(set.kind, "recognition");
  EXPECT_EQ(set.units, "mm");
  ASSERT_EQ(set.pairs.size(), 2U);
  EXPECT_EQ(set.pairs[0].name, "T-rex-rs3");
  EXPECT_EQ(set.pairs[1].name, "T-rex-rs12");
  EXPECT_EQ(fs::path(set.pairs[1].target).filename(), "rs12_proc.ply");
  EXPECT_EQ(place_.text("out/" + set.pairs[0].truth), place_.text("in/gt/T-rex-rs3.xf"));
  EXPECT_EQ(attribute_text(set, set.pairs[0], "occlusion"), "40.5");
  const double ratio = surface_area(model_) / surface_area(scene({}));
  EXPECT_NEAR(attribute_number(set, set.pairs[0], "clutter").value(), 100 - 59.5 * ratio, 0.01);
  EXPECT_NEAR(attribute_number(set, set.pairs[0], "measured_clutter").value(), 0, 0.01)
      << "nothing but the model is there";
  EXPECT_NEAR(attribute_number(set, set.pairs[0], "measured_occlusion").value(), 0, 0.01)
      << "all its vertices are there";
}

TEST_F(ImportU3or, NamesTheLineOfATableThatIsWrong) {
  const auto complaint = [&](const std::string& line) {
    place_.put("in/gt/occlusion.txt", "scene object % occlusion\n" + line + "\n");
    const Outcome outcome = place_.corral("dataset import u3or in -o out");
    EXPECT_EQ(outcome.status, 3);
    EXPECT_FALSE(fs::exists(place_ / "out"));
    return outcome.err;
  };
  EXPECT_THAT(complaint("3 trex"), HasSubstr("occlusion.txt, line 2: found 2 fields"));
  EXPECT_THAT(complaint("3 rhino 70"), HasSubstr("expected chef, chicken, para or trex"));
  EXPECT_THAT(complaint("3 trex 101"), HasSubstr("expected 0 .. 100 percent"));
  EXPECT_THAT(complaint("0 trex 70"), HasSubstr("line 2"));
  EXPECT_THAT(complaint("4 trex 70"), HasSubstr("no pair with its model, scene and truth"));
  fs::remove(place_ / "in/gt/occlusion.txt");
  EXPECT_THAT(place_.corral("dataset import u3or in -o out").err, HasSubstr("no occlusion.txt"));
}

TEST_F(ImportU3or, AnUnreadableMeshOrTruthEndsIt) {
  place_.put("in/gt/T-rex-rs3.xf", "1 0 0\n");
  EXPECT_THAT(place_.corral("dataset import u3or in -o out").err, HasSubstr("T-rex-rs3.xf"));
  EXPECT_FALSE(fs::exists(place_ / "out/dataset.toml"));
  place_.put("in/scenes/rs3.ply", "ply\n");
  EXPECT_THAT(place_.corral("dataset import u3or in -o other").err, HasSubstr("rs3.ply"));
  EXPECT_FALSE(fs::exists(place_ / "other/dataset.toml"));
}

}  // namespace
}  // namespace corral
