// SPDX-License-Identifier: MIT
#include "io/pairs/dataset_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kernel/error.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::put_text;
using testing::ScratchFolder;

constexpr char kPairs[] = "pair,source,target,truth\nx,a.ply,b.ply,\n";

std::string complaint_of(const std::string& toml, const std::string& pairs) {
  const ScratchFolder folder;
  put_text(folder / "dataset.toml", toml);
  put_text(folder / "pairs.csv", pairs);
  try {
    read_dataset(folder / "");
  } catch (const IoError& error) {
    return error.what();
  }
  return "";
}

TEST(DatasetFile, ReadsBackWhatItWrote) {
  const ScratchFolder folder;
  Dataset dataset{folder / "",
                  "u3or",
                  "recognition",
                  "mm",
                  "source",
                  "scans \"here\"",
                  "research",
                  {"One, 2006", "Two, 2010"},
                  {"clutter", "model"},
                  {{"chef-rs1", "models/chef.ply", "scenes/rs1.ply", "gt/chef-rs1.xf", {"0.7", "chef, the"}},
                   {"chef-rs2", "models/chef.ply", "scenes/rs2.ply", "", {"", "chef"}}}};
  put_text(folder / "dataset.toml", dataset_toml_text(dataset));
  put_text(folder / "pairs.csv", pairs_csv_text(dataset));
  const Dataset read = read_dataset(dataset.folder);
  EXPECT_EQ(dataset_toml_text(read), dataset_toml_text(dataset));
  EXPECT_EQ(pairs_csv_text(read), pairs_csv_text(dataset));
  EXPECT_EQ(read.kind, "recognition");
  EXPECT_THAT(read.citation, ElementsAre("One, 2006", "Two, 2010"));
  EXPECT_EQ(attribute_number(read, read.pairs[0], "clutter"), 0.7);
  EXPECT_FALSE(attribute_number(read, read.pairs[1], "clutter"));
  EXPECT_FALSE(attribute_number(read, read.pairs[1], "nothing"));
  EXPECT_EQ(attribute_text(read, read.pairs[0], "model"), "chef, the");
  EXPECT_THROW(attribute_number(read, read.pairs[0], "model"), IoError);
  EXPECT_EQ(read.path("gt/../x.ply"), folder / "x.ply");
  EXPECT_EQ(read.path("/x.ply"), "/x.ply");
}

TEST(DatasetFile, TenLinesAreEnough) { EXPECT_EQ(complaint_of("name = \"mine\"\n", kPairs), ""); }

TEST(DatasetFile, TellsAHalfMadeSetFromNone) {
  const ScratchFolder folder;
  const auto complaint = [&] { return testing::io_error_of([&] { read_dataset(folder.path()); }); };
  EXPECT_THAT(complaint(), HasSubstr("dataset.toml: does not exist"));
  put_text(folder / kRecipeName, "made so\n");
  EXPECT_THAT(complaint(), HasSubstr(folder.path() + ": is unfinished"));
  put_text(folder / "dataset.toml", "name = \"x\"\n");
  put_text(folder / "pairs.csv", kPairs);
  EXPECT_EQ(complaint(), "");
}

TEST(DatasetFile, NamesWhatIsWrong) {
  EXPECT_THAT(complaint_of("", kPairs), HasSubstr("name"));
  EXPECT_THAT(complaint_of("name = \"a b\"\n", kPairs), HasSubstr("letters"));
  EXPECT_THAT(complaint_of("name = \"x\"\nkinds = \"pairs\"\n", kPairs), HasSubstr("did you mean 'kind'"));
  EXPECT_THAT(complaint_of("name = \"x\"\nkind = \"other\"\n", kPairs), HasSubstr("retrieval"));
  EXPECT_THAT(complaint_of("name = \"x\"\nresolution = -1\n", kPairs), HasSubstr("above zero"));
  EXPECT_THAT(complaint_of("name = \"x\"\n", "pair,source,target\nx,a,b\n"), HasSubstr("truth is missing"));
  EXPECT_THAT(complaint_of("name = \"x\"\n", "pair,source,target,truth\n"), HasSubstr("no pairs"));
  EXPECT_THAT(complaint_of("name = \"x\"\n", "pair,source,target,truth\nx,a,b,\nx,a,c,\n"), HasSubstr("twice"));
  EXPECT_THAT(complaint_of("name = \"x\"\n", "pair,source,target,truth\nx/y,a,b,\n"), HasSubstr("letters"));
  EXPECT_THAT(complaint_of("name = \"x\"\n", "pair,source,target,truth\nx,a,,\n"), HasSubstr("without source"));
}

}  // namespace
}  // namespace corral
