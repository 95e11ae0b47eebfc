// SPDX-License-Identifier: MIT
#include "apps/study/content_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/pair/match_pair.h"
#include "io/matches/matches_file.h"
#include "kernel/random.h"
#include "kernel/surface/mesh/perturbation.h"
#include "tests/io/scratch.h"
#include "tests/support/meshes.h"

namespace corral {
namespace {

using testing::put_text;
using testing::ScratchFolder;
using testing::text_of;

MatchSettings few_keypoints() {
  MatchSettings settings;
  settings.detector = "uniform";
  settings.options["uniform"]["spacing_pr"] = "6";
  settings.threads = 1;
  return settings;
}

TEST(ContentStore, GivesBackWhatWasPut) {
  const ScratchFolder folder;
  const ContentStore store(folder / "store");
  const Mesh mesh = testing::bumpy_sphere(3, 1);
  const Descriptors descriptors = describe_surface(mesh, 0.1, few_keypoints()).descriptors;
  ASSERT_GT(descriptors.vertices.size(), 10u);
  EXPECT_FALSE(store.descriptors("key"));
  store.put("key", descriptors);
  const auto found = ContentStore(folder / "store").descriptors("key");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->vertices, descriptors.vertices);
  EXPECT_EQ(found->frames, descriptors.frames);
  EXPECT_EQ(found->features, descriptors.features);
  const CorrespondenceSet matches = match_pair(mesh, move_mesh(mesh, random_motion(mesh, 1)), few_keypoints()).matches;
  store.put("matches", StoredMatches{matches, 77});
  ASSERT_TRUE(store.matches("matches"));
  EXPECT_EQ(matches_text(store.matches("matches")->matches), matches_text(matches));
  EXPECT_EQ(store.matches("matches")->source_keypoints, 77);
  EXPECT_FALSE(store.matches("key"));
  EXPECT_FALSE(store.descriptors("matches"));
}

// What the disk or a hand has changed must be made anew, wherever the damage is.
TEST(ContentStore, DamageIsAbsence) {
  const ScratchFolder folder;
  const ContentStore store(folder.path());
  CorrespondenceSet matches;
  matches.source_points = matches.target_points = Points::Ones(3, 3);
  store.put("key", StoredMatches{matches, 3});
  const std::string whole = text_of(folder / "key");
  ASSERT_TRUE(store.matches("key"));
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    put_text(folder / "key", changed);
    EXPECT_FALSE(store.matches("key")) << at;
    put_text(folder / "key", whole.substr(0, at));
    EXPECT_FALSE(store.matches("key")) << at;
  }
}

// Counts that lie under a hash that fits them.
TEST(ContentStore, CountsAreCheckedBeforeTheyAreBelieved) {
  const ScratchFolder folder;
  const ContentStore store(folder.path());
  for (const std::int64_t count : {std::int64_t{-1}, std::int64_t{1} << 40, std::int64_t{0x7fffffffffffffff}}) {
    const std::string content(reinterpret_cast<const char*>(&count), sizeof count);
    put_text(folder / "key", content_hash(content) + content);
    EXPECT_FALSE(store.matches("key"));
    EXPECT_FALSE(store.descriptors("key"));
  }
}

TEST(ContentStore, HasALimit) {
  const ScratchFolder folder;
  CorrespondenceSet matches;
  matches.source_points = matches.target_points = Points::Ones(3, 3);
  const std::string key = content_hash("a"), other_key = content_hash("b");
  ContentStore(folder.path()).put(key, StoredMatches{matches, 3});
  const std::uint64_t bytes = text_of(folder / key).size();
  ContentStore(folder.path(), bytes - 1).put(other_key, StoredMatches{matches, 3});
  EXPECT_EQ(folder.names(), std::vector<std::string>{key}) << "too large, and worth no other";
  const ContentStore store(folder.path(), bytes);
  store.put(other_key, StoredMatches{matches, 3});
  EXPECT_FALSE(store.matches(key));
  EXPECT_TRUE(store.matches(other_key));
}

TEST(ContentHash, IsThePublishedFunction) {
  EXPECT_EQ(content_hash(""), "99aa06d3014798d86001c324468d497f");  // XXH3, 128 bits
  EXPECT_NE(content_hash("a"), content_hash("b"));
}

}  // namespace
}  // namespace corral
