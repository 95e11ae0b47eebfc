// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "io/mesh/mesh_file.h"
#include "kernel/random.h"
#include "kernel/surface/mesh/topology.h"
#include "tests/io/mesh/ply_encoder.h"
#include "tests/io/mesh/square_mesh.h"
#include "tests/io/scratch.h"
#include "tests/support/meshes.h"

namespace corral {
namespace {

using ::testing::AllOf;
using testing::complaint;
using ::testing::ElementsAre;
using testing::encode;
using ::testing::EndsWith;
using testing::expect_square;
using ::testing::HasSubstr;
using testing::replaced;
using ::testing::StartsWith;

const std::string kPath = "folder/mesh.stl";

using Facet = std::array<double, 9>;
const std::vector<Facet> kSquare = {{0, 0, 0.5, 1, 0, 0.5, 1, 1, 0.5}, {0, 0, 0.5, 1, 1, 0.5, 0, 1, 0.5}};

std::string refusal(const std::string& content) {
  return complaint(kPath, [&] { parse_stl(kPath, content); });
}

/// `promised` stands where the number of facets does.
std::string binary_stl(const std::vector<Facet>& facets, double promised, std::string title = "made by hand") {
  title.resize(80, ' ');
  std::string content = title + encode({'I', promised}, false);
  for (const Facet& facet : facets) {
    for (int axis = 0; axis < 3; ++axis) content += encode({'f', std::nan("")}, false);  // the normal is not read
    for (const double coordinate : facet) content += encode({'f', coordinate}, false);
    content += "\x01\xff";
  }
  return content;
}
std::string binary_stl(const std::vector<Facet>& facets) {
  return binary_stl(facets, static_cast<double>(facets.size()));
}

std::string text_stl(const std::vector<Facet>& facets) {
  std::string content = "solid two words\n";
  for (const Facet& facet : facets) {
    content += "  facet normal 0 0 1\n    outer loop\n";
    for (std::size_t i = 0; i < 9; i += 3)
      content += "      vertex " + to_text(facet[i]) + " " + to_text(facet[i + 1]) + " " + to_text(facet[i + 2]) + "\n";
    content += "    endloop\n  endfacet\n";
  }
  return content + "endsolid two words\n";
}

std::vector<Facet> facets_of(const Mesh& mesh) {
  std::vector<Facet> facets;
  for (Eigen::Index face = 0; face < mesh.triangles.rows(); ++face) {
    Facet facet;
    for (int i = 0; i < 9; ++i) facet[static_cast<std::size_t>(i)] = mesh.vertices(mesh.triangles(face, i / 3), i % 3);
    facets.push_back(facet);
  }
  return facets;
}

TEST(StlFile, EqualCornersAreOneVertex) {
  expect_square(parse_stl(kPath, text_stl(kSquare)));
  expect_square(parse_stl(kPath, binary_stl(kSquare)));
}

TEST(StlFile, TheEndingNamesTheFormat) {
  const testing::ScratchFolder folder;
  expect_square(read_mesh(testing::put_text(folder / "a.stl", text_stl(kSquare))));
  expect_square(read_mesh(testing::put_text(folder / "b.STL", binary_stl(kSquare))));
}

TEST(StlFile, ASurfaceKeepsItsConnectivity) {
  const Mesh mesh = testing::bumpy_sphere(3, 3);
  for (const bool binary : {false, true}) {
    const Mesh read = parse_stl(kPath, binary ? binary_stl(facets_of(mesh)) : text_stl(facets_of(mesh)));
    ASSERT_EQ(read.vertices.rows(), mesh.vertices.rows());
    ASSERT_EQ(read.triangles.rows(), mesh.triangles.rows());
    const Topology topology = inspect_topology(read);
    EXPECT_EQ(topology.components, 1);
    EXPECT_EQ(topology.boundary_edges, 0);
    const std::vector<Facet> wanted = facets_of(mesh), found = facets_of(read);
    int highest = -1;
    for (std::size_t face = 0; face < wanted.size(); ++face) {
      for (std::size_t i = 0; i < 9; ++i)
        EXPECT_EQ(found[face][i], binary ? static_cast<float>(wanted[face][i]) : wanted[face][i]);
      for (int corner = 0; corner < 3; ++corner) {
        const int vertex = read.triangles(static_cast<Eigen::Index>(face), corner);
        EXPECT_LE(vertex, highest + 1) << "numbered in order of appearance";
        highest = std::max(highest, vertex);
      }
    }
  }
}

TEST(StlFile, ZerosOfBothSignsAreOnePlace) {
  const std::vector<Facet> facets = {{-0.0, 0, 0, 1, 0, 0, 0, 1, -0.0}, {0, -0.0, 0, 0, 1, 0, -1, 0, 0}};
  for (const std::string& content : {text_stl(facets), binary_stl(facets)}) {
    const Mesh mesh = parse_stl(kPath, content);
    ASSERT_EQ(mesh.vertices.rows(), 4);
    EXPECT_FALSE(std::signbit(mesh.vertices(0, 0)));
    EXPECT_FALSE(std::signbit(mesh.vertices(2, 2)));
  }
}

TEST(StlFile, FacetsThatRepeatACornerStay) {
  const std::vector<Facet> facets = {kSquare[0], {1, 0, 0.5, 1, 0, 0.5, 1, 1, 0.5}};
  for (const std::string& content : {text_stl(facets), binary_stl(facets)}) {
    const Mesh mesh = parse_stl(kPath, content);
    EXPECT_EQ(mesh.vertices.rows(), 3);
    EXPECT_EQ(mesh.triangles.row(1), Eigen::RowVector3i(1, 1, 2));
    EXPECT_EQ(inspect_topology(mesh).degenerate_faces, 1);
  }
}

TEST(StlFile, AcceptsItsVariants) {
  const std::string text = text_stl(kSquare);
  expect_square(parse_stl(kPath, replaced(text, "\n", "\r\n")));
  expect_square(parse_stl(kPath, replaced(text, " two words", "")));
  expect_square(parse_stl(kPath, replaced(text, "normal 0 0 1", "normal -1.#IND nan x")));
  std::string loud = text;
  for (char& letter : loud) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  expect_square(parse_stl(kPath, loud));
  const std::string two = text_stl({kSquare[0]}) + "\n" + text_stl({kSquare[1]});
  expect_square(parse_stl(kPath, two));
  EXPECT_EQ(parse_stl(kPath, text_stl({})).vertices.rows(), 0);
  EXPECT_EQ(parse_stl(kPath, binary_stl({})).triangles.rows(), 0);
}

// Many writers of binary files begin their title so.
TEST(StlFile, ABinaryFileMayBeginWithTheWordSolid) {
  expect_square(parse_stl(kPath, binary_stl(kSquare, 2, "solid part")));
  expect_square(parse_stl(kPath, binary_stl(kSquare, 2, "solid part\nfacet normal 0 0 1\n")));
  EXPECT_EQ(refusal(binary_stl(kSquare, 3, "solid part")),
            ", byte 80: promises 3 facets, which take 234 bytes with the header, but the file has 184");
}

// A solid is whole behind the word endsolid: neither the name nor the newline must follow.
TEST(StlFile, TextInUtf16IsNotTakenForABinaryFile) {
  const std::string text("\xFF\xFEs\0o\0l\0i\0d\0", 12);
  EXPECT_THAT(refusal(text + std::string(100, '\0')), ::testing::HasSubstr("UTF-16"));
}

TEST(StlFile, TruncationAtEveryByteIsAnError) {
  const std::string text = text_stl(kSquare), crlf = replaced(text, "\n", "\r\n");
  for (const std::string& whole : {binary_stl(kSquare), binary_stl(kSquare, 2, "solid part\n")})
    for (std::size_t length = 0; length < whole.size(); ++length)
      EXPECT_NE(refusal(whole.substr(0, length)), "") << "cut at byte " << length << " of " << whole.size();
  for (const std::string& whole : {text, crlf})
    for (std::size_t length = 0; length < whole.size(); ++length) {
      const std::size_t end = whole.find("endsolid") + 8;
      const bool is_whole = length == end || (length > end && whole[end] != 's');
      EXPECT_EQ(refusal(whole.substr(0, length)).empty(), is_whole)
          << "cut at byte " << length << " of " << whole.size();
    }
  EXPECT_THAT(parse_stl(kPath, text.substr(0, text.size() - 1)).notes, ElementsAre(HasSubstr("lacks its newline")));
}

// Nothing counts the solids: a cut exactly between two of them leaves a whole file.
TEST(StlFile, TruncationBetweenSolidsIsTheOnlyOneThatIsNotSeen) {
  const std::string first = text_stl({kSquare[0]}), whole = first + text_stl({kSquare[1]});
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const bool is_whole =
        (length >= first.find("endsolid") + 8 && length <= first.size()) || length >= whole.rfind("endsolid") + 8;
    EXPECT_EQ(refusal(whole.substr(0, length)).empty(), is_whole) << "cut at byte " << length;
  }
}

TEST(StlFile, ACountThatLiesFailsAtOnce) {
  for (const double count : {3.0, 2147483647.0, 4294967295.0})
    EXPECT_THAT(refusal(binary_stl(kSquare, count)),
                AllOf(StartsWith(", byte 80: promises " + std::to_string(static_cast<long long>(count)) + " facets"),
                      EndsWith("the file has 184")));
  EXPECT_THAT(refusal(binary_stl(kSquare, 4294967295.0)), HasSubstr("take 214748364834 bytes"));
  EXPECT_EQ(refusal(binary_stl(kSquare, 1e9).substr(0, 83) + '\0').substr(0, 19), ", byte 80: promises");
  EXPECT_EQ(refusal(std::string("solid\0", 6)),
            ", byte 6: the file ends here, expected the 84 bytes of a binary header");
}

TEST(StlFile, BytesAfterTheLastFacetAreNoted) {
  const StoredMesh mesh = parse_stl(kPath, binary_stl(kSquare) + std::string(3, '\0'));
  expect_square(mesh);
  EXPECT_THAT(mesh.notes, ElementsAre("3 bytes after the last facet that the file promises were not read"));
  EXPECT_EQ(parse_stl(kPath, binary_stl(kSquare, 1)).triangles.rows(), 1);
}

TEST(StlFile, FacetsWithACornerThatIsMissingAreLeftOut) {
  std::vector<Facet> facets(100, Facet{std::nan(""), 0, 0, 1, 0, 0, 0, 1, 0});
  facets.insert(facets.end(), kSquare.begin(), kSquare.end());
  for (const std::string& content : {text_stl(facets), binary_stl(facets)}) {
    const StoredMesh mesh = parse_stl(kPath, content);
    EXPECT_EQ(mesh.triangles.rows(), 2);
    EXPECT_THAT(mesh.notes, ElementsAre("1 vertex with a nan coordinate and 100 faces that used them were left out"));
  }
}

// More corners than the first table of places has room for, with many equal ones.
TEST(StlFile, ManyCornersAreWeldedAsFewOnes) {
  const Mesh mesh = testing::grid(100, 100, 0.5);
  const Mesh read = parse_stl(kPath, binary_stl(facets_of(mesh)));
  EXPECT_EQ(read.vertices.rows(), 10000);
  EXPECT_EQ(inspect_topology(read).boundary_edges, 4 * 99);
  EXPECT_EQ(inspect_topology(read).duplicate_vertices, 0);
}

/// Single precision, with all that is awkward to compare: both zeros, the smallest numbers, neighbours.
Facet awkward_facet(RandomStream& random) {
  constexpr std::array<float, 8> kCoordinates = {0.0F, -0.0F, 1e-45F, -1e-45F, 1.0F, 1.0000001F, -3e38F, 0.1F};
  Facet facet;
  for (double& coordinate : facet) coordinate = static_cast<double>(kCoordinates[random.below(kCoordinates.size())]);
  return facet;
}

TEST(StlFile, CornersAreNumberedAsTheyFirstAppear) {
  RandomStream random(3);
  for (const int facets : {1, 40, 3000}) {
    std::vector<Facet> file;
    std::map<std::array<double, 3>, int> numbers;  // finds either zero at the place of the other
    std::vector<int> expected;
    for (int i = 0; i < facets; ++i) {
      const Facet& facet = file.emplace_back(awkward_facet(random));
      for (std::size_t corner = 0; corner < 9; corner += 3)
        expected.push_back(
            numbers.try_emplace({facet[corner], facet[corner + 1], facet[corner + 2]}, static_cast<int>(numbers.size()))
                .first->second);
    }
    for (const std::string& content : {text_stl(file), binary_stl(file)}) {
      const Mesh mesh = parse_stl(kPath, content);
      EXPECT_EQ(mesh.vertices.rows(), static_cast<Eigen::Index>(numbers.size()));
      for (std::size_t i = 0; i < expected.size(); ++i)
        ASSERT_EQ(mesh.triangles(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3)), expected[i]);
      for (const auto& [place, number] : numbers)
        EXPECT_TRUE(mesh.vertices.row(number) == Eigen::RowVector3d(place[0], place[1], place[2])) << number;
      for (const double coordinate : mesh.vertices.reshaped())
        EXPECT_FALSE(coordinate == 0 && std::signbit(coordinate)) << "-0 is stored";
    }
  }
}

TEST(StlFile, NamesTheFacetOfACoordinateThatIsNotFinite) {
  for (const double bad : {HUGE_VAL, -HUGE_VAL})
    for (std::size_t i = 0; i < 9; ++i) {
      std::vector<Facet> facets = kSquare;
      facets[1][i] = bad;
      EXPECT_EQ(refusal(binary_stl(facets)), ", byte " + std::to_string(84 + 50 + 12 + 4 * i) + ": found " +
                                                 to_text(bad) + " in facet 1 of 2, expected a finite coordinate");
      EXPECT_EQ(refusal(text_stl(facets)),
                ", line " + std::to_string(11 + i / 3) + ": found '" + to_text(bad) + "', expected a finite number");
    }
}

TEST(StlFile, NamesTheLineOfWhatDoesNotBelongThere) {
  const std::string text = text_stl(kSquare);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    return refusal(changed.replace(changed.find(from), from.size(), to));
  };
  EXPECT_EQ(refusal("OFF\n"), ", line 1: found 'OFF', expected the keyword solid");
  EXPECT_EQ(refusal("solids\n"), ", line 1: found 'solids', expected the keyword solid");
  EXPECT_EQ(refusal("solid\n"), ", line 2: the file ends here, expected facet or endsolid");
  EXPECT_EQ(with("facet normal 0 0 1", "facet normal 0 0"),
            ", line 2: found 'facet normal 0 0', expected 'facet normal NX NY NZ' or endsolid");
  EXPECT_EQ(with("outer loop", "outer"), ", line 3: found 'outer', expected 'outer loop'");
  EXPECT_EQ(with("vertex 0 0 0.5", "vertex 0 0"), ", line 4: found 'vertex 0 0', expected 'vertex X Y Z'");
  EXPECT_EQ(with("vertex 0 0 0.5", "vertex 0 0 0 0"), ", line 4: found 'vertex 0 0 0 0', expected 'vertex X Y Z'");
  EXPECT_EQ(with("vertex 0 0 0.5", "vertex 0 0 x"), ", line 4: found 'x', expected a number");
  EXPECT_EQ(with("vertex 0 0 0.5\n", ""), ", line 6: found 'endloop', expected 'vertex X Y Z'");
  EXPECT_EQ(with("    endloop", "vertex 0 1 0.5"), ", line 7: found 'vertex 0 1 0.5', expected 'endloop'");
  EXPECT_EQ(with("  endfacet\n", ""), ", line 8: found 'facet normal 0 0 1', expected 'endfacet'");
  EXPECT_EQ(with("endsolid", "endsold"),
            ", line 16: found 'endsold two words', expected 'facet normal NX NY NZ' or endsolid");
  EXPECT_EQ(refusal(text + "endsolid\n"), ", line 17: found 'endsolid', expected the keyword solid");
}

}  // namespace
}  // namespace corral
