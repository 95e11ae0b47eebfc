// SPDX-License-Identifier: MIT
#include "kernel/spatial_order.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace corral {
namespace {

constexpr std::ptrdiff_t kBranches = 8;  // of a node, and points of a full leaf
constexpr std::ptrdiff_t kFew = 16;      // items that are not worth a pivot
constexpr std::ptrdiff_t kSamples = 9;   // of which one becomes the pivot
constexpr int kMostPivots = 40;          // more are bad luck

struct Item {
  double place[3];
  int row;
};

int longest_axis(const Item* first, const Item* last) {
  double low[3], high[3];
  std::copy_n(first->place, 3, low);
  std::copy_n(first->place, 3, high);
  for (const Item* item = first; item != last; ++item)
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], item->place[axis]);
      high[axis] = std::max(high[axis], item->place[axis]);
    }
  int longest = 0;
  for (const int axis : {1, 2})
    if (high[axis] - low[axis] > high[longest] - low[longest]) longest = axis;
  return longest;
}

/// Those that come before the others are moved to the front; where they end. No branch depends on an item.
template <class IsBefore>
Item* partition(Item* first, Item* last, const IsBefore& is_before) {
  Item* end = first;
  for (Item* item = first; item != last; ++item) {
    const Item moved = *item;
    *item = *end;
    *end = moved;
    end += is_before(moved);
  }
  return end;
}

/// std::nth_element by one coordinate; twice as fast, because which way an item goes cannot be guessed.
void select(Item* first, Item* nth, Item* last, int axis) {
  for (int pivots = 0; last - first > kFew && pivots < kMostPivots; ++pivots) {
    std::array<double, kSamples> samples;
    for (std::ptrdiff_t i = 0; i < kSamples; ++i)
      samples[static_cast<std::size_t>(i)] = first[(last - first - 1) * i / (kSamples - 1)].place[axis];
    std::sort(samples.begin(), samples.end());
    const double pivot = samples[static_cast<std::size_t>((nth - first) * kSamples / (last - first))];
    Item* const lower = partition(first, last, [&](const Item& item) { return item.place[axis] < pivot; });
    if (nth < lower) {
      last = lower;
      continue;
    }
    Item* const equal = lower - first > (last - first) / 8
                            ? lower
                            : partition(lower, last, [&](const Item& item) { return item.place[axis] <= pivot; });
    if (nth < equal) return;
    first = equal;
  }
  std::nth_element(first, nth, last, [axis](const Item& a, const Item& b) { return a.place[axis] < b.place[axis]; });
}

/// Calls part(first, last) for both halves of more than one share.
template <class Part>
void halve(Item* first, Item* last, std::ptrdiff_t share, const Part& part) {
  const std::ptrdiff_t shares = (last - first + share - 1) / share;
  Item* const middle = first + share * (shares / 2);
  select(first, middle, last, longest_axis(first, last));
  part(first, middle);
  part(middle, last);
}

void divide(Item* first, Item* last, std::ptrdiff_t share) {
  while (last - first <= share) {
    if (share <= kBranches) return;
    share /= kBranches;
  }
  halve(first, last, share, [share](Item* begin, Item* end) { divide(begin, end, share); });
}

/// Cuts until each part is one share.
void divide_into(std::vector<std::pair<Item*, Item*>>& parts, Item* first, Item* last, std::ptrdiff_t share) {
  if (last - first <= share)
    parts.emplace_back(first, last);
  else
    halve(first, last, share, [&](Item* begin, Item* end) { divide_into(parts, begin, end, share); });
}

}  // namespace

Indices spatial_order(const Points& points, const ParallelFor& parallel) {
  std::vector<Item> items;
  Indices rest;
  items.reserve(static_cast<std::size_t>(points.rows()));
  for (Eigen::Index row = 0; row < points.rows(); ++row) {
    if (points.row(row).allFinite())
      items.push_back({{points(row, 0), points(row, 1), points(row, 2)}, static_cast<int>(row)});
    else
      rest.push_back(static_cast<int>(row));
  }
  std::ptrdiff_t share = kBranches;
  while (share * kBranches < static_cast<std::ptrdiff_t>(items.size())) share *= kBranches;
  std::vector<std::pair<Item*, Item*>> parts;  // of the root
  divide_into(parts, items.data(), items.data() + items.size(), share);
  parallel(static_cast<int>(parts.size()), [&](int i) {
    const auto [first, last] = parts[static_cast<std::size_t>(i)];
    divide(first, last, share);
  });
  Indices rows;
  rows.reserve(static_cast<std::size_t>(points.rows()));
  for (const Item& item : items) rows.push_back(item.row);
  rows.insert(rows.end(), rest.begin(), rest.end());
  return rows;
}

}  // namespace corral
