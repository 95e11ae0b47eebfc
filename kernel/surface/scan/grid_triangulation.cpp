// SPDX-License-Identifier: MIT
#include "kernel/surface/scan/grid_triangulation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace corral {
namespace {

class Grid {
 public:
  Grid(const Points& vertices, const Indices& cells, std::int64_t columns)
      : vertices_(vertices),
        cells_(cells),
        columns_(columns),
        rows_(static_cast<std::int64_t>(cells.size()) / columns) {
    longest_edge_ = kLongestGridEdge * median_distance();
  }

  Triangles triangulate() {
    for (std::int64_t row = 0; row + 1 < rows_; ++row)
      for (std::int64_t column = 0; column + 1 < columns_; ++column) add_quad(row, column);
    return Eigen::Map<const Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>>(
        corners_.data(), static_cast<Eigen::Index>(corners_.size() / 3), 3);
  }

 private:
  int at(std::int64_t row, std::int64_t column) const {
    return cells_[static_cast<std::size_t>(row * columns_ + column)];
  }
  double distance(int a, int b) const { return (vertices_.row(a) - vertices_.row(b)).norm(); }

  /// Between neighbours in a row or a column; 0 if there are none.
  double median_distance() const {
    std::vector<double> distances;
    const auto add = [&](int a, int b) {
      if (a < 0 || b < 0) return;
      const double found = distance(a, b);
      if (std::isfinite(found)) distances.push_back(found);
    };
    for (std::int64_t row = 0; row < rows_; ++row)
      for (std::int64_t column = 0; column < columns_; ++column) {
        if (column + 1 < columns_) add(at(row, column), at(row, column + 1));
        if (row + 1 < rows_) add(at(row, column), at(row + 1, column));
      }
    if (distances.empty()) return 0;
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    return *middle;
  }

  void add_quad(std::int64_t row, std::int64_t column) {
    const std::array<int, 4> cells = {at(row, column), at(row, column + 1), at(row + 1, column + 1),
                                      at(row + 1, column)};
    std::array<int, 4> corners;
    const auto end = std::copy_if(cells.begin(), cells.end(), corners.begin(), [](int vertex) { return vertex >= 0; });
    const auto [a, b, c, d] = corners;
    if (end - corners.begin() == 3) return add(a, b, c);
    if (end - corners.begin() < 3) return;
    if (distance(a, c) <= distance(b, d)) {
      add(a, b, c);
      add(a, c, d);
    } else {
      add(a, b, d);
      add(b, c, d);
    }
  }

  void add(int a, int b, int c) {
    if (distance(a, b) <= longest_edge_ && distance(b, c) <= longest_edge_ && distance(c, a) <= longest_edge_)
      corners_.insert(corners_.end(), {a, b, c});
  }

  const Points& vertices_;
  const Indices& cells_;
  std::int64_t columns_, rows_;
  double longest_edge_ = 0;
  Indices corners_;
};

}  // namespace

Triangles triangulate_grid(const Points& vertices, const Indices& cells, std::int64_t columns) {
  return Grid(vertices, cells, columns).triangulate();
}

}  // namespace corral
