// SPDX-License-Identifier: MIT
// corral dataset make as a user types it: what comes out, twice, interrupted, and where it cannot be written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "io/pairs/dataset_file.h"
#include "kernel/surface/mesh/perturbation.h"
#include "kernel/surface/search/resolution.h"
#include "tests/support/program.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::Workplace;

namespace fs = std::filesystem;

std::string off_text(const Mesh& mesh) {
  std::ostringstream text;
  text << "OFF\n" << mesh.vertices.rows() << " " << mesh.triangles.rows() << " 0\n" << mesh.vertices << "\n";
  for (Eigen::Index row = 0; row < mesh.triangles.rows(); ++row) text << "3 " << mesh.triangles.row(row) << "\n";
  return text.str();
}

/// Two models in meshes/, one of them as OFF with an odd name.
void put_models(const Workplace& place) {
  fs::create_directory(place / "meshes");
  write_mesh(place / "meshes/ball.ply", testing::bumpy_sphere(3, 1));
  place.put("meshes/odd one.off", off_text(testing::bumpy_sphere(2, 2)));
  place.put("meshes/notes.txt", "no mesh");
}

/// Every file of a folder by its name in it.
std::map<std::string, std::string> contents(const std::string& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files[fs::relative(entry.path(), folder).string()] = testing::text_of(entry.path().string());
  return files;
}

TEST(MakeB3r, MakesTheLevelsOfTheStudy) {
  const Workplace place;
  put_models(place);
  const Outcome made = place.corral("dataset make b3r --models meshes -o set --scenes-per-model 2 --seed 7");
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_EQ(made.out + made.err, "");
  const Dataset set = read_dataset(place / "set");
  EXPECT_EQ(set.name, "b3r");
  EXPECT_EQ(set.resolution, "source");
  EXPECT_THAT(set.attributes, ElementsAre("model", "scene", "noise_pr", "density"));
  ASSERT_EQ(set.pairs.size(), 72U);
  std::map<std::string, int> noises, densities;
  for (const DatasetPair& pair : set.pairs) {
    ++noises[attribute_text(set, pair, "noise_pr")];
    ++densities[attribute_text(set, pair, "density")];
  }
  std::vector<std::string> names;
  for (const auto& [noise, count] : noises) names.push_back(noise + "x" + std::to_string(count));
  EXPECT_THAT(names, ::testing::UnorderedElementsAre("0.05x4", "0.1x4", "0.15x4", "0.2x4", "0.25x4", "0.3x4", "0.35x4",
                                                     "0.4x4", "0.45x4", "0x36"));
  EXPECT_EQ(densities["0.1"], 4);
  EXPECT_EQ(densities["0.9"], 4);
  EXPECT_EQ(densities["1"], 36);
  EXPECT_EQ(set.pairs[0].name, "ball-1_noise0.05");
  EXPECT_EQ(set.pairs[71].name, "odd-one-2_density0.1");
}

TEST(MakeB3r, ScenesAreMovedNoisyOrThinnedModels) {
  const Workplace place;
  put_models(place);
  ASSERT_EQ(place.corral("dataset make b3r --models meshes -o set --scenes-per-model 1").status, 0);
  const Dataset set = read_dataset(place / "set");
  const Mesh model = testing::bumpy_sphere(3, 1);
  const double resolution = point_resolution(model.vertices);
  std::vector<Points> noises;
  for (const DatasetPair& pair : set.pairs) {
    if (attribute_text(set, pair, "model") != "ball") continue;
    EXPECT_EQ(read_mesh(set.path(pair.source)).vertices, model.vertices);
    const Mesh clean = move_mesh(model, read_transform(set.path(pair.truth))), scene = read_mesh(set.path(pair.target));
    const double density = attribute_number(set, pair, "density").value();
    if (density < 1) {
      EXPECT_EQ(scene.vertices.rows(), std::lround(density * 642)) << pair.name;
      for (Eigen::Index row = 0; row < scene.vertices.rows(); ++row)
        ASSERT_EQ((clean.vertices.rowwise() - scene.vertices.row(row)).rowwise().squaredNorm().minCoeff(), 0);
      continue;
    }
    const double expected = attribute_number(set, pair, "noise_pr").value() * resolution;
    EXPECT_NEAR(noise_deviation(clean, scene), expected, 0.1 * expected) << pair.name;
    EXPECT_EQ(scene.triangles, model.triangles);
    noises.emplace_back((scene.vertices - clean.vertices) / expected);
  }
  ASSERT_EQ(noises.size(), 9U);
  for (std::size_t i = 1; i < noises.size(); ++i)
    EXPECT_GT((noises[i] - noises[i - 1]).norm(), noises[i].norm()) << "levels share their noise";
}

TEST(MakeB3r, SameSeedSameBytesForAnyNumberOfThreads) {
  const Workplace place;
  put_models(place);
  const auto make = [&](const std::string& options) {
    EXPECT_EQ(place.corral("dataset make b3r --models meshes --scenes-per-model 1 " + options).status, 0);
  };
  make("-o one --threads 1");
  make("-o three --threads 3");
  make("-o other --seed 2");
  const auto one = contents(place / "one");
  EXPECT_EQ(one.size(), 36U + 2 + 2 + 3);
  EXPECT_EQ(one, contents(place / "three"));
  const auto other = contents(place / "other");
  for (const auto& [name, content] : one)
    if (name.rfind("scenes/", 0) == 0 || name.rfind("truth/", 0) == 0) {
      EXPECT_NE(content, other.at(name)) << name;
    }
}

TEST(MakeB3r, GoesOnWhereItWasInterrupted) {
  const Workplace place;
  put_models(place);
  const std::string line = "dataset make b3r --models meshes -o set --scenes-per-model 1";
  ASSERT_EQ(place.corral(line).status, 0);
  const auto whole = contents(place / "set");
  for (const char* name : {"dataset.toml", "pairs.csv", "scenes/odd-one-1_noise0.2.ply"})
    fs::remove(place / ("set/" + std::string(name)));
  const Outcome half = place.corral("dataset check set");
  EXPECT_EQ(half.status, 3);
  EXPECT_THAT(half.err, HasSubstr("set: is unfinished"));
  place.put("set/scenes/ball-1_noise0.1.ply", "kept");
  place.put("set/scenes/odd-one-1_noise0.2.ply.part-aB3dE6", "what a killed write left");
  ASSERT_EQ(place.corral(line).status, 0);
  auto again = contents(place / "set");
  EXPECT_EQ(again["scenes/ball-1_noise0.1.ply"], "kept") << "a finished file is made anew";
  again["scenes/ball-1_noise0.1.ply"] = whole.at("scenes/ball-1_noise0.1.ply");
  EXPECT_EQ(again, whole);
}

TEST(MakeB3r, AFolderHoldsOneSet) {
  const Workplace place;
  put_models(place);
  const std::string line = "dataset make b3r --models meshes --scenes-per-model 1 ";
  ASSERT_EQ(place.corral(line + "-o set").status, 0);
  const auto before = contents(place / "set");
  const auto expect_refusal = [&](const std::string& options, const std::string& says) {
    const Outcome outcome = place.corral(line + options);
    EXPECT_EQ(outcome.status, 3) << options;
    EXPECT_THAT(outcome.err, HasSubstr(says));
    EXPECT_EQ(testing::lines_in(outcome.err), 1U);
  };
  expect_refusal("-o set --seed 2", "holds a data set made from other input or options");
  write_mesh(place / "meshes/ball.ply", testing::bumpy_sphere(3, 2));
  expect_refusal("-o set", "holds a data set made from other input or options");
  EXPECT_EQ(contents(place / "set"), before);
  fs::create_directory(place / "mine");
  place.put("mine/dataset.toml", "name = \"mine\"\n");
  expect_refusal("-o mine", "that this command did not make");
  EXPECT_EQ(contents(place / "mine").size(), 1U);
}

TEST(MakeB3r, WhereItCannotWriteItSaysSoOnceAndLeavesNoSet) {
  const Workplace place;
  put_models(place);
  place.put("file", "");
  const std::string line = "dataset make b3r --models meshes --scenes-per-model 1 -o ";
  for (const char* output : {"file", "file/set", "/proc/set"}) {
    const Outcome outcome = place.corral(line + output);
    EXPECT_EQ(outcome.status, 3) << output;
    EXPECT_THAT(outcome.err, HasSubstr(output));
    EXPECT_EQ(testing::lines_in(outcome.err), 1U) << outcome.err;
  }
  // No file above 16 blocks of 512 bytes: the scenes are larger, and fail as on a full disk.
  const std::string full = "( cd '" + place / "" + "' && trap '' XFSZ && ulimit -f 16 && '" CORRAL_PROGRAM "' " + line +
                           "full ) 2>'" + place / "said" + "'";
  EXPECT_EQ(WEXITSTATUS(std::system(full.c_str())), 3);
  EXPECT_THAT(place.text("said"), HasSubstr("cannot be written"));
  EXPECT_EQ(testing::lines_in(place.text("said")), 1U);
  for (const auto& [name, content] : contents(place / "full")) {
    EXPECT_TRUE(name == "recipe.txt" || name.rfind(".ply") == name.size() - 4 || name.rfind(".xf") == name.size() - 3)
        << name;
    if (name.rfind(".ply") == name.size() - 4) {
      EXPECT_NO_THROW(parse_ply(name, content));
    }
  }
  EXPECT_THAT(place.corral("dataset check full").err, HasSubstr("unfinished"));
  EXPECT_EQ(place.corral(line + "full").status, 0) << "with room again it goes on";
  EXPECT_EQ(place.corral("dataset check full").status, 0);
}

TEST(MakeB3r, RefusesModelsThatItCannotTellApartOrRead) {
  const Workplace place;
  const std::string line = "dataset make b3r --models meshes -o set";
  EXPECT_THAT(place.corral(line).err, HasSubstr("meshes: cannot be read as a folder"));
  fs::create_directory(place / "meshes");
  EXPECT_THAT(place.corral(line).err, HasSubstr("meshes: has no meshes, expected files such as"));
  put_models(place);
  write_mesh(place / "meshes/odd-one.ply", testing::icosphere(1));
  EXPECT_THAT(place.corral(line).err, HasSubstr("a second model named odd-one"));
  fs::remove(place / "meshes/odd-one.ply");
  write_mesh(place / "meshes/small.ply", testing::icosphere(1));
  EXPECT_THAT(place.corral(line).err, HasSubstr("models/small.ply: has 42 vertices, expected at least 100"));
  place.put("meshes/broken.ply", "ply\n");
  EXPECT_THAT(place.corral(line + "2").err, HasSubstr("meshes/broken.ply"));
  EXPECT_FALSE(fs::exists(place / "set/dataset.toml"));
  EXPECT_EQ(place.corral("dataset make b3r -o set").status, 2);
  EXPECT_EQ(place.corral(line + " --scenes-per-model 0").status, 2);
  EXPECT_EQ(place.corral("dataset make").status, 2);
  EXPECT_EQ(place.corral("dataset").status, 2);
}

/// Four more models, for heaps of five.
void put_more_models(const Workplace& place) {
  for (std::uint64_t seed = 3; seed < 7; ++seed)
    write_mesh(place / ("meshes/more" + std::to_string(seed) + ".ply"), testing::bumpy_sphere(3, seed));
}

TEST(MakeScans, HeapsAndViewsAreSetsWhoseTruthsHold) {
  const Workplace place;
  put_models(place);
  put_more_models(place);
  const Outcome heaps = place.corral("dataset make u3or --models meshes -o heaps --scenes 1 --seed 3");
  ASSERT_EQ(heaps.status, 0) << heaps.err;
  EXPECT_THAT(heaps.err, HasSubstr("occlusion"));
  const Dataset recognition = read_dataset(place / "heaps");
  EXPECT_EQ(recognition.kind, "recognition");
  EXPECT_GE(recognition.pairs.size(), 3U);
  for (const char* name : {"more3.ply", "more4.ply", "more5.ply", "more6.ply"})
    fs::remove(place / ("meshes/" + std::string(name)));
  const Outcome views = place.corral("dataset make u3m --models meshes -o views --views 4 --noise-pr 0.05");
  ASSERT_EQ(views.status, 0) << views.err;
  EXPECT_EQ(read_dataset(place / "views").kind, "registration");
  for (const char* name : {"heaps", "views"}) {
    const Outcome checked = place.corral("dataset check " + std::string(name));
    EXPECT_EQ(checked.status, 0) << checked.out;
  }
  EXPECT_EQ(place.corral("dataset make u3m --models meshes -o other --views 1").status, 2);
  EXPECT_EQ(place.corral("dataset make u3or --models meshes -o other --scenes 0").status, 2);
}

TEST(MakeDefault, NamesThePackageOfAMissingMesh) {
  const Workplace place;
  put_models(place);
  const Outcome outcome = place.corral("dataset make default --meshes meshes -o set");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err,
              HasSubstr("meshes/bunny00.off: does not exist, expected it from Debian's package libcgal-demo"));
  EXPECT_FALSE(fs::exists(place / "set"));
}

TEST(DatasetList, SaysWhereEachSetComesFrom) {
  const Workplace place;
  const auto sets = place.corral("dataset list --json").json();
  std::vector<std::string> names;
  const std::string text = place.corral("dataset list").out;
  for (const auto& set : sets) {
    names.push_back(set["name"]);
    for (const char* key : {"title", "origin", "place", "terms", "use"}) EXPECT_NE(set[key], "") << names.back();
    EXPECT_FALSE(set["layout"].empty());
    for (const auto& file : set["known_files"]) EXPECT_EQ(file["sha256"].get<std::string>().size(), 64U);
    EXPECT_THAT(text, HasSubstr("\n  use       " + set["use"].get<std::string>()));
  }
  EXPECT_THAT(names, ElementsAre("default", "b3r", "stanford", "u3m", "u3or", "3dmatch", "eth-tls", "kitti"));
}

}  // namespace
}  // namespace corral
