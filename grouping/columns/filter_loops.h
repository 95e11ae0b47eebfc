// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "grouping/columns/filter.h"

namespace corral {

// The loops behind the filters: float arithmetic on whole columns, on the vector registers of the machine. Their sums may
// differ from target to target by what the filters allow for; nothing else may depend on them. Only sources include this.
// Plain form  tests/support/reference/groupers.h

/// counts[i], padded: the number of rows j that are possibly consistent with row i, itself included.
void count_consistent(const ConsistencyFilter& filter, int* counts);

/// For how many rows the residual is possibly below the tolerance; any number up to `hopeless` once it is certain that
/// there are no more.
int count_near(const FilterTable& table, const PoseFilter& pose, int hopeless);

/// The same, ended sooner where the slab holds few rows.
int count_near(const FilterTable& table, const PoseFilter& pose, const Slab& slab, int hopeless);

/// How many poses are evaluated together.
constexpr int kPoseTile = 4;

/// counts[k], plus for how many rows of first .. last - 1, whole numbers of lanes, the residual under pose k is possibly below
/// the tolerance. For poses by the hundred: a stretch of rows that fits the cache is read for all of them.
void add_near(const FilterTable& table, int first, int last, const PoseFilter (&poses)[kPoseTile],
              int (&counts)[kPoseTile]);

/// One bit for each pair of a row and the columns 8 block .. 8 block + 7: certain[i] and possible[i] hold those of row i,
/// the first column in the lowest bit. Padded.
void compare_ratios(const FilterTable& table, const SimilarityFilter& filter, int block, std::uint8_t* certain,
                    std::uint8_t* possible);

/// squared[j], padded: the squared distance in the source from a row to row j, of unit FilterTable::unit(); infinite for
/// the row itself.
void measure_distances(const FilterTable& table, int row, float* squared);

/// How many limits are counted together.
constexpr int kLimits = 4;

/// counts[k]: how many of `count` (padded) numbers are at most limits[k].
void count_up_to(const float* numbers, int count, const float (&limits)[kLimits], int (&counts)[kLimits]);

/// marks[i], padded: 1 where numbers[i] is in first .. last, else 0. Returns how many of `count` (padded) are below.
int mark_between(const float* numbers, int count, float first, float last, std::uint8_t* marks);

/// Votes, as far as floats decide them.
struct FilteredVotes {
  int asked = 0, certain = 0, possible = 0;
};

/// The votes on a row of the trusted rows (1, others 0) whose squared distance is below `limit`: rigid with it or not.
FilteredVotes ask_near(const FilterTable& table, const SimilarityFilter& filter, int row, const float* squared,
                       float limit, const float* trusted);

/// The votes on a row of `table` of all `voters`: rigid with it, and with a small residual under its pose, or not.
FilteredVotes ask_voters(const FilterTable& voters, const SimilarityFilter& filter, const FilterTable& table, int row,
                         const PoseFilter& pose);

}  // namespace corral
