// SPDX-License-Identifier: MIT
#include "io/mesh/mesh_file.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <iterator>

#include "io/disk/file.h"
#include "io/disk/inflate.h"
#include "io/mesh/bin_file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char letter) { return std::tolower(letter); });
  return text;
}

std::string ending_of(const std::filesystem::path& path) { return lower_case(path.extension().string()); }

using Parser = StoredMesh (*)(const std::string& path, std::string_view content);
struct MeshFormat {
  const char* ending;
  Parser parse;
  bool is_only_for_meshes;  ///< whatever has a name of this ending is a mesh
};
constexpr MeshFormat kFormats[] = {{".ply", parse_ply, true},  {".off", parse_off, true},  {".obj", parse_obj, true},
                                   {".stl", parse_stl, true},  {".pcd", parse_pcd, true},  {".xyz", parse_xyz, true},
                                   {".pts", parse_xyz, true},  {".asc", parse_xyz, false}, {".txt", parse_xyz, false},
                                   {".csv", parse_xyz, false}, {".bin", parse_bin, false}};

bool is_compressed(const std::string& path) { return ending_of(path) == ".gz"; }

/// Null if no format has such names.
const MeshFormat* format_of(const std::string& path) {
  const std::filesystem::path name = path;
  const std::string ending = ending_of(is_compressed(path) ? name.stem() : name);
  const auto found = std::find_if(std::begin(kFormats), std::end(kFormats),
                                  [&](const MeshFormat& format) { return ending == format.ending; });
  return found == std::end(kFormats) ? nullptr : found;
}

std::string ply_header(const std::string& format, const Mesh& mesh) {
  std::string text = "ply\nformat " + format + " 1.0\nelement vertex " + std::to_string(mesh.vertices.rows()) +
                     "\nproperty double x\nproperty double y\nproperty double z\n";
  if (mesh.normals.rows() > 0) text += "property double nx\nproperty double ny\nproperty double nz\n";
  if (mesh.triangles.rows() > 0)
    text += "element face " + std::to_string(mesh.triangles.rows()) + "\nproperty list uchar int vertex_indices\n";
  return text + "end_header\n";
}

/// The lowest byte first, on any machine.
void append_bytes(std::string& text, std::uint64_t bits, int bytes) {
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(static_cast<unsigned char>(bits >> (8 * i)));
}

}  // namespace

void TriangleBuilder::reserve(std::int64_t triangles) { corners_.reserve(3 * static_cast<std::size_t>(triangles)); }

void TriangleBuilder::add(int a, int b, int c) { corners_.insert(corners_.end(), {a, b, c}); }

void TriangleBuilder::add_polygon(const std::vector<std::int64_t>& corners) {
  for (std::size_t i = 2; i < corners.size(); ++i)
    add(static_cast<int>(corners[0]), static_cast<int>(corners[i - 1]), static_cast<int>(corners[i]));
}

Triangles TriangleBuilder::build() const {
  return Eigen::Map<const Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>>(
      corners_.data(), static_cast<Eigen::Index>(corners_.size() / 3), 3);
}

std::string mesh_endings() {
  std::string text;
  for (const MeshFormat& format : kFormats) {
    const bool is_last = &format == std::end(kFormats) - 1;
    text += (text.empty() ? "" : is_last ? " or " : ", ") + std::string(format.ending);
  }
  return text + " (also with .gz behind)";
}

bool is_mesh_name(const std::string& path) {
  const MeshFormat* const format = format_of(path);
  return format != nullptr && format->is_only_for_meshes;
}

StoredMesh read_mesh(const std::string& path) {
  const MeshFormat* const format = format_of(path);
  std::string content = read_file(path);
  if (!format) throw IoError(path, "", "unknown mesh format, expected a name that ends in " + mesh_endings());
  if (is_compressed(path) && !content.empty()) content = inflated(path, content);
  if (content.empty()) throw IoError(path, "", "the file is empty, expected a mesh");
  return format->parse(path, content);
}

std::string ply_text(const Mesh& mesh) {
  std::string text = ply_header("ascii", mesh);
  for (Eigen::Index row = 0; row < mesh.vertices.rows(); ++row)
    text += to_text(mesh.vertices(row, 0)) + " " + to_text(mesh.vertices(row, 1)) + " " +
            to_text(mesh.vertices(row, 2)) +
            (mesh.normals.rows() > 0 ? " " + to_text(mesh.normals(row, 0)) + " " + to_text(mesh.normals(row, 1)) + " " +
                                           to_text(mesh.normals(row, 2))
                                     : "") +
            "\n";
  for (Eigen::Index row = 0; row < mesh.triangles.rows(); ++row)
    text += "3 " + std::to_string(mesh.triangles(row, 0)) + " " + std::to_string(mesh.triangles(row, 1)) + " " +
            std::to_string(mesh.triangles(row, 2)) + "\n";
  return text;
}

std::string binary_ply_text(const Mesh& mesh) {
  std::string text = ply_header("binary_little_endian", mesh);
  text.reserve(text.size() + 24 * static_cast<std::size_t>(mesh.vertices.rows()) +
               13 * static_cast<std::size_t>(mesh.triangles.rows()));
  const auto append = [&](const double& number) {
    std::uint64_t bits;
    std::memcpy(&bits, &number, sizeof bits);
    append_bytes(text, bits, 8);
  };
  for (Eigen::Index row = 0; row < mesh.vertices.rows(); ++row) {
    for (int axis = 0; axis < 3; ++axis) append(mesh.vertices(row, axis));
    for (int axis = 0; axis < mesh.normals.cols() && mesh.normals.rows() > 0; ++axis) append(mesh.normals(row, axis));
  }
  for (Eigen::Index row = 0; row < mesh.triangles.rows(); ++row) {
    text += '\3';
    for (int i = 0; i < 3; ++i) append_bytes(text, static_cast<std::uint32_t>(mesh.triangles(row, i)), 4);
  }
  return text;
}

void check_ply_name(const std::string& path) {
  if (ending_of(path) != ".ply")
    throw IoError(path, "", "meshes are written as PLY, expected a name that ends in .ply");
}

void write_mesh(const std::string& path, const Mesh& mesh) {
  check_ply_name(path);
  write_file(path, ply_text(mesh));
}

}  // namespace corral
