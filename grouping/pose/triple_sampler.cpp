// SPDX-License-Identifier: MIT
#include "grouping/pose/triple_sampler.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "grouping/columns/compatibility.h"

namespace corral {
namespace {

constexpr int kDraws = 10;  ///< for each match of a compatible triple

int draw(RandomStream& random, int count) { return static_cast<int>(random.below(static_cast<std::uint64_t>(count))); }

bool keeps_distance(const CorrespondenceSet& matches, int i, int j, double tolerance) {
  const PairDistances lengths = pair_distances(matches, i, j);
  return std::abs(lengths.source - lengths.target) < tolerance;
}

/// A row for this place of a triple that none before has, all equally likely.
int draw_other(RandomStream& random, int rows, const Triple& triple, std::size_t place) {
  int row = draw(random, rows - static_cast<int>(place));
  if (place == 1) return row + (row >= triple[0]);
  if (place == 2) {
    row += row >= std::min(triple[0], triple[1]);
    row += row >= std::max(triple[0], triple[1]);
  }
  return row;
}

}  // namespace

UniformSampler::UniformSampler(int rows)
    : first_(static_cast<std::uint64_t>(rows)),
      second_(static_cast<std::uint64_t>(rows - 1)),
      third_(static_cast<std::uint64_t>(rows - 2)) {}

Triple draw_compatible_triple(RandomStream& random, const CorrespondenceSet& matches, double tolerance) {
  Triple triple{draw(random, matches.size())};
  for (const std::size_t place : {1U, 2U}) {
    const auto fits = [&] {
      return std::all_of(triple.begin(), triple.begin() + place,
                         [&](int before) { return keeps_distance(matches, before, triple[place], tolerance); });
    };
    int draws = 0;
    do triple[place] = draw_other(random, matches.size(), triple, place);
    while (++draws < kDraws && !fits());
  }
  return triple;
}

ProgressiveSampler::ProgressiveSampler(const CorrespondenceSet& matches, int triples) : mean_(triples) {
  const std::vector<double> scores = ratio_scores(feature_ratios(matches));
  order_.resize(scores.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::stable_sort(order_.begin(), order_.end(), [&](int a, int b) {
    return scores[static_cast<std::size_t>(a)] > scores[static_cast<std::size_t>(b)];
  });
  for (int i = 0; i < 3; ++i) mean_ *= (3.0 - i) / (matches.size() - i);
}

Triple ProgressiveSampler::draw(RandomStream& random) {
  ++drawn_;
  while (drawn_ > last_ && taking_part_ < static_cast<int>(order_.size())) {
    const double grown = mean_ * (taking_part_ + 1) / (taking_part_ - 2);
    last_ += std::ceil(grown - mean_);
    mean_ = grown;
    ++taking_part_;
  }
  Triple triple;
  if (drawn_ > last_) {
    triple = UniformSampler(taking_part_).draw(random);
  } else {
    for (std::size_t place = 0; place < 2; ++place) triple[place] = draw_other(random, taking_part_ - 1, triple, place);
    triple[2] = taking_part_ - 1;
  }
  for (int& row : triple) row = order_[static_cast<std::size_t>(row)];
  return triple;
}

}  // namespace corral
