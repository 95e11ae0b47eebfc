// SPDX-License-Identifier: MIT
#pragma once

#include "apps/dataset/set_folder.h"
#include "kernel/surface/mesh/mesh.h"

namespace corral {

/// A part of a data set that is being made, such as a scene with its truths: it is finished when the table of its pairs
/// exists. An interrupted call keeps the finished parts.
class SetPart {
 public:
  /// `table`: the file of the set that holds the pairs of the part, with the columns of pairs.csv. Both must outlive this.
  SetPart(const SetFolder& folder, const std::string& table) : folder_(folder), table_(table) {}

  bool is_finished() const { return folder_.has(table_); }

  /// Adds the pairs of the finished part to the set. Throws IoError if the table is not as `finish` writes it.
  void add_to(Dataset& dataset) const;

  /// Writes a file of the part, unless an earlier call has written it.
  void put(const std::string& file, const std::string& content) const;

  /// Writes the table, which finishes the part. `attributes` are those of the set.
  void finish(const std::vector<std::string>& attributes, const std::vector<DatasetPair>& pairs) const;

 private:
  const SetFolder& folder_;
  std::string table_;
};

/// A mesh to be scanned, and the name that its files begin with.
struct NamedMesh {
  std::string name;
  Mesh mesh;
};

/// Their lines in the recipe.
std::string recipe_lines(const std::vector<std::string>& files, const std::vector<NamedMesh>& models);

/// A letter and the position in a list, counted from 1, with at least two digits: v01, v02, ...
std::string numbered(char letter, int index);

/// A share of 1 in percent, with two decimals.
std::string percent_text(double share);

/// Throws InvalidInput unless the noise of a scan is finite and at least 0.
void require_noise(const std::string& who, double noise_pr);

/// Reads them all. Throws IoError as read_mesh does, for a mesh without faces, and if two have the same name.
std::vector<NamedMesh> read_models(const std::vector<std::string>& files);

}  // namespace corral
