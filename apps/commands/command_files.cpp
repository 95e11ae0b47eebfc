// SPDX-License-Identifier: MIT
#include "apps/commands/command_files.h"

#include <filesystem>

#include "apps/commands/commands.h"
#include "apps/pair/read_surface.h"
#include "apps/pair/surface_warnings.h"
#include "apps/runtime/output.h"
#include "io/pose/transform_file.h"
#include "kernel/error.h"

namespace corral {
namespace {

namespace fs = std::filesystem;

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code unknown;
  if (fs::equivalent(a, b, unknown)) return true;
  const fs::path whole_a = fs::weakly_canonical(fs::absolute(a), unknown),
                 whole_b = fs::weakly_canonical(fs::absolute(b), unknown);
  return !whole_a.empty() && whole_a == whole_b;
}

/// Not a pipe or a device, which may stand on both sides.
bool is_stored(const std::string& path) {
  std::error_code unknown;
  return fs::is_regular_file(path, unknown) || fs::is_directory(path, unknown);
}

}  // namespace

Mesh read_input(const std::string& path, bool drop_stray) {
  StoredMesh mesh = read_surface(path);
  for (const std::string& note : mesh.notes) say("note: " + path + ": " + note);
  if (!drop_stray) return std::move(mesh);
  const PointSpacing spacing = point_spacing(mesh.vertices);
  if (spacing.strays.empty()) return std::move(mesh);
  const std::size_t count = spacing.strays.size();
  if (static_cast<Eigen::Index>(count) + 2 > mesh.vertices.rows())
    throw IoError(path, "", "all its vertices are far from each other, expected a surface for --drop-stray");
  say("note: " + path + ": " + std::to_string(count) + (count == 1 ? " stray vertex" : " stray vertices") +
      " left out, the first is " + std::to_string(spacing.strays.front()) + "; later ones are numbered anew");
  return without_vertices(mesh, spacing.strays);
}

void keep_inputs(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i)
    for (std::size_t other = 0; other < i; ++other)
      if (!outputs[i].empty() && !outputs[other].empty() && is_same_file(outputs[i], outputs[other]))
        throw UsageError(outputs[i] + ": is named for two outputs, expected a file for each");
  for (const std::string& output : outputs)
    for (const std::string& name : inputs) {
      const std::string input = split_transform_name(name).file;  // of poses a key may follow
      if (!output.empty() && !input.empty() && is_stored(input) && is_same_file(output, input))
        throw UsageError(output + ": is an input of this call, expected another name for the output");
    }
}

}  // namespace corral
