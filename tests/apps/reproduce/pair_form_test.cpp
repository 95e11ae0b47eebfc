// SPDX-License-Identifier: MIT
#include "apps/reproduce/pair_form.h"

#include <gtest/gtest.h>

#include "apps/pair/read_surface.h"
#include "io/pairs/dataset_file.h"
#include "io/pose/transform_file.h"
#include "tests/support/small_study.h"

namespace corral {
namespace {

class PairForms : public ::testing::Test {
 protected:
  PairForms() { testing::put_small_dataset(place_); }
  Dataset made(PairForm form) const {
    write_pair_form(place_ / "data", "b3r", form, place_ / "other");
    return read_dataset(place_ / "other/b3r");
  }
  const testing::Workplace place_;
};

TEST_F(PairForms, SwappedPairsHaveTheInverseTruth) {
  const Dataset before = read_dataset(place_ / "data/b3r"), after = made(PairForm::Swapped);
  ASSERT_EQ(after.pairs.size(), before.pairs.size());
  EXPECT_EQ(after.resolution, "target");  // that of the same surface as before
  EXPECT_EQ(after.attributes, before.attributes);
  for (std::size_t i = 0; i < after.pairs.size(); ++i) {
    const DatasetPair was = before.with_paths(before.pairs[i]), is = after.with_paths(after.pairs[i]);
    EXPECT_EQ(is.name, was.name);
    EXPECT_EQ(read_surface(is.source).vertices, read_surface(was.target).vertices);
    EXPECT_EQ(read_surface(is.target).vertices, read_surface(was.source).vertices);
    const RigidTransform both = RigidTransform(read_transform(is.truth)) * RigidTransform(read_transform(was.truth));
    EXPECT_LT((both.rotation - Eigen::Matrix3d::Identity()).norm() + both.translation.norm(), 1e-12);
  }
}

TEST_F(PairForms, CloudsHaveTheSameVerticesAndNoFaces) {
  const Dataset before = read_dataset(place_ / "data/b3r"), after = made(PairForm::Cloud);
  for (std::size_t i = 0; i < after.pairs.size(); ++i) {
    const DatasetPair was = before.with_paths(before.pairs[i]), is = after.with_paths(after.pairs[i]);
    EXPECT_EQ(read_surface(is.target).vertices, read_surface(was.target).vertices);
    EXPECT_EQ(read_surface(is.target).triangles.rows(), 0);
    EXPECT_GT(read_surface(is.source).triangles.rows(), 0);
  }
}

TEST_F(PairForms, AreMadeOnceAndForOneFormOnly) {
  made(PairForm::Cloud);
  const std::string pairs = place_.text("other/b3r/pairs.csv");
  std::filesystem::remove(place_ / "other/b3r/dataset.toml");  // as if the call had been stopped before its end
  made(PairForm::Cloud);
  EXPECT_EQ(place_.text("other/b3r/pairs.csv"), pairs);
  EXPECT_THROW(made(PairForm::Swapped), IoError);
}

}  // namespace
}  // namespace corral
