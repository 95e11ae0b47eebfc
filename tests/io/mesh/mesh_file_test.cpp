// SPDX-License-Identifier: MIT
#include "io/mesh/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/io/mesh/square_mesh.h"
#include "tests/io/scratch.h"
#include "tests/support/meshes.h"

namespace corral {
namespace {

using ::testing::AllOf;
using testing::complaint;
using testing::expect_square;
using ::testing::HasSubstr;
using testing::io_error_of;
using testing::put_text;
using testing::replaced;
using testing::ScratchFolder;
using ::testing::StartsWith;

const std::string kSquareOff = "OFF\n4 2 5\n0 0 0.5\n1 0 0.5\n1 1 0.5\n0 1 0.5\n3 0 1 2\n3 0 2 3\n";
const std::string kSquareObj = "v 0 0 0.5\nv 1 0 0.5\nv 1 1 0.5\nv 0 1 0.5\nf 1 2 3\nf 1 3 4\n";

/// What a parser says after the name of the file; empty if it accepts the content.
template <class Parser>
std::string refusal(Parser parser, const std::string& content) {
  const std::string path = "folder/mesh";
  return complaint(path, [&] { parser(path, content); });
}
std::string off_refusal(const std::string& content) { return refusal(parse_off, content); }
std::string obj_refusal(const std::string& content) { return refusal(parse_obj, content); }

TEST(MeshFile, BinaryPlyReadsBackWhatItWrote) {
  const Mesh mesh = testing::bumpy_sphere(3, 1);
  const std::string text = binary_ply_text(mesh);
  const Mesh read = parse_ply("x.ply", text);
  EXPECT_EQ(read.vertices, mesh.vertices);
  EXPECT_EQ(read.triangles, mesh.triangles);
  EXPECT_EQ(text.size(), text.find("end_header\n") + 11 + 24 * 642 + 13 * 1280);
  const Mesh cloud = parse_ply("x.ply", binary_ply_text({mesh.vertices, Triangles(0, 3)}));
  EXPECT_EQ(cloud.vertices, mesh.vertices);
  EXPECT_EQ(cloud.triangles.rows(), 0);
}

TEST(MeshFile, NormalsAreWrittenAndReadBack) {
  Mesh mesh = testing::bumpy_sphere(2, 1);
  mesh.normals = mesh.vertices.rowwise().normalized();
  for (const std::string& text : {ply_text(mesh), binary_ply_text(mesh)}) {
    const Mesh read = parse_ply("x.ply", text);
    EXPECT_EQ(read.vertices, mesh.vertices);
    EXPECT_EQ(read.normals, mesh.normals);
    EXPECT_EQ(read.triangles, mesh.triangles);
  }
}

TEST(MeshFile, KnowsTheEndingsThatItReads) {
  for (const char* name : {"a.ply", "x/a.OFF", "a.obj", "a.stl", "a.xyz", "a.pts", "a.b.pcd", "a.ply.gz"})
    EXPECT_TRUE(is_mesh_name(name));
  for (const char* name : {"ply", "a.txt", "a.csv", "a.gz", "a.xf", ""}) EXPECT_FALSE(is_mesh_name(name)) << name;
  EXPECT_EQ(mesh_endings(),
            ".ply, .off, .obj, .stl, .pcd, .xyz, .pts, .asc, .txt, .csv or .bin (also with .gz behind)");
}

TEST(MeshFile, ReadsBackWhatItWrote) {
  const ScratchFolder folder;
  Mesh mesh = testing::bumpy_sphere(2, 3);
  mesh.vertices.row(0) << 5e-324, -0.0, 1e300;
  mesh.vertices.row(1) << -1.7976931348623157e308, 0.1, 1.0 / 3;
  for (const bool cloud : {false, true}) {
    if (cloud) mesh.triangles.resize(0, 3);
    const std::string path = folder / "mesh.ply", again = folder / "again.ply";
    write_mesh(path, mesh);
    const Mesh read = read_mesh(path);
    EXPECT_EQ(read.vertices, mesh.vertices);
    EXPECT_EQ(read.triangles, mesh.triangles);
    write_mesh(again, read);
    EXPECT_EQ(testing::text_of(again), testing::text_of(path)) << "the sign of a zero is kept";
  }
}

TEST(MeshFile, TheEndingNamesTheFormat) {
  const ScratchFolder folder;
  for (const char* name : {"a.off", "a.OFF", "b.c.Off"}) expect_square(read_mesh(put_text(folder / name, kSquareOff)));
  for (const char* name : {"a.obj", "a.OBJ"}) expect_square(read_mesh(put_text(folder / name, kSquareObj)));
  for (const char* name : {"a.gltf", "off", "a.off.xz", ".off", "off.gz"})
    EXPECT_EQ(io_error_of([&] { read_mesh(put_text(folder / name, kSquareOff)); }),
              (folder / name) + ": unknown mesh format, expected a name that ends in " + mesh_endings());
}

TEST(MeshFile, NamesWhatIsNotAFileWithAMesh) {
  const ScratchFolder folder;
  for (const char* ending : {".ply", ".off", ".obj", ".stl", ".xyz", ".pcd", ".txt"}) {
    const std::string path = folder / ("mesh" + std::string(ending));
    EXPECT_EQ(io_error_of([&] { read_mesh(path); }), path + ": does not exist");
    EXPECT_EQ(io_error_of([&] { read_mesh(put_text(path, "")); }), path + ": the file is empty, expected a mesh");
    for (const char* blank : {"\n", " ", "\n\n \r\n"})
      EXPECT_THAT(io_error_of([&] { read_mesh(put_text(path, blank)); }),
                  AllOf(StartsWith(path), HasSubstr("expected")));
    std::filesystem::remove(path);
    std::filesystem::create_directory(path);
    EXPECT_EQ(io_error_of([&] { read_mesh(path); }), path + ": is a directory, expected a file");
  }
}

// A name that no reader would take must not get what no reader would find there.
TEST(MeshFile, WritesOnlyPly) {
  const ScratchFolder folder;
  EXPECT_THAT(io_error_of([&] { write_mesh(folder / "mesh.off", testing::icosphere(0)); }), HasSubstr(".ply"));
  EXPECT_TRUE(folder.names().empty());
}

TEST(MeshFile, WritesWholeOrNotAtAll) {
  const ScratchFolder folder;
  EXPECT_THAT(io_error_of([&] { write_mesh(folder / "nowhere/mesh.ply", testing::icosphere(0)); }),
              HasSubstr("nowhere/mesh.ply"));
  EXPECT_TRUE(folder.names().empty());
}

TEST(OffFile, ReadsPolygonsAsFans) {
  expect_square(parse_off("", kSquareOff));
  expect_square(parse_off("", replaced(replaced(kSquareOff, "4 2 5", "4 1 4"), "3 0 1 2\n3 0 2 3", "4 0 1 2 3")));
}

TEST(OffFile, AcceptsItsVariants) {
  expect_square(parse_off("", replaced(kSquareOff, "\n", "\r\n")));
  expect_square(parse_off("", replaced(kSquareOff, "OFF\n", "OFF ")));
  expect_square(parse_off("", replaced(kSquareOff, "4 2 5", "4 2")));
  expect_square(parse_off("", "# by hand\n" + replaced(kSquareOff, "0 0 0.5", "# first\n\n 0\t0  +0.5 ")));
  expect_square(parse_off("", replaced(replaced(kSquareOff, "OFF", "COFF"), "0.5", "0.5 255 128 0 255")));
  expect_square(parse_off("", replaced(kSquareOff, "3 0 1 2", "3 0 1 2 255 0 0")));
  EXPECT_EQ(parse_off("", "OFF\n0 0 0\n").vertices.rows(), 0);
}

TEST(OffFile, TruncationBeforeTheLastFieldIsAnError) {
  for (const std::string& whole :
       {kSquareOff, replaced(kSquareOff, "OFF\n", "OFF "), replaced(kSquareOff, "\n", "\r\n")})
    for (std::size_t length = 0; length < whole.size(); ++length)
      EXPECT_EQ(off_refusal(whole.substr(0, length)).empty(), length > whole.rfind(' ') + 1)
          << "cut at byte " << length;
}

TEST(OffFile, NamesTheLineOfAWrongHeader) {
  EXPECT_THAT(off_refusal("off\n"), HasSubstr("line 1: found 'off', expected the keyword OFF"));
  EXPECT_THAT(off_refusal("4 2 5\n"), HasSubstr("line 1: found '4'"));
  EXPECT_THAT(off_refusal("OFF BINARY\n"), HasSubstr("line 1: binary OFF is not supported"));
  EXPECT_THAT(off_refusal("OFF\n"), HasSubstr("line 2: the file ends here, expected the numbers of vertices"));
  for (const char* counts :
       {"4", "4 2 5 6", "-1 0 0", "4 -2 5", "4.0 2 5", "x 2 5", "4 2 x", "2147483648 0 0", "nan 2 5"})
    EXPECT_THAT(off_refusal(replaced(kSquareOff, "4 2 5", counts)), HasSubstr("line 2: ")) << counts;
}

TEST(OffFile, AFaceHasThreeCorners) {
  for (const char* face : {"0", "1 0", "2 0 1"})
    EXPECT_THAT(off_refusal("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n" + std::string(face) + "\n"),
                HasSubstr("line 6: the size of a face is '"))
        << face;
}

TEST(OffFile, AHeaderThatPromisesMoreFailsAtOnce) {
  for (const char* counts : {"5 2 0", "4 3 0", "2000000000 2 0", "4 2000000000 0", "2147483647 2147483647 0"})
    EXPECT_NE(off_refusal(replaced(kSquareOff, "4 2 5", counts)), "") << counts;
  EXPECT_THAT(off_refusal(replaced(kSquareOff, "4 2 5", "2000000000 2 0")),
              HasSubstr("line 2: the header promises 2000000000 vertices and 2 faces, but only"));
  EXPECT_THAT(off_refusal(replaced(kSquareOff, "4 2 5", "3 2 5")), HasSubstr("line "));
}

TEST(OffFile, NamesTheLineOfAWrongVertexOrFace) {
  for (const char* bad : {"inf", "-inf", "1e999", "x", "0,5"})
    EXPECT_THAT(off_refusal(replaced(kSquareOff, "1 1 0.5", "1 1 " + std::string(bad))),
                AllOf(HasSubstr("line 5: found '" + std::string(bad)), HasSubstr("number")));
  EXPECT_THAT(off_refusal(replaced(kSquareOff, "1 1 0.5", "1 1")), HasSubstr("line 5: found 2 fields, expected three"));
  for (const char* bad : {"4", "-1", "1.0", "x", "2147483648"})
    EXPECT_THAT(off_refusal(replaced(kSquareOff, "3 0 2 3", "3 0 2 " + std::string(bad))),
                HasSubstr("line 8: a corner is '" + std::string(bad) + "', expected a whole number in 0 .. 3"));
  EXPECT_THAT(off_refusal(replaced(kSquareOff, "3 0 2 3", "4 0 2 3")),
              HasSubstr("line 8: found 3 corners, expected 4"));
  for (const char* bad : {"-3", "3.0", "2147483647", "99999999999999999999"})
    EXPECT_THAT(off_refusal(replaced(kSquareOff, "3 0 2 3", std::string(bad) + " 0 2 3")), HasSubstr("line 8: "))
        << bad;
}

TEST(ObjFile, ReadsPolygonsSlashesAndRelativeCorners) {
  expect_square(parse_obj("", kSquareObj));
  expect_square(parse_obj("", replaced(kSquareObj, "f 1 2 3\nf 1 3 4", "f 1 2 3 4")));
  expect_square(parse_obj("", replaced(kSquareObj, "f 1 2 3\nf 1 3 4", "f 1/7 2/8/9 3//9 4")));
  expect_square(parse_obj("", replaced(kSquareObj, "f 1 2 3\nf 1 3 4", "f -4 -3 -2 -1")));
  expect_square(parse_obj("", replaced(kSquareObj, "\n", "\r\n")));
  expect_square(
      parse_obj("", "# by hand\nmtllib a.mtl\no square\n" + replaced(kSquareObj, "0.5", "0.5 1 1 1") + "g end\n"));
}

// The format has no counts: a cut at the end of a line leaves a smaller, valid mesh as soon as there is a vertex.
TEST(ObjFile, TruncationAtEveryOtherByteIsAnError) {
  for (std::size_t length = 0; length < kSquareObj.size(); ++length) {
    const bool between_lines = length > 0 && kSquareObj[length - 1] == '\n';
    EXPECT_EQ(obj_refusal(kSquareObj.substr(0, length)).empty(), between_lines) << "cut at byte " << length;
  }
}

TEST(ObjFile, NamesTheLineOfAWrongVertexOrFace) {
  for (const char* bad : {"inf", "-inf", "1e999", "x"})
    EXPECT_THAT(obj_refusal(replaced(kSquareObj, "v 1 1 0.5", "v 1 1 " + std::string(bad))),
                AllOf(HasSubstr("line 3: found '" + std::string(bad)), HasSubstr("number")));
  EXPECT_THAT(obj_refusal(replaced(kSquareObj, "v 1 1 0.5", "v 1 1")), HasSubstr("line 3: found 2 fields"));
  for (const char* bad : {"0", "5", "-5", "-0", "1.0", "x", "/1", "99999999999999999999"})
    EXPECT_THAT(obj_refusal(replaced(kSquareObj, "f 1 3 4", "f 1 3 " + std::string(bad))),
                HasSubstr("line 6: a corner is '"));
  EXPECT_THAT(obj_refusal(replaced(kSquareObj, "f 1 3 4", "f 1 3")), HasSubstr("line 6: found 2 corners"));
  EXPECT_THAT(obj_refusal("# nothing\n"), HasSubstr("no vertex line"));
}

TEST(ObjFile, AFaceNamesVerticesThatAreThere) {
  for (const char* face : {"f 1 1 1\n", "f -1 -1 -1\n", "f 0 0 0\n", "f -0 -0 -0\n"})
    EXPECT_THAT(obj_refusal(face + kSquareObj), HasSubstr("line 1: a corner is '")) << face;
}

}  // namespace
}  // namespace corral
