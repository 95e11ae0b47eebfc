// SPDX-License-Identifier: MIT
// read_benchmark [--csv] [--benchmark_...]
// CPU time of reading one mesh of 250,000 vertices and 498,002 faces in each format, one thread, beside reading the bytes of
// the same file alone. MB divided by the time is the speed.

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstring>
#include <filesystem>

#include "io/disk/file.h"
#include "io/mesh/mesh_file.h"
#include "kernel/number_text.h"
#include "tests/benchmarks/program.h"
#include "tests/benchmarks/ratio_table.h"

namespace corral::benchmarks {
namespace {

constexpr int kSide = 500;

/// A sheet whose coordinates have all digits of single precision.
Mesh sheet() {
  Mesh mesh{Points(kSide * kSide, 3), Triangles(2 * (kSide - 1) * (kSide - 1), 3)};
  Eigen::Index face = 0;
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column) {
      const int a = row * kSide + column;
      const double x = 0.37 * column + 0.01 * std::sin(1.7 * row + column),
                   y = 0.41 * row + 0.013 * std::cos(2.3 * column);
      const double z = 5 * std::sin(0.05 * row) * std::cos(0.04 * column);
      mesh.vertices.row(a) << static_cast<float>(x), static_cast<float>(y), static_cast<float>(z);
      if (row + 1 == kSide || column + 1 == kSide) continue;
      mesh.triangles.row(face++) << a, a + 1, a + kSide + 1;
      mesh.triangles.row(face++) << a, a + kSide + 1, a + kSide;
    }
  return mesh;
}

std::string place_text(const Mesh& mesh, Eigen::Index vertex) {
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    const auto number = static_cast<float>(mesh.vertices(vertex, axis));
    char buffer[32];
    text.append(axis > 0 ? " " : "")
        .append(buffer, static_cast<std::size_t>(std::snprintf(buffer, 32, "%.7g", number)));
  }
  return text;
}

std::string place_bytes(const Mesh& mesh, Eigen::Index vertex) {
  std::string bytes(12, '\0');
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto number = static_cast<float>(mesh.vertices(vertex, static_cast<Eigen::Index>(axis)));
    std::memcpy(&bytes[4 * axis], &number, 4);
  }
  return bytes;
}

std::string vertices_of(const Mesh& mesh, std::string (*place)(const Mesh&, Eigen::Index), const std::string& before,
                        const std::string& behind) {
  std::string text;
  for (Eigen::Index vertex = 0; vertex < mesh.vertices.rows(); ++vertex) text += before + place(mesh, vertex) + behind;
  return text;
}

std::string face_text(const Mesh& mesh, const std::string& before, int base) {
  std::string text;
  for (Eigen::Index face = 0; face < mesh.triangles.rows(); ++face) {
    text += before;
    for (int i = 0; i < 3; ++i) text += " " + std::to_string(mesh.triangles(face, i) + base);
    text += "\n";
  }
  return text;
}

std::string facets_of(const Mesh& mesh, std::string (*place)(const Mesh&, Eigen::Index), const std::string& open,
                      const std::string& before, const std::string& behind, const std::string& close) {
  std::string text;
  for (Eigen::Index face = 0; face < mesh.triangles.rows(); ++face) {
    text += open;
    for (int i = 0; i < 3; ++i) text += before + place(mesh, mesh.triangles(face, i)) + behind;
    text += close;
  }
  return text;
}

std::string binary_stl(const Mesh& mesh) {
  const auto facets = static_cast<std::uint32_t>(mesh.triangles.rows());
  std::string count(4, '\0');
  std::memcpy(count.data(), &facets, 4);
  return std::string(80, ' ') + count +
         facets_of(mesh, place_bytes, std::string(12, '\0'), "", "", std::string(2, '\0'));
}

std::string pcd_header(const Mesh& mesh, const std::string& data) {
  const std::string points = std::to_string(mesh.vertices.rows());
  return "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " + points + "\nHEIGHT 1\nPOINTS " +
         points + "\nDATA " + data + "\n";
}

void add_row(RatioTable& table, const std::string& format, const std::string& path, const std::string& content) {
  write_file(path, content);
  const std::size_t row = table.add_row({{format, std::to_string(content.size() / 1000000)}, "bytes alone", 0, 0});
  table.add_side(
      format, [path] { return [path] { benchmark::DoNotOptimize(read_mesh(path).vertices.data()); }; }, row,
      Side::Ours);
  table.add_side(
      format + "/bytes", [path] { return [path] { benchmark::DoNotOptimize(read_file(path).data()); }; }, row,
      Side::Peer);
}

int run(const Arguments& arguments) {
  const std::string folder = (std::filesystem::temp_directory_path() / "corral_read_benchmark").string();
  make_folder(folder);
  RatioTable table({"format", "MB"}, arguments.as_csv);
  const Mesh mesh = sheet();
  const std::string points = vertices_of(mesh, place_text, "", "\n");
  add_row(table, "ply-binary", folder + "/b.ply", binary_ply_text(mesh));
  add_row(table, "stl-binary", folder + "/b.stl", binary_stl(mesh));
  add_row(table, "pcd-binary", folder + "/b.pcd", pcd_header(mesh, "binary") + vertices_of(mesh, place_bytes, "", ""));
  add_row(table, "ply-text", folder + "/a.ply", ply_text(mesh));
  add_row(table, "stl-text", folder + "/a.stl",
          "solid\n" +
              facets_of(mesh, place_text, "facet normal 0 0 1\nouter loop\n", "vertex ", "\n", "endloop\nendfacet\n") +
              "endsolid\n");
  add_row(table, "pcd-text", folder + "/a.pcd", pcd_header(mesh, "ascii") + points);
  add_row(table, "off", folder + "/a.off",
          "OFF\n" + std::to_string(mesh.vertices.rows()) + " " + std::to_string(mesh.triangles.rows()) + " 0\n" +
              points + face_text(mesh, "3", 0));
  add_row(table, "obj", folder + "/a.obj", vertices_of(mesh, place_text, "v ", "\n") + face_text(mesh, "f", 1));
  add_row(table, "xyz", folder + "/a.xyz", points);
  benchmark::RunSpecifiedBenchmarks(&table);
  std::filesystem::remove_all(folder);
  return 0;
}

}  // namespace
}  // namespace corral::benchmarks

int main(int argc, char** argv) {
  return corral::benchmarks::run_program("read_benchmark", argc, argv, corral::benchmarks::run);
}
