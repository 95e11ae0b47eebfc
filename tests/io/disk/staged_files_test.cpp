// SPDX-License-Identifier: MIT
#include "io/disk/staged_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/io/scratch.h"

namespace corral {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::io_error_of;
using testing::put_text;
using testing::ScratchFolder;
using testing::text_of;

int entries_of(const ScratchFolder& folder) {
  return static_cast<int>(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()));
}

TEST(StagedFiles, TakeTheirPlacesTogether) {
  const ScratchFolder folder;
  const std::string a = put_text(folder / "a", "old"), b = folder / "b";
  StagedFiles files;
  files.begin(a);
  files.write("one ");
  files.write("two");
  files.begin(b);
  files.write("three");
  EXPECT_EQ(text_of(a), "old");
  EXPECT_FALSE(fs::exists(b));
  files.commit();
  EXPECT_EQ(text_of(a), "one two");
  EXPECT_EQ(text_of(b), "three");
  EXPECT_EQ(entries_of(folder), 2);
}

TEST(StagedFiles, LeaveWhatWasThereWhereTheyAreGivenUp) {
  const ScratchFolder folder;
  const std::string path = put_text(folder / "a", "old");
  {
    StagedFiles files;
    files.begin(path);
    files.write("new");
  }
  EXPECT_EQ(text_of(path), "old");
  EXPECT_EQ(entries_of(folder), 1);
  StagedFiles twice;
  twice.begin(path);
  twice.begin(folder / "." + "/a");
  EXPECT_THAT(io_error_of([&] { twice.commit(); }), HasSubstr("two outputs"));
  EXPECT_EQ(text_of(path), "old");
}

TEST(StagedFiles, LeftoversOfOneFileAreRemoved) {
  const ScratchFolder folder;
  const std::string path = put_text(folder / "records.csv", "whole");
  put_text(folder / "records.csv.part-a1B2c3", "half");
  put_text(folder / "records.csv.part-a1B2c3d", "no name of ours");
  put_text(folder / "other.csv.part-a1B2c3", "of another file");
  remove_leftovers_of(path);
  EXPECT_EQ(entries_of(folder), 3);
  EXPECT_FALSE(fs::exists(folder / "records.csv.part-a1B2c3"));
  EXPECT_EQ(text_of(path), "whole");
}

}  // namespace
}  // namespace corral
