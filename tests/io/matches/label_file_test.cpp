// SPDX-License-Identifier: MIT
#include "io/matches/label_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kernel/error.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Selection : public ::testing::Test {
 protected:
  Indices read(const std::string& content, int rows, const std::string& name = "labels.txt") const {
    return read_selection(put_text(folder_ / name, content), rows);
  }
  std::string refusal(const std::string& content, int rows) const {
    try {
      read(content, rows);
    } catch (const IoError& error) {
      return error.what();
    }
    return "accepted";
  }
  const ScratchFolder folder_;
};

/// An array of numpy, version 1: the type, and as many items as the bytes hold.
std::string npy(const std::string& type, int items, const std::string& bytes) {
  std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': (" + std::to_string(items) + ",), }";
  header.resize(117, ' ');
  return std::string("\x93NUMPY\x01\x00\x76\x00", 10) + header + "\n" + bytes;
}

TEST_F(Selection, IsALabelForEachRowOrTheRows) {
  EXPECT_THAT(read("0\n1\n1\n0\n", 4), ElementsAre(1, 2));
  EXPECT_THAT(read("0 1 1 0\n", 4), ElementsAre(1, 2));
  EXPECT_THAT(read("3\n1\n", 4), ElementsAre(1, 3)) << "rows in any order";
  EXPECT_THAT(read("0,0,0,0\n", 4), IsEmpty());
  EXPECT_THAT(read(npy("|b1", 4, std::string("\x00\x01\x01\x00", 4)), 4, "mask.npy"), ElementsAre(1, 2));
  EXPECT_THAT(read(npy("|u1", 2, "\x03\x01"), 4, "rows.npy"), ElementsAre(1, 3));
}

TEST_F(Selection, IsAGroupFile) {
  EXPECT_THAT(read("row,selected,score\n0,1,\n1,0,\n2,1,\n", 3), ElementsAre(0, 2));
  EXPECT_THAT(refusal("row,selected,score\n0,1,\n1,0,\n", 3), HasSubstr("has 2 rows, expected 3"));
}

TEST_F(Selection, OfAnotherTableIsRefusedWithTheLine) {
  EXPECT_THAT(refusal("0\n1\n0\n1\n", 5), HasSubstr("line 3: expected a label 0 or 1 for each of 5 matches, or the "
                                                    "numbers of rows (0 .. 4), each once; found 4 numbers"));
  EXPECT_THAT(refusal("2\n5\n", 5), HasSubstr("line 2"));
  EXPECT_THAT(refusal("2\n-1\n", 5), HasSubstr("line 2"));
  EXPECT_THAT(refusal("2\n1.5\n", 5), HasSubstr("line 2"));
  EXPECT_THAT(refusal("2\nnan\n", 5), HasSubstr("line 2"));
  EXPECT_THAT(refusal("", 5), HasSubstr("the file is empty"));
}

}  // namespace
}  // namespace corral
