// SPDX-License-Identifier: MIT
#include "kernel/surface/search/diameter.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace corral {
namespace {

constexpr int kLeafPoints = 8;

struct Box {
  Eigen::RowVector3d low, high;
  int first, last;             ///< points of the box, by their places in the tree's order
  int children[2] = {-1, -1};  ///< none in a leaf
};

/// Sums in one order, so that a bound of rounded numbers is never below the rounded distance of what it bounds.
double squared_length(double x, double y, double z) { return (x * x + y * y) + z * z; }

class DiameterSearch {
 public:
  explicit DiameterSearch(const Points& points) : points_(points), rows_(static_cast<std::size_t>(points.rows())) {
    std::iota(rows_.begin(), rows_.end(), 0);
    split(0, static_cast<int>(rows_.size()));
  }

  double squared_diameter() {
    compare(0, 0);
    return best_;
  }

 private:
  /// Halves the points first .. last at the median of their widest axis until few are left; the number of their box.
  int split(int first, int last) {
    Box box;
    box.first = first, box.last = last;
    box.low = box.high = points_.row(rows_[static_cast<std::size_t>(first)]);
    for (int place = first + 1; place < last; ++place) {
      const auto point = points_.row(rows_[static_cast<std::size_t>(place)]);
      box.low = box.low.cwiseMin(point), box.high = box.high.cwiseMax(point);
    }
    const int number = static_cast<int>(boxes_.size());
    boxes_.push_back(box);
    if (last - first <= kLeafPoints) return number;
    int axis;
    (box.high - box.low).maxCoeff(&axis);
    const int middle = first + (last - first) / 2;
    std::nth_element(rows_.begin() + first, rows_.begin() + middle, rows_.begin() + last,
                     [&](int a, int b) { return points_(a, axis) < points_(b, axis); });
    const int low = split(first, middle), high = split(middle, last);
    boxes_[static_cast<std::size_t>(number)].children[0] = low;
    boxes_[static_cast<std::size_t>(number)].children[1] = high;
    return number;
  }

  const Box& box(int number) const { return boxes_[static_cast<std::size_t>(number)]; }

  /// No point of one box is farther from one of the other.
  double bound(int a, int b) const {
    const Eigen::RowVector3d farthest = (box(a).high - box(b).low).cwiseMax(box(b).high - box(a).low);
    return squared_length(farthest(0), farthest(1), farthest(2));
  }

  void compare(int a, int b) {
    if (!(bound(a, b) > best_)) return;
    const bool a_is_leaf = box(a).children[0] < 0, b_is_leaf = box(b).children[0] < 0;
    if (a_is_leaf && b_is_leaf) return compare_points(box(a), box(b));
    if (a_is_leaf || (!b_is_leaf && box(b).last - box(b).first > box(a).last - box(a).first)) std::swap(a, b);
    int near = box(a).children[0], far = box(a).children[1];
    if (bound(near, b) > bound(far, b)) std::swap(near, far);
    compare(far, b);  // first, since it raises what the other must exceed
    compare(near, b);
  }

  void compare_points(const Box& a, const Box& b) {
    for (int i = a.first; i < a.last; ++i)
      for (int j = b.first; j < b.last; ++j) {
        const Eigen::RowVector3d between =
            points_.row(rows_[static_cast<std::size_t>(i)]) - points_.row(rows_[static_cast<std::size_t>(j)]);
        best_ = std::max(best_, squared_length(between(0), between(1), between(2)));
      }
  }

  const Points& points_;
  Indices rows_;
  std::vector<Box> boxes_;
  double best_ = 0;
};

}  // namespace

double diameter(const Points& points) {
  return points.rows() < 2 ? 0 : std::sqrt(DiameterSearch(points).squared_diameter());
}

}  // namespace corral
