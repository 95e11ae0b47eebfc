// SPDX-License-Identifier: MIT
#include "kernel/surface/support.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "kernel/surface/support_loops.h"

namespace corral {
namespace {

/// The distances, and nothing in the padding.
void measure(Support& support) {
  const auto count = static_cast<std::size_t>(support.count), end = static_cast<std::size_t>(padded(support.count));
  for (AlignedColumn* column :
       {&support.x, &support.y, &support.z, &support.distance, &support.nx, &support.ny, &support.nz})
    std::fill(column->begin() + static_cast<std::ptrdiff_t>(count), column->begin() + static_cast<std::ptrdiff_t>(end),
              0.0);
  measure_support(support);
}

}  // namespace

void Support::add(const Eigen::Vector3d& offset, const Eigen::Vector3d& normal) {
  const double length = std::sqrt(offset.x() * offset.x() + offset.y() * offset.y() + offset.z() * offset.z());
  if (!(length > 0)) return;
  const auto at = static_cast<std::size_t>(count++);
  const double values[] = {offset.x(), offset.y(), offset.z(), length, normal.x(), normal.y(), normal.z()};
  const double* value = values;
  for (AlignedColumn* column : {&x, &y, &z, &distance, &nx, &ny, &nz}) {
    column->resize(static_cast<std::size_t>(padded(count)), 0.0);
    (*column)[at] = *value++;
  }
}

SupportFinder::SupportFinder(const Points& vertices, const Points& normals, double radius, Rim rim)
    : grid_(PointGrid::for_radius(vertices, radius, kReach)),
      nx_(grid_.by_slot(normals.col(0))),
      ny_(grid_.by_slot(normals.col(1))),
      nz_(grid_.by_slot(normals.col(2))),
      rows_(grid_.x().size(), 0.0),
      squared_(  // finite: the padding of the grid is not near
          std::min(rim == Rim::Inside ? radius * radius : std::nextafter(radius * radius, 0),
                   std::numeric_limits<double>::max())),
      slots_(static_cast<std::size_t>(grid_.size())) {
  for (int slot = 0; slot < grid_.size(); ++slot) {
    slots_[static_cast<std::size_t>(grid_.row(slot))] = slot;
    rows_[static_cast<std::size_t>(slot)] = grid_.row(slot);
  }
}

std::vector<std::size_t> SupportFinder::walk(const Indices& vertices) const {
  std::vector<std::size_t> order(vertices.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::make_pair(slot_of(vertices[a]), a) < std::make_pair(slot_of(vertices[b]), b);
  });
  return order;
}

void SupportFinder::look(int vertex, Place& place, Support& support, bool with_rows) const {
  const int slot = slot_of(vertex);
  if (slot >= place.end) move_to(grid_.cell_of(slot), place, support);
  collect(static_cast<std::size_t>(slot), place.around, support, with_rows);
  measure(support);
}

void SupportFinder::move_to(int cell, Place& place, Support& support) const {
  place.end = grid_.end(cell);
  place.around.clear();
  place.sweep.around(cell, place.around);
  std::size_t most = kLanes;
  for (const SlotRange& range : place.around) most += static_cast<std::size_t>(range.end - range.begin);
  for (AlignedColumn* column :
       {&support.x, &support.y, &support.z, &support.distance, &support.nx, &support.ny, &support.nz, &support.rows})
    if (column->size() < most) column->resize(2 * most);
}

void SupportFinder::collect(std::size_t slot, const std::vector<SlotRange>& ranges, Support& support,
                            bool with_rows) const {
  const SlotColumns columns{{grid_.x().data(), grid_.y().data(), grid_.z().data(), nx_.data(), ny_.data(), nz_.data(),
                             with_rows ? rows_.data() : nullptr}};
  collect_support(columns, slot, squared_, ranges, support);
}

void visit_supports(const SupportFinder& finder, const Indices& keypoints, const ParallelFor& parallel,
                    const std::function<SupportVisit()>& visitor) {
  constexpr std::size_t kBlock = 64;
  const auto order = finder.walk(keypoints);
  parallel(static_cast<int>((order.size() + kBlock - 1) / kBlock), [&](int block) {
    auto place = finder.start();
    Support support;
    const SupportVisit visit = visitor();
    const std::size_t first = static_cast<std::size_t>(block) * kBlock;
    for (std::size_t at = first; at < std::min(order.size(), first + kBlock); ++at) {
      finder.find(keypoints[order[at]], place, support);
      visit(order[at], support);
    }
  });
}

}  // namespace corral
