// SPDX-License-Identifier: MIT
#include "io/array/npy_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include "kernel/error.h"
#include "tests/io/array/npy_encoder.h"

namespace corral {
namespace {

using namespace corral::testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string complaint(const std::string& content, const std::string& name = "") {
  try {
    name.empty() ? parse_npy("a.npy", content) : parse_npz("a.npz", content, name);
  } catch (const IoError& error) {
    return error.what();
  }
  return "nothing";
}

std::string deflated(const std::string& content) {
  z_stream stream = {};
  deflateInit2(&stream, 9, Z_DEFLATED, -15, 9, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&stream, content.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

const std::vector<double> kSix = {1, 2, 3, 4, 5, 6};
Eigen::MatrixXd six() {
  Eigen::MatrixXd rows(3, 2);  // a column for each of two rows
  rows << 1, 4, 2, 5, 3, 6;
  return rows;
}

TEST(NpyFile, EveryTypeOrderAndVersionGivesTheSameTable) {
  const std::vector<std::pair<std::string, std::string>> stored = {
      {"<f8", raw<double>(kSix)},        {"<f4", raw<float>(kSix)},         {"<i8", raw<std::int64_t>(kSix)},
      {"<i4", raw<std::int32_t>(kSix)},  {"<i2", raw<std::int16_t>(kSix)},  {"|i1", raw<std::int8_t>(kSix)},
      {"|u1", raw<std::uint8_t>(kSix)},  {"<u2", raw<std::uint16_t>(kSix)}, {"<u4", raw<std::uint32_t>(kSix)},
      {"<u8", raw<std::uint64_t>(kSix)},
  };
  for (const auto& [type, body] : stored)
    for (const int version : {1, 2, 3}) {
      const StoredArray array = parse_npy("a.npy", npy_of(npy_header(type, "(2, 3)"), body, version));
      EXPECT_EQ(array.rows, six()) << type << " " << version;
      EXPECT_THAT(array.shape, ElementsAre(2, 3));
    }
  const std::string turned = npy_of(npy_header("<f8", "(2, 3)", true), raw<double>({1, 4, 2, 5, 3, 6}));
  EXPECT_EQ(parse_npy("a.npy", turned).rows, six());
  std::string big = raw<float>(kSix);
  for (std::size_t i = 0; i < big.size(); i += 4) std::reverse(big.begin() + long(i), big.begin() + long(i) + 4);
  EXPECT_EQ(parse_npy("a.npy", npy_of(npy_header(">f4", "(2, 3)"), big)).rows, six());
}

TEST(NpyFile, ListsNumbersAndLeadingAxes) {
  EXPECT_EQ(parse_npy("a.npy", npy_of(npy_header("|b1", "(3,)"), std::string("\1\0\1", 3))).rows,
            Eigen::RowVector3d(1, 0, 1));
  EXPECT_EQ(parse_npy("a.npy", npy("()", {7})).rows, Eigen::MatrixXd::Constant(1, 1, 7));
  EXPECT_EQ(parse_npy("a.npy", npy("(1, 2, 3)", kSix)).rows, six());
  EXPECT_THAT(complaint(npy("(2, 1, 3)", kSix)), HasSubstr("2 x 1 x 3, expected a list or a table"));
}

TEST(NpyFile, HostileHeadersAreRefusedBeforeAnythingIsAllocated) {
  EXPECT_THAT(complaint("\x93NUMPX"), HasSubstr("byte 0"));
  EXPECT_THAT(complaint("\x93NUMPY\1"), HasSubstr("the file ends here"));
  EXPECT_THAT(complaint(npy_of("", "")), HasSubstr("the file ends here"));
  EXPECT_THAT(complaint(npy_of(npy_header("<f8", "(1,)"), "", 4)), HasSubstr("the version is 4"));
  EXPECT_THAT(complaint(npy("(2000000000, 2000000000)", kSix)), HasSubstr("room for 6 numbers"));
  EXPECT_THAT(complaint(npy("(99999999999, 3)", kSix)), HasSubstr("more than can be counted"));
  EXPECT_THAT(complaint(npy("(99999999999999999999999,)", kSix)), HasSubstr("a length of the shape"));
  EXPECT_THAT(complaint(npy("(2, 2)", kSix)), HasSubstr("more bytes follow"));
  EXPECT_THAT(complaint(npy("(-2, 3)", kSix)), HasSubstr("a length of the shape"));
  EXPECT_THAT(complaint(npy_of(npy_header("<f2", "(1,)"), "ab")), HasSubstr("of type '<f2'"));
  EXPECT_THAT(complaint(npy_of(npy_header("|O", "(1,)"), "ab")), HasSubstr("of type '|O'"));
  EXPECT_THAT(complaint(npy_of("{'descr': [('x', '<f4')], 'shape': (1,)}", "")), HasSubstr("named fields"));
  EXPECT_THAT(complaint(npy_of("{'descr': '<f8'}", "")), HasSubstr("expected descr, fortran_order and shape"));
  std::string cut = npy("(2, 3)", kSix);
  for (std::size_t length = 0; length < cut.size(); ++length)
    EXPECT_NE(complaint(cut.substr(0, length)), "nothing") << length;
}

TEST(NpzFile, StoredAndDeflatedMembers) {
  const std::string array = npy("(2, 3)", kSix), large = npy("(1000,)", std::vector<double>(1000, 2.5));
  const std::string content = zip({{"a.npy", array}, {"b.npy", large, deflated(large)}, {"note.txt", "hello"}});
  EXPECT_THAT(npz_names("a.npz", content), ElementsAre("a", "b"));
  EXPECT_EQ(parse_npz("a.npz", content, "a").rows, six());
  EXPECT_EQ(parse_npz("a.npz", content, "b").rows, Eigen::RowVectorXd::Constant(1000, 2.5));
  EXPECT_THAT(complaint(content, "c"), HasSubstr("has no array c, expected one of 'a', 'b'"));
}

/// An archive whose sizes and offsets all stand where those of 64 bits do, behind a field that means something else.
std::string large_archive(const std::string& name, const std::string& content) {
  const std::string none = little(0xFFFFFFFF, 4),
                    common = little(0, 2) + little(0, 4) + little(checksum_of(content), 4);
  const std::string header =
      "PK\3\4" + little(45, 2) + little(0, 2) + common + none + none + little(name.size(), 2) + little(0, 2) + name;
  const std::string sizes = little(0x5455, 2) + little(3, 2) + "abc" + little(1, 2) + little(24, 2) +
                            little(content.size(), 8) + little(content.size(), 8) + little(0, 8);
  const std::string list = "PK\1\2" + little(45, 2) + little(45, 2) + little(0, 2) + common + none + none +
                           little(name.size(), 2) + little(sizes.size(), 2) + little(0, 8) + little(0, 2) + none +
                           name + sizes;
  const std::size_t listed_at = header.size() + content.size(), end = listed_at + list.size();
  const std::string record = "PK\6\6" + little(44, 8) + little(45, 2) + little(45, 2) + little(0, 8) + little(1, 8) +
                             little(1, 8) + little(list.size(), 8) + little(listed_at, 8);
  return header + content + list + record + "PK\6\7" + little(0, 4) + little(end, 8) + little(1, 4) + "PK\5\6" +
         little(0, 4) + little(0xFFFF, 2) + little(0xFFFF, 2) + none + none + little(0, 2);
}

TEST(NpzFile, SizesOf64Bits) {
  const std::string content = large_archive("a.npy", npy("(2, 3)", kSix));
  EXPECT_THAT(npz_names("a.npz", content), ElementsAre("a"));
  EXPECT_EQ(parse_npz("a.npz", content, "a").rows, six());
  for (std::size_t length = 0; length < content.size(); ++length)
    EXPECT_NE(complaint(content.substr(0, length), "a"), "nothing") << length;
  for (const std::uint64_t far : {std::uint64_t{content.size()}, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
    std::string record = content, member = content;
    record.replace(content.rfind("PK\6\7") + 8, 8, little(far, 8));
    EXPECT_THAT(complaint(record, "a"), HasSubstr("too short for the end of a large archive"));
    member.replace(content.rfind("PK\6\6") - 8, 8, little(far, 8));
    EXPECT_THAT(complaint(member, "a"), HasSubstr("too short for a member of the archive"));
  }
}

TEST(NpzFile, DamagedAndHostileArchivesAreRefused) {
  const std::string array = npy("(2, 3)", kSix);
  const std::string good = zip({{"a.npy", array}});
  for (std::size_t length = 0; length < good.size(); ++length)
    EXPECT_NE(complaint(good.substr(0, length), "a"), "nothing") << length;
  std::string damaged = good;
  damaged[30 + 5 + array.size() - 1] ^= 1;
  EXPECT_THAT(complaint(damaged, "a"), HasSubstr("checksum"));
  // A member that promises a gigabyte from a few bytes.
  std::string bomb = zip({{"a.npy", array, deflated(array)}});
  const std::size_t list = bomb.rfind("PK\1\2");
  bomb.replace(list + 24, 4, little(1u << 30, 4));
  EXPECT_THAT(complaint(bomb, "a"), HasSubstr("promises 1073741824 bytes"));
  std::string longer = zip({{"a.npy", array, deflated(array)}});
  longer.replace(longer.rfind("PK\1\2") + 24, 4, little(array.size() + 8, 4));
  EXPECT_THAT(complaint(longer, "a"), HasSubstr("damaged"));
  std::string method = good;
  method[method.rfind("PK\1\2") + 10] = 12;
  EXPECT_THAT(complaint(method, "a"), HasSubstr("method 12"));
  std::string encrypted = good, sizes = good;
  encrypted[encrypted.rfind("PK\1\2") + 8] = 1;
  EXPECT_THAT(complaint(encrypted, "a"), HasSubstr("is encrypted"));
  sizes.replace(sizes.rfind("PK\1\2") + 24, 4, little(array.size() - 1, 4));
  EXPECT_THAT(complaint(sizes, "a"), HasSubstr("its two sizes differ"));
}

}  // namespace
}  // namespace corral
