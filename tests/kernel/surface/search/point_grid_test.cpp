// SPDX-License-Identifier: MIT
#include "kernel/surface/search/point_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "kernel/surface/search/neighborhood.h"
#include "tests/support/execution.h"
#include "tests/support/meshes.h"
#include "tests/support/point_sets.h"
#include "tests/support/reference/surface.h"
#include "tests/support/renumbering.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/kernel/surface/search/point_grid_test.cpp"
#include <hwy/foreach_target.h>

#include "kernel/surface/search/packed_slots-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

/// Calls visit(place, dx) for what lanes see inside; returns how many places there are.
int visit_places(const PointGrid& grid, const SlotRange* first, const SlotRange* last, const Eigen::Vector3d& center,
                 double squared, const std::function<void(int, double)>& visit) {
  PackedSlots<3> places;
  places.collect({&grid.x(), &grid.y(), &grid.z()}, first, last);
  visit_within(places, center.x(), center.y(), center.z(), squared,
               [&](auto inside, Lanes dx, Lanes, Lanes, int i) HWY_ATTR {
                 double x[kLanes];
                 dx.store(x);
                 for (int lane = 0; lane < kLanes; ++lane)
                   if ((bits(inside) >> lane & 1) != 0) visit(i + lane, x[lane]);
               });
  return places.size();
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {
namespace {

HWY_EXPORT(visit_places);

using ::testing::Each;
using testing::hard_point_sets;
using testing::PointSet;

const int kReaches[] = {1, 2, 3, PointGrid::kLargestReach};

Eigen::Vector3d place(const PointGrid& grid, int slot) {
  const auto i = static_cast<std::size_t>(slot);
  return {grid.x()[i], grid.y()[i], grid.z()[i]};
}

/// By slot.
std::vector<double> sure_radii(const PointGrid& grid, int reach) {
  std::vector<double> radii;
  const AlignedColumn from_faces = grid.from_faces();
  for (int slot = 0; slot < grid.size(); ++slot)
    radii.push_back(grid.sure_radius(from_faces[static_cast<std::size_t>(slot)], reach));
  return radii;
}

/// The rows that lanes see inside, ascending.
Indices rows_within(const PointGrid& grid, const SlotRange* first, const SlotRange* last, const Eigen::Vector3d& center,
                    double radius) {
  Indices rows, slots;
  for (const SlotRange* range = first; range != last; ++range)
    for (int slot = range->begin; slot < range->end; ++slot) slots.push_back(slot);
  EXPECT_EQ(HWY_DYNAMIC_DISPATCH(visit_places)(grid, first, last, center, radius * radius,
                                               [&](int i, double x) {
                                                 const int slot = slots.at(static_cast<std::size_t>(i));
                                                 rows.push_back(grid.row(slot));
                                                 EXPECT_EQ(x, grid.x()[static_cast<std::size_t>(slot)] - center.x());
                                               }),
            static_cast<int>(slots.size()));
  std::sort(rows.begin(), rows.end());
  return rows;
}

Indices rows_of(const std::vector<Neighbor>& neighbors) {
  Indices rows;
  for (const Neighbor& neighbor : neighbors) rows.push_back(neighbor.index);
  return rows;
}

std::vector<std::pair<int, int>> pairs_of(const SlotRange* first, const SlotRange* last) {
  std::vector<std::pair<int, int>> pairs;
  for (; first != last; ++first) pairs.emplace_back(first->begin, first->end);
  return pairs;
}

TEST(PointGrid, SlotsAreAPermutationInTheOrderOfTheCells) {
  for (const PointSet& set : hard_point_sets())
    for (const double share : {0.5, 1.0, 3.0}) {
      SCOPED_TRACE(set.name);
      const PointGrid grid(set.points, share * set.unit);
      ASSERT_EQ(grid.size(), set.points.rows());
      std::vector<bool> seen(static_cast<std::size_t>(grid.size()), false);
      int slot = 0;
      for (int cell = 0; cell < grid.cells(); ++cell) {
        ASSERT_EQ(grid.begin(cell), slot);
        ASSERT_GT(grid.end(cell), slot) << "occupied";
        for (; slot < grid.end(cell); ++slot) {
          ASSERT_EQ(grid.cell_of(slot), cell);
          const int row = grid.row(slot);
          ASSERT_FALSE(seen[static_cast<std::size_t>(row)]);
          seen[static_cast<std::size_t>(row)] = true;
          ASSERT_EQ(place(grid, slot), Eigen::Vector3d(set.points.row(row).transpose()));
          if (slot == grid.begin(cell)) continue;
          const Eigen::Vector3d here = place(grid, slot), before = place(grid, slot - 1);
          ASSERT_LT(std::make_tuple(before.x(), before.y(), before.z(), grid.row(slot - 1)),
                    std::make_tuple(here.x(), here.y(), here.z(), row));
        }
      }
      EXPECT_EQ(slot, grid.size());
    }
}

TEST(PointGrid, SurePlacesAreFound) {
  for (const PointSet& set : hard_point_sets()) {
    const PointIndex index(set.points);
    for (const double share : {0.5, 1.0, 3.0}) {
      const PointGrid grid(set.points, share * set.unit);
      for (const int reach : kReaches) {
        SCOPED_TRACE(set.name + ", " + std::to_string(reach));
        const CellNeighborhoods around(grid, reach);
        const std::vector<double> radii = sure_radii(grid, reach);
        for (int slot = 0; slot < grid.size(); slot += 1 + grid.size() / 60) {
          const int cell = grid.cell_of(slot);
          const double sure = radii[static_cast<std::size_t>(slot)];
          ASSERT_GT(sure, 0);
          for (const double radius : {0.0, 0.4 * sure, set.unit, std::sqrt(2.0) * set.unit, sure}) {
            if (radius > sure) continue;
            const Indices found = rows_within(grid, around.begin(cell), around.end(cell), place(grid, slot), radius);
            ASSERT_EQ(found, rows_of(testing::reference_within(set.points, place(grid, slot), radius))) << radius;
            ASSERT_EQ(found, rows_of(index.within(place(grid, slot), radius))) << radius;
          }
        }
      }
    }
  }
}

TEST(PointGrid, SureIsNotTooModest) {
  for (const PointSet& set : hard_point_sets()) {
    const PointGrid grid(set.points, set.unit);
    if (set.name.find("outlier") != std::string::npos) continue;  // rounding is a share of the extent
    for (const int reach : kReaches)
      for (const double sure : sure_radii(grid, reach)) {
        EXPECT_GT(sure, reach * grid.cell_side() * (1 - 1e-7)) << set.name;
        EXPECT_LE(sure, (reach + 0.5) * grid.cell_side()) << set.name;
      }
  }
}

TEST(PointGrid, SweepsTellTheSameFromAnyStart) {
  for (const PointSet& set : hard_point_sets())
    for (const int reach : kReaches) {
      SCOPED_TRACE(set.name);
      const PointGrid grid(set.points, set.unit);
      const CellNeighborhoods around(grid, reach);
      for (const int step : {1, 7}) {
        CellSweep sweep(grid, reach);
        std::vector<SlotRange> ranges;
        for (int cell = step / 2; cell < grid.cells(); cell += step) {
          ranges.assign(1, {-2, -1});  // what is there already stays
          sweep.around(cell, ranges);
          ASSERT_EQ(ranges.front().begin, -2);
          const auto found = pairs_of(ranges.data() + 1, ranges.data() + ranges.size());
          ASSERT_EQ(found, pairs_of(around.begin(cell), around.end(cell)));
          for (std::size_t i = 0; i < found.size(); ++i) {
            ASSERT_LT(found[i].first, found[i].second);
            ASSERT_TRUE(i == 0 || found[i - 1].second <= found[i].first) << "ascending";
          }
        }
      }
    }
}

TEST(PointGrid, EveryTargetSeesTheSame) {
  for (const PointSet& set : hard_point_sets()) {
    const PointGrid grid(set.points, set.unit);
    const CellNeighborhoods around(grid, 1);
    for (int slot = 0; slot < grid.size(); slot += 1 + grid.size() / 20) {
      const int cell = grid.cell_of(slot);
      const Indices expected = rows_of(testing::reference_within(set.points, place(grid, slot), 0.9 * set.unit));
      for (const std::int64_t each : testing::available_targets()) {
        const testing::ForcedTarget forced(each);
        ASSERT_EQ(rows_within(grid, around.begin(cell), around.end(cell), place(grid, slot), 0.9 * set.unit), expected)
            << set.name;
      }
    }
  }
}

TEST(PointGrid, InfiniteRadiusFindsAllButThePadding) {
  const PointGrid grid(testing::uniform_points(61, 8), 0.4);
  const SlotRange ranges[] = {{0, 13}, {13, 13}, {20, 61}};
  EXPECT_EQ(rows_within(grid, ranges, ranges + 3, {0, 0, 0}, HUGE_VAL).size(), 13u + 41u);
  EXPECT_EQ(rows_within(grid, ranges, ranges, {0, 0, 0}, HUGE_VAL).size(), 0u);
}

TEST(PointGrid, NumberingDoesNotMatter) {
  for (const PointSet& set : hard_point_sets()) {
    const Indices old_row = testing::shuffled_rows(set.points.rows(), 3);
    const PointGrid grid(set.points, set.unit), other(set.points(old_row, Eigen::all), set.unit);
    ASSERT_EQ(grid.cells(), other.cells()) << set.name;
    for (int cell = 0; cell < grid.cells(); ++cell) ASSERT_EQ(grid.end(cell), other.end(cell));
    EXPECT_TRUE(grid.x() == other.x() && grid.y() == other.y() && grid.z() == other.z()) << set.name;
  }
}

TEST(PointGrid, ValuesComeBySlotAndPadded) {
  for (const int count : {0, 1, 7, 8, 9, 100}) {
    const PointGrid grid(testing::uniform_points(count, 9), 0.5);
    const AlignedColumn column = grid.by_slot(Eigen::VectorXd::LinSpaced(count, 1, count));
    ASSERT_EQ(column.size() % kLanes, 0u);
    ASSERT_GE(column.size(), static_cast<std::size_t>(count + kLanes - 1)) << "a load may start at the last slot";
    for (int slot = 0; slot < count; ++slot) EXPECT_EQ(column[static_cast<std::size_t>(slot)], grid.row(slot) + 1);
    EXPECT_THAT(std::vector<double>(column.begin() + count, column.end()), Each(0.0));
  }
}

TEST(PointGrid, CellsHoldAboutTheOccupancyOnASurface) {
  for (const double scale : {1e-3, 1.0, 1e6})
    for (const double occupancy : {3.0, 9.0, 25.0}) {
      const Points points = scale * testing::bumpy_sphere(5, 1).vertices;
      const PointGrid grid = PointGrid::with_occupancy(points, occupancy);
      EXPECT_GT(points.rows() / static_cast<double>(grid.cells()), 0.6 * occupancy);
      EXPECT_LT(points.rows() / static_cast<double>(grid.cells()), 1.7 * occupancy);
    }
  for (const PointSet& set : hard_point_sets()) {
    const PointGrid grid = PointGrid::with_occupancy(set.points, 3);
    EXPECT_EQ(grid.size(), set.points.rows()) << set.name;
    EXPECT_TRUE(grid.cell_side() > 0 && std::isfinite(grid.cell_side())) << set.name;
  }
}

TEST(PointGrid, MiddleOfACellIsAHalfFromItsFaces) {
  const PointGrid grid(0.5 * testing::lattice(5).array(), 1);  // cells from 0: halves are their middles
  for (int slot = 0; slot < grid.size(); ++slot) {
    const Eigen::Array3d from_face = place(grid, slot).array() - place(grid, slot).array().floor();
    EXPECT_DOUBLE_EQ(grid.from_middle(slot), (from_face - 0.5).square().sum());
  }
}

TEST(PointGrid, ExtentsThatAreNoNumbersDoNotCrash) {
  Points vast = testing::uniform_points(40, 10), minute = vast * 1e-310;
  vast *= 1.7e308;
  for (const Points& points : {vast, minute})
    for (const double side : {1e-300, 1.0, 1e300}) {
      const PointGrid grid(points, side);
      EXPECT_EQ(grid.size(), 40);
      for (const int reach : kReaches) CellNeighborhoods(grid, reach);
      for (const double sure : sure_radii(grid, 1)) EXPECT_GE(sure, 0);
    }
}

}  // namespace
}  // namespace corral
#endif
