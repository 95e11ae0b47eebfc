// SPDX-License-Identifier: MIT
#include "apps/dataset/set_part.h"

#include <algorithm>
#include <cmath>

#include "io/mesh/mesh_file.h"
#include "io/text/csv_file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

/// The pairs.csv of a set of just these pairs.
std::string pairs_text(const std::vector<std::string>& attributes, const std::vector<DatasetPair>& pairs) {
  Dataset part;
  part.attributes = attributes;
  part.pairs = pairs;
  return pairs_csv_text(part);
}

}  // namespace

void SetPart::add_to(Dataset& dataset) const {
  const std::string path = folder_.path(table_);
  const CsvTable table = read_csv(path), expected = parse_csv(path, pairs_text(dataset.attributes, {}));
  if (table.header != expected.header)
    throw IoError(path, "header", "is not that of a table of pairs of the set, expected the file as it was made");
  for (const auto& cells : table.rows)
    dataset.pairs.push_back({cells[0], cells[1], cells[2], cells[3], {cells.begin() + 4, cells.end()}});
}

void SetPart::put(const std::string& file, const std::string& content) const {
  if (!folder_.has(file)) folder_.put(file, content);
}

void SetPart::finish(const std::vector<std::string>& attributes, const std::vector<DatasetPair>& pairs) const {
  folder_.put(table_, pairs_text(attributes, pairs));
}

std::string recipe_lines(const std::vector<std::string>& files, const std::vector<NamedMesh>& models) {
  std::string text;
  for (std::size_t i = 0; i < models.size(); ++i) text += "model " + models[i].name + " " + checksum(files[i]) + "\n";
  return text;
}

std::string numbered(char letter, int index) {
  const std::string number = std::to_string(index + 1);
  return letter + (number.size() < 2 ? "0" + number : number);
}

std::string percent_text(double share) { return to_text(std::round(10000 * share) / 100); }

void require_noise(const std::string& who, double noise_pr) {
  if (!(noise_pr >= 0) || !std::isfinite(noise_pr))
    throw InvalidInput(who, "noise_pr", noise_pr, "a finite length of at least 0");
}

std::vector<NamedMesh> read_models(const std::vector<std::string>& files) {
  std::vector<NamedMesh> models;
  for (const std::string& file : files) {
    NamedMesh model{file_word(file), read_mesh(file)};
    const auto has_its_name = [&](const NamedMesh& other) { return other.name == model.name; };
    if (std::any_of(models.begin(), models.end(), has_its_name))
      throw IoError(file, "", "is a second model named " + model.name + ", expected each name once");
    if (model.mesh.triangles.rows() == 0)
      throw IoError(file, "", "has no faces, expected a surface that rays can meet");
    models.push_back(std::move(model));
  }
  return models;
}

}  // namespace corral
