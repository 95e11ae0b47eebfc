// SPDX-License-Identifier: MIT
#include "apps/study/manifest.h"

#include <gtest/gtest.h>

#include "tests/io/scratch.h"

namespace corral {
namespace {

using testing::put_text;
using testing::ScratchFolder;

// A study must notice when the truth of a pair changes, by its name or by its file.
TEST(Manifest, ATruthThatIsOneOfSeveralHasAHashOfItsOwn) {
  const ScratchFolder folder;
  const std::string log = put_text(folder / "gt.log", "0 1 2\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  WorkList list;
  for (const char* key : {"", ":0,1", ":1,0", ":x"}) {
    WorkUnit unit;
    unit.pair.truth = log + key;
    list.units.push_back(unit);
  }
  const InputHashes before = hash_inputs(list, {0, 1, 2, 3}, 2);
  EXPECT_EQ(before.size(), 4U);
  for (const auto& [name, hash] : before) {
    EXPECT_NE(hash, "") << name;
    for (const auto& [other, its_hash] : before)
      if (name != other) {
        EXPECT_NE(hash, its_hash) << name << " and " << other;
      }
  }
  put_text(log, "0 1 2\n1 0 0 9\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  for (const auto& [name, hash] : hash_inputs(list, {0, 1, 2, 3}, 2)) EXPECT_NE(hash, before.at(name)) << name;
}

}  // namespace
}  // namespace corral
