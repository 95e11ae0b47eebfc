// SPDX-License-Identifier: MIT
// Compiled with contraction: a multiplication and an addition may be one instruction.
#include "kernel/surface/matching/feature_scores.h"

#include "kernel/vectorized.h"

namespace corral {
namespace {

/// What the registers of a level hold at once: kRows rows of kWidth times sixteen columns.
template <class Floats>
struct Tile {
  static constexpr int kWidth = 1, kRows = 2;
};
template <>
struct Tile<lanes::Floats8x2> {
  static constexpr int kWidth = 1, kRows = 6;
};
template <>
struct Tile<lanes::Floats16> {
  static constexpr int kWidth = 4, kRows = 6;
};

template <class Floats>
struct Sums {
  Floats at[Tile<Floats>::kRows][Tile<Floats>::kWidth];
};

template <class Floats>
CORRAL_INLINE void multiply(const float* panel, int steps, const float* rows, std::ptrdiff_t stride,
                            Sums<Floats>& out) {
  constexpr int kWidth = Tile<Floats>::kWidth, kRows = Tile<Floats>::kRows;
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
template <class Floats, class Use>
CORRAL_INLINE void for_each_tile(const float* panel, int steps, const FloatRows& rows, const Use& use) {
  for (int row = 0; row < rows.count; row += Tile<Floats>::kRows)
    for (int column = 0; column < kPanelColumns; column += Tile<Floats>::kWidth * kFloatLanes) {
      Sums<Floats> sums;
      multiply(panel + column, steps, rows.first + row * rows.stride, rows.stride, sums);
      use(row, column, sums);
    }
}

}  // namespace

void add_products(const float* panel, int steps, const FloatRows& rows, float* sums) {
  vectorized([&](auto kind) {
    using Floats = typename decltype(kind)::Floats;
    for_each_tile<Floats>(panel, steps, rows, [&](int row, int column, const Sums<Floats>& tile) {
      for (int r = 0; r < Tile<Floats>::kRows; ++r)
        for (int i = 0; i < Tile<Floats>::kWidth; ++i) {
          float* to = sums + (row + r) * kPanelColumns + column + i * kFloatLanes;
          (Floats::load(to) + tile.at[r][i]).store(to);
        }
    });
  });
}

void score_columns(const float* first_panel, int panels, int steps, const FloatRows& rows, float* scores, float* tops) {
  vectorized([&](auto kind) {
    using Floats = typename decltype(kind)::Floats;
    for (int panel = 0; panel < panels; ++panel) {
      const float* columns = first_panel + static_cast<std::ptrdiff_t>(panel) * steps * kPanelColumns;
      for_each_tile<Floats>(columns, steps, rows, [&](int row, int column, const Sums<Floats>& tile) {
        for (int r = 0; r < Tile<Floats>::kRows; ++r) {
          const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(row + r) * panels + panel;
          Floats top = tile.at[r][0];
          for (int i = 0; i < Tile<Floats>::kWidth; ++i) {
            tile.at[r][i].store(scores + at * kPanelColumns + column + i * kFloatLanes);
            top = larger(top, tile.at[r][i]);
          }
          if (column > 0) top = larger(top, Floats::load(tops + at * kFloatLanes));
          top.store(tops + at * kFloatLanes);
        }
      });
    }
  });
}

void best_of_lanes(const float* scores, int count, float* best, int* columns) {
  vectorized([&](auto kind) {
    using Floats = typename decltype(kind)::Floats;
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
  });
}

int reaching(const float* scores, int count, float least, float* found) {
  float* end = found;
  vectorized([&](auto kind) {
    using Floats = typename decltype(kind)::Floats;
    static constexpr float kLane[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    const Floats bound = Floats::fill(least), step = Floats::fill(kFloatLanes);
    Floats place = Floats::load(kLane);
    for (int i = 0; i < count; i += kFloatLanes, place = place + step) {
      const unsigned reached = bits(bound <= Floats::load(scores + i));
      place.pack(reached, end);
      end += __builtin_popcount(reached);
    }
  });
  return static_cast<int>(end - found);
}

void score_chosen(const float* row, const float* others, const int* chosen, int count, float* scores) {
  vectorized([&](auto kind) {
    using Floats = typename decltype(kind)::Floats;
    const Floats a = Floats::load(row), b = Floats::load(row + kFloatLanes), c = Floats::load(row + 2 * kFloatLanes),
                 d = Floats::load(row + 3 * kFloatLanes);
    for (int i = 0; i < count; ++i) {
      const float* other = others + static_cast<std::ptrdiff_t>(chosen[i]) * kPanelColumns;
      float four[4];
      ((a * Floats::load(other) + b * Floats::load(other + kFloatLanes)) +
       (c * Floats::load(other + 2 * kFloatLanes) + d * Floats::load(other + 3 * kFloatLanes)))
          .folded()
          .folded()
          .store(four);
      scores[i] = (four[0] + four[1]) + (four[2] + four[3]);
    }
  });
}

}  // namespace corral
