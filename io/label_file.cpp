// SPDX-License-Identifier: MIT
#include "io/label_file.h"

#include <cmath>

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
                                                          " matches, or each correct row (0 .. " +
                                                          std::to_string(rows - 1) + ") once; found " +
                                                          std::to_string(table.rows.size()) + " numbers");
    labels[static_cast<std::size_t>(index)] = true;
  }
  return labels;
}

std::vector<bool> read_labels(const std::string& name, int rows) { return labels_of(read_number_table(name), rows); }

}  // namespace corral
