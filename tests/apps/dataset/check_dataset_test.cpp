// SPDX-License-Identifier: MIT
// corral dataset check: a clean set passes, and each thing that can be wrong is named.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/pairs/dataset_file.h"
#include "kernel/random.h"
#include "kernel/surface/mesh/perturbation.h"
#include "kernel/surface/search/resolution.h"
#include "tests/support/program.h"

namespace corral {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::Outcome;
using ::testing::StartsWith;
using testing::Workplace;

/// Four pairs of different shapes, x1 .. x4, each with its truth.
class CheckDataset : public ::testing::Test {
 protected:
  CheckDataset() {
    set_.name = "set";
    for (int i = 1; i <= 4; ++i) {
      const std::string number = std::to_string(i);
      const Mesh mesh = testing::bumpy_sphere(3, static_cast<std::uint64_t>(i));
      const RigidTransform motion = random_motion(mesh, static_cast<std::uint64_t>(i));
      write_mesh(place_ / ("a" + number + ".ply"), mesh);
      write_mesh(place_ / ("b" + number + ".ply"), move_mesh(mesh, motion));
      place_.put("t" + number + ".xf", transform_text(motion));
      set_.pairs.push_back({"x" + number, "a" + number + ".ply", "b" + number + ".ply", "t" + number + ".xf", {}});
    }
  }

  Outcome check(const std::string& options = "") {
    place_.put("dataset.toml", dataset_toml_text(set_));
    place_.put("pairs.csv", pairs_csv_text(set_));
    return place_.corral("dataset check . " + options);
  }

  /// Exactly one line, which begins so and says so.
  void expect_finding(const std::string& begin, const std::string& says) {
    const Outcome outcome = check();
    EXPECT_EQ(outcome.status, 3);
    EXPECT_EQ(testing::lines_in(outcome.out), 1U) << outcome.out;
    EXPECT_THAT(outcome.out, AllOf(StartsWith(begin), HasSubstr(says)));
  }

  RigidTransform truth(int i) const { return read_transform(place_ / ("t" + std::to_string(i) + ".xf")); }
  Mesh mesh(const std::string& name) const { return read_mesh(place_ / name); }

  Workplace place_;
  Dataset set_;
};

TEST_F(CheckDataset, ACleanSetPasses) {
  const Outcome outcome = check();
  EXPECT_EQ(outcome.status, 0) << outcome.out;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, ".: 4 pairs, no problems\n");
  const auto json = check("--json").json();
  EXPECT_EQ(json["pairs"], 4);
  EXPECT_TRUE(json["findings"].empty());
  set_.pairs[2].truth = "";
  EXPECT_EQ(check().status, 0) << "a truth may be unknown";
}

TEST_F(CheckDataset, NamesFilesThatAreMissingOrUnreadableOnce) {
  set_.pairs[1].source = set_.pairs[2].source = "none.ply";
  expect_finding("x2/none.ply: ", "does not exist");
  set_.pairs[1].source = set_.pairs[2].source = "broken.ply";
  place_.put("broken.ply", "ply\nformat ascii 1.0\n");
  expect_finding("x2/broken.ply: ", "");
  place_.put("broken.ply",
             "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
             "end_header\n0 0 0\n");
  expect_finding("x2/broken.ply: ", "fewer than two distinct vertices");
}

TEST_F(CheckDataset, NamesATruthThatIsMissingOrNotRigid) {
  set_.pairs[3].truth = "none.xf";
  expect_finding("x4/none.xf: ", "does not exist");
  place_.put("none.xf", "2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 1\n");
  expect_finding("x4/none.xf: ", "rigid");
  const auto finding = check("--json").json()["findings"][0];
  EXPECT_EQ(finding["pair"], "x4");
  EXPECT_EQ(finding["file"], "none.xf");
  EXPECT_THAT(finding["problem"].get<std::string>(), HasSubstr("rigid"));
}

TEST_F(CheckDataset, NamesATruthThatFitsBetterInverted) {
  place_.put("t1.xf", transform_text(truth(1).inverse()));
  expect_finding("x1/t1.xf: ", "the truth fits inverted: 100 % within 2 pr");
}

TEST_F(CheckDataset, NamesATruthThatFitsNeitherWay) {
  place_.put("t1.xf", transform_text(truth(2)));
  expect_finding("x1/t1.xf: ", "the truth fits neither as given");
}

TEST_F(CheckDataset, ATruthThatIsItsOwnInverseIsFine) {
  set_.pairs[0].target = set_.pairs[0].source;
  place_.put("t1.xf", transform_text({}));
  EXPECT_EQ(check().status, 0);
}

TEST_F(CheckDataset, NamesWrongUnits) {
  RigidTransform metres = truth(1);
  metres.translation /= 1000;
  const std::string right = place_.text("t1.xf");
  place_.put("t1.xf", transform_text(metres));
  expect_finding("x1/t1.xf: ", "wrong units: the truth fits if its translation is multiplied by 1000");
  place_.put("t1.xf", right);
  for (const double factor : {1000.0, 0.1}) {
    const Mesh original = mesh("b1.ply");
    write_mesh(place_ / "scaled.ply", {original.vertices * factor, original.triangles});
    set_.pairs[0].target = "scaled.ply";
    expect_finding("x1: ", "units may differ: the target's pr is " + std::string(factor > 1 ? "1000" : "0.1"));
  }
}

TEST_F(CheckDataset, PrOutOfLineIsNamed) {
  // Two far vertices make a mesh ten times larger; its truth still fits.
  Mesh far = mesh("b3.ply");
  far.vertices.conservativeResize(far.vertices.rows() + 2, 3);
  far.vertices.bottomRows(2) << 90, 90, 90, 90, 90, 90.1;
  write_mesh(place_ / "b3.ply", far);
  expect_finding("x3/b3.ply: ", "unusual pr: its share of the diagonal is 0.0");
  write_mesh(place_ / "b3.ply", move_mesh(mesh("a3.ply"), truth(3)));
  set_.resolution = "5";
  EXPECT_THAT(check().out, HasSubstr("x1: unusual pr: 5 for the pair"));
}

TEST_F(CheckDataset, NamesAStrayVertex) {
  Mesh far = mesh("b3.ply");
  far.vertices.conservativeResize(far.vertices.rows() + 1, 3);
  far.vertices.bottomRows(1) << 2, 2, 900;
  write_mesh(place_ / "b3.ply", far);
  EXPECT_THAT(check().out, HasSubstr("x3/b3.ply: stray point: vertex " + std::to_string(far.vertices.rows() - 1)));
}

// Real scanners and printed parts: no problem, but worth knowing.
TEST_F(CheckDataset, ATruthThatFitsLooselyIsANote) {
  Mesh thicker = mesh("b2.ply");
  const Eigen::RowVector3d middle = thicker.vertices.colwise().mean();
  const double pr = point_resolution(thicker.vertices);
  for (int row = 0; row < thicker.vertices.rows(); ++row)
    thicker.vertices.row(row) += 1.4 * pr * (thicker.vertices.row(row) - middle).normalized();
  write_mesh(place_ / "b2.ply", thicker);
  const Outcome outcome = check();
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, StartsWith("x2/t2.xf: note: the truth fits loosely: "));
  EXPECT_EQ(outcome.err, ".: 4 pairs, no problems, 1 note\n");
  EXPECT_FALSE(check("--json").json()["findings"][0]["is_error"]);
}

TEST_F(CheckDataset, DuplicatePairsAreNamedWhateverTheirFilesAreCalled) {
  set_.pairs.push_back({"again", "a1.ply", "b1.ply", "t1.xf", {}});
  expect_finding("again: ", "duplicate pair: same surfaces and truth as x1");
  place_.put("copy.ply", place_.text("b1.ply"));
  place_.put("copy.xf", place_.text("t1.xf"));
  set_.pairs.back() = {"again", "a1.ply", "copy.ply", "copy.xf", {}};
  expect_finding("again: ", "same surfaces and truth as x1");
  // The same surfaces under another truth are another pair: a model may stand in a scene twice.
  Mesh twice = mesh("b1.ply");
  RigidTransform aside = truth(1);
  aside.translation.x() += 5;
  const Points second = aside.apply(mesh("a1.ply").vertices);
  Points both(twice.vertices.rows() + second.rows(), 3);
  both << twice.vertices, second;
  write_mesh(place_ / "two.ply", {both, Triangles(0, 3)});
  place_.put("aside.xf", transform_text(aside));
  set_.pairs[0].target = "two.ply";
  set_.pairs.back() = {"again", "a1.ply", "two.ply", "aside.xf", {}};
  const Outcome outcome = check();
  EXPECT_EQ(outcome.status, 0) << outcome.out;
}

TEST_F(CheckDataset, TheSameFindingsForAnyNumberOfThreads) {
  place_.put("t1.xf", transform_text(truth(1).inverse()));
  set_.pairs[1].source = "none.ply";
  set_.pairs.push_back({"again", "a3.ply", "b3.ply", "t3.xf", {}});
  const std::string one = check("--threads 1").out;
  EXPECT_EQ(testing::lines_in(one), 3U) << one;
  EXPECT_EQ(check("--threads 4").out, one);
  EXPECT_EQ(check("--threads -1").status, 2);
}

}  // namespace
}  // namespace corral
