// SPDX-License-Identifier: MIT
// Compiled with contraction: a multiplication and an addition may be one instruction.
#include "kernel/surface/matching/feature_scores.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/surface/matching/feature_scores.cpp"
#include <hwy/foreach_target.h>

#include "kernel/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

/// What the registers of a target hold at once: kRows rows of kWidth times sixteen columns.
constexpr int kRegister = static_cast<int>(HWY_LANES(float));
constexpr int kWidth = kRegister >= 16 ? 4 : 1;
constexpr int kRows = kRegister >= 8 || HWY_TARGET == HWY_NEON ? 6 : 2;

struct Sums {
  Floats at[kRows][kWidth];
};

HWY_INLINE void multiply(const float* panel, int steps, const float* rows, std::ptrdiff_t stride, Sums& out) {
  Floats sums[kRows][kWidth];
  for (int row = 0; row < kRows; ++row)
    for (int i = 0; i < kWidth; ++i) sums[row][i] = Floats::fill(0);
  for (int step = 0; step < steps; ++step, panel += kPanelColumns) {
    Floats columns[kWidth];
    for (int i = 0; i < kWidth; ++i) columns[i] = Floats::load(panel + i * kFloatLanes);
    for (int row = 0; row < kRows; ++row) {
      const Floats number = Floats::fill(rows[row * stride + step]);
      for (int i = 0; i < kWidth; ++i) sums[row][i] = sums[row][i] + columns[i] * number;
    }
  }
  for (int row = 0; row < kRows; ++row)
    for (int i = 0; i < kWidth; ++i) out.at[row][i] = sums[row][i];
}

/// Calls use(row, first column, tile) for every tile of a panel.
template <class Use>
HWY_INLINE void for_each_tile(const float* panel, int steps, const FloatRows& rows, const Use& use) {
  for (int row = 0; row < rows.count; row += kRows)
    for (int column = 0; column < kPanelColumns; column += kWidth * kFloatLanes) {
      Sums sums;
      multiply(panel + column, steps, rows.first + row * rows.stride, rows.stride, sums);
      use(row, column, sums);
    }
}

HWY_FLATTEN void add_products(const float* panel, int steps, const FloatRows& rows, float* sums) {
  for_each_tile(panel, steps, rows, [&](int row, int column, const Sums& tile) HWY_ATTR {
    for (int r = 0; r < kRows; ++r)
      for (int i = 0; i < kWidth; ++i) {
        float* to = sums + (row + r) * kPanelColumns + column + i * kFloatLanes;
        (Floats::load(to) + tile.at[r][i]).store(to);
      }
  });
}

HWY_FLATTEN void score_columns(const float* first_panel, int panels, int steps, const FloatRows& rows, float* scores,
                               float* tops) {
  for (int panel = 0; panel < panels; ++panel) {
    const float* columns = first_panel + static_cast<std::ptrdiff_t>(panel) * steps * kPanelColumns;
    for_each_tile(columns, steps, rows, [&](int row, int column, const Sums& tile) HWY_ATTR {
      for (int r = 0; r < kRows; ++r) {
        const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(row + r) * panels + panel;
        Floats top = tile.at[r][0];
        for (int i = 0; i < kWidth; ++i) {
          tile.at[r][i].store(scores + at * kPanelColumns + column + i * kFloatLanes);
          top = larger(top, tile.at[r][i]);
        }
        if (column > 0) top = larger(top, Floats::load(tops + at * kFloatLanes));
        top.store(tops + at * kFloatLanes);
      }
    });
  }
}

HWY_FLATTEN void best_of_lanes(const float* scores, int count, float* best, int* columns) {
  const Floats step = Floats::fill(kFloatLanes);
  Floats most = Floats::load(scores), at = Floats::fill(0), place = at;
  for (int i = kFloatLanes; i < count; i += kFloatLanes) {
    const Floats value = Floats::load(scores + i);
    place = place + step;
    at = select(most < value, place, at);
    most = larger(most, value);
  }
  most.store(best);
  at.store(columns);
  for (int lane = 0; lane < kFloatLanes; ++lane) columns[lane] += lane;
}

HWY_FLATTEN int reaching(const float* scores, int count, float least, float* found) {
  float* end = found;
  static constexpr float kLane[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  const Floats bound = Floats::fill(least), step = Floats::fill(kFloatLanes);
  Floats place = Floats::load(kLane);
  for (int i = 0; i < count; i += kFloatLanes, place = place + step) {
    const unsigned reached = bits(bound <= Floats::load(scores + i));
    place.pack(reached, end);
    end += hwy::PopCount(reached);
  }
  return static_cast<int>(end - found);
}

HWY_FLATTEN void score_chosen(const float* row, const float* others, const int* chosen, int count, float* scores) {
  const Floats a = Floats::load(row), b = Floats::load(row + kFloatLanes), c = Floats::load(row + 2 * kFloatLanes),
               d = Floats::load(row + 3 * kFloatLanes);
  for (int i = 0; i < count; ++i) {
    const float* other = others + static_cast<std::ptrdiff_t>(chosen[i]) * kPanelColumns;
    scores[i] = sum((a * Floats::load(other) + b * Floats::load(other + kFloatLanes)) +
                    (c * Floats::load(other + 2 * kFloatLanes) + d * Floats::load(other + 3 * kFloatLanes)));
  }
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(add_products);
HWY_EXPORT(score_columns);
HWY_EXPORT(best_of_lanes);
HWY_EXPORT(reaching);
HWY_EXPORT(score_chosen);

void add_products(const float* panel, int steps, const FloatRows& rows, float* sums) {
  HWY_DYNAMIC_DISPATCH(add_products)(panel, steps, rows, sums);
}

void score_columns(const float* first_panel, int panels, int steps, const FloatRows& rows, float* scores, float* tops) {
  HWY_DYNAMIC_DISPATCH(score_columns)(first_panel, panels, steps, rows, scores, tops);
}

void best_of_lanes(const float* scores, int count, float* best, int* columns) {
  HWY_DYNAMIC_DISPATCH(best_of_lanes)(scores, count, best, columns);
}

int reaching(const float* scores, int count, float least, float* found) {
  return HWY_DYNAMIC_DISPATCH(reaching)(scores, count, least, found);
}

void score_chosen(const float* row, const float* others, const int* chosen, int count, float* scores) {
  HWY_DYNAMIC_DISPATCH(score_chosen)(row, others, chosen, count, scores);
}

}  // namespace corral
#endif
