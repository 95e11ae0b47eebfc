// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kernel/surface/mesh/mesh.h"
#include "kernel/surface/shot.h"

namespace corral::benchmarks {

/// A mesh and what the later stages need of the earlier ones, computed by us when first asked for and then kept.
class Workload {
 public:
  Workload(std::string name, Mesh mesh);

  const std::string& name() const { return name_; }
  const Mesh& mesh() const { return mesh_; }
  const Mesh& target();  ///< the mesh moved, with noise of 0.1 pr: the other side of matching
  double resolution();
  const Points& normals();
  const Indices& keypoints();  ///< at 3 pr

  /// `count` descriptors of the mesh and as many of its target, of keypoints if need be at a smaller radius; absent if the
  /// mesh has fewer vertices.
  using Features = std::optional<std::pair<Descriptors, Descriptors>>;
  const Features& features(int count);

 private:
  std::string name_;
  Mesh mesh_;
  std::optional<Mesh> target_;
  std::optional<double> resolution_;
  std::optional<Points> normals_;
  std::optional<Indices> keypoints_;
  std::map<int, Features> features_;
};

/// Each triangle cut in four, with noise of 0.1 pr: about four times the vertices, and no flat facets of exact ties.
Mesh refined(const Mesh& mesh);

/// The meshes named, or if none is those of the default data that are there and their refinements.
std::vector<Workload> read_workloads(const std::vector<std::string>& paths, const std::string& data_folder);

}  // namespace corral::benchmarks
