// SPDX-License-Identifier: MIT
// The seeds of the fuzzers, and what they once found: every target on each of its files, cut short and with a byte changed.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "kernel/error.h"
#include "tests/fuzz/target.h"

namespace corral {
namespace {

namespace fs = std::filesystem;

void feed(const fuzz::Target& target, const std::string& bytes) {
  try {
    target.run(bytes);
  } catch (const IoError&) {
  } catch (const InvalidInput&) {
  }
}

std::string read(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

void feed_seeds(const std::vector<fuzz::Target>& targets) {
  for (const fuzz::Target& target : targets) {
    const fs::path folder = fs::path(CORRAL_SEEDS) / target.name;
    ASSERT_TRUE(fs::is_directory(folder)) << folder << " has no seeds";
    feed(target, "");
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string bytes = read(entry.path());
      EXPECT_NO_THROW(feed(target, bytes)) << entry.path();
      for (std::size_t at = 0; at < bytes.size(); at += 1 + bytes.size() / 16) {
        EXPECT_NO_THROW(feed(target, bytes.substr(0, at))) << entry.path() << " up to " << at;
        std::string changed = bytes;
        changed[at] = static_cast<char>(changed[at] + 1);
        EXPECT_NO_THROW(feed(target, changed)) << entry.path() << " changed at " << at;
      }
    }
  }
}

TEST(Seeds, OfFiles) { feed_seeds(fuzz::file_targets()); }
TEST(Seeds, OfStudies) { feed_seeds(fuzz::study_targets()); }
TEST(Seeds, OfGroupers) { feed_seeds(fuzz::grouper_targets()); }
TEST(Seeds, OfSurfaces) { feed_seeds(fuzz::surface_targets()); }
TEST(Seeds, OfViews) { feed_seeds(fuzz::view_targets()); }

}  // namespace
}  // namespace corral
