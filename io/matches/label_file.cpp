// SPDX-License-Identifier: MIT
#include "io/matches/label_file.h"

#include <cmath>

#include "io/disk/file.h"
#include "io/matches/group_file.h"

namespace corral {

bool is_binary(const Eigen::Ref<const Eigen::MatrixXd>& numbers) {
  return numbers.size() > 0 && numbers.unaryExpr([](double number) { return number == 0 || number == 1; }).all();
}

std::vector<bool> labels_of(const NumberTable& table, int rows) {
  std::vector<bool> labels(static_cast<std::size_t>(rows));
  if (table.rows.size() == rows && is_binary(table.rows)) {
    for (std::size_t i = 0; i < labels.size(); ++i) labels[i] = table.rows.data()[i] == 1;
    return labels;
  }
  for (Eigen::Index i = 0; i < table.rows.size(); ++i) {
    const double index = table.rows.data()[i];
    const bool is_row = index >= 0 && index < rows && std::floor(index) == index;
    if (!is_row || labels[static_cast<std::size_t>(index)])
      table.fail(static_cast<int>(i) / table.width(), "expected a label 0 or 1 for each of " + std::to_string(rows) +
                                                          " matches, or the numbers of rows (0 .. " +
                                                          std::to_string(rows - 1) + "), each once; found " +
                                                          std::to_string(table.rows.size()) + " numbers");
    labels[static_cast<std::size_t>(index)] = true;
  }
  return labels;
}

std::vector<bool> read_labels(const std::string& name, int rows) { return labels_of(read_number_table(name), rows); }

Indices read_selection(const std::string& name, int rows) {
  const ArrayName array = split_array_name(name);
  if (array.name.empty() && read_file(array.file).rfind("row,selected", 0) == 0)
    return read_group_of(name, rows).selected;
  const std::vector<bool> labels = read_labels(name, rows);
  Indices selected;
  for (int row = 0; row < rows; ++row)
    if (labels[static_cast<std::size_t>(row)]) selected.push_back(row);
  return selected;
}

}  // namespace corral
