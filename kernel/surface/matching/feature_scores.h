// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace corral {

// Products of short rows of floats: the arithmetic of a filter, rounded differently on every target. Callers allow for
// an error of (s + 4) 2^-24 of the sum of magnitudes after s steps. Only sources include this.

constexpr int kPanelColumns = 64;  ///< columns that are multiplied together, stored step by step
constexpr int kRowTile = 6;        ///< numbers of rows are multiples of this

/// Rows that are multiplied, each contiguous.
struct FloatRows {
  const float* first;
  std::ptrdiff_t stride;
  int count;
};

/// sums[row][column] += sum over steps of rows[row][step] * panel[step][column].
void add_products(const float* panel, int steps, const FloatRows& rows, float* sums);

/// The same sums for `panels` panels one after the other: scores[row][panel * 64 + column], and the largest of each
/// four columns of a panel that are sixteen apart: tops[row][panel * 16 + lane].
void score_columns(const float* first_panel, int panels, int steps, const FloatRows& rows, float* scores, float* tops);

/// The best of each sixteenth of the scores, 16 values and indices; `count` is a multiple of 16 above 0.
void best_of_lanes(const float* scores, int count, float* best, int* columns);

/// Indices of the scores that reach `least`, ascending. Returns how many; `found` has room for all and sixteen more.
int reaching(const float* scores, int count, float least, float* found);

/// Products of one row of 64 with chosen others, stored one after the other.
void score_chosen(const float* row, const float* others, const int* chosen, int count, float* scores);

}  // namespace corral
