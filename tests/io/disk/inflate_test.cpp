// SPDX-License-Identifier: MIT
#include "io/disk/inflate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdint>
#include <string>

#include "io/mesh/mesh_file.h"
#include "tests/io/disk/gzip.h"
#include "tests/io/mesh/square_mesh.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

using testing::complaint;
using testing::gzipped;
using ::testing::HasSubstr;

const std::string kSquareOff = "OFF\n4 2 5\n0 0 0.5\n1 0 0.5\n1 1 0.5\n0 1 0.5\n3 0 1 2\n3 0 2 3\n";

std::string refusal(const std::string& content) {
  return complaint("mesh.ply.gz", [&] { inflated("mesh.ply.gz", content); });
}

TEST(Inflate, GivesBackWhatWasCompressed) {
  std::string text;
  for (std::int64_t i = 0; i < 100000; ++i) text += std::to_string(i * i % 977) + "\n";
  for (const std::string& content : {std::string("a"), text, std::string(5000000, 'x')}) {
    EXPECT_EQ(inflated("", gzipped(content)), content);
    EXPECT_EQ(inflated("", gzipped(content) + gzipped("more")), content + "more") << "members follow each other";
    EXPECT_EQ(inflated("", gzipped(content) + std::string(100, '\0')), content) << "tapes are filled with zeros";
  }
  EXPECT_EQ(inflated("", gzipped("")), "");
}

TEST(Inflate, NamesWhatIsDamaged) {
  const std::string whole = gzipped(kSquareOff);
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_THAT(refusal(whole.substr(0, length)),
                HasSubstr(", byte " + std::to_string(length) + ": the file ends here"));
  EXPECT_THAT(refusal(kSquareOff), HasSubstr("not gzip data"));
  EXPECT_THAT(refusal(whole + "x"), HasSubstr("the file ends here"));
  EXPECT_THAT(refusal(whole + kSquareOff), HasSubstr("not gzip data"));
  std::string bad = whole;
  bad[bad.size() - 6] ^= 1;
  EXPECT_THAT(refusal(bad), HasSubstr("(incorrect data check)"));
}

TEST(Inflate, RefusesWhatGrowsBeyondAnyMesh) {
  const std::string bomb = gzipped(std::string(std::size_t{66} << 20, ' '));
  EXPECT_THAT(refusal(bomb), HasSubstr("more than 67108864 bytes come out of " + std::to_string(bomb.size())));
}

TEST(Inflate, EveryFormatMayBeCompressed) {
  const testing::ScratchFolder folder;
  testing::expect_square(read_mesh(testing::put_text(folder / "a.off.gz", gzipped(kSquareOff))));
  testing::expect_square(read_mesh(testing::put_text(folder / "b.OFF.GZ", gzipped(kSquareOff))));
  EXPECT_EQ(read_mesh(testing::put_text(folder / "a.txt.gz", gzipped("1 2 3\n"))).vertices,
            Eigen::RowVector3d(1, 2, 3));
  const std::string path = folder / "a.ply.gz";
  const auto complaint_of = [&](const std::string& content) {
    return complaint(path, [&] { read_mesh(testing::put_text(path, content)); });
  };
  EXPECT_EQ(complaint_of(""), ": the file is empty, expected a mesh");
  EXPECT_EQ(complaint_of(gzipped("")), ": the file is empty, expected a mesh");
  EXPECT_THAT(complaint_of(gzipped("plx\n")), HasSubstr(", line 1: found 'plx', expected the word ply"));
  EXPECT_THAT(testing::io_error_of([&] { read_mesh(testing::put_text(folder / "a.gz", gzipped("1 2 3\n"))); }),
              HasSubstr("unknown mesh format"));
}

}  // namespace
}  // namespace corral
