// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "kernel/correspondence_set.h"
#include "kernel/random.h"

namespace corral {

using Triple = std::array<int, 3>;

/// Three distinct rows of so many, every ordered triple equally likely.
class UniformSampler {
 public:
  explicit UniformSampler(int rows);

  /// Without a branch that chance decides.
  Triple draw(RandomStream& random) const {
    const int a = static_cast<int>(random.below(first_));
    int b = static_cast<int>(random.below(second_)), c = static_cast<int>(random.below(third_));
    b += b >= a;
    const int smaller = a ^ ((a ^ b) & -(b < a)), larger = a ^ b ^ smaller;
    c += c >= smaller;
    c += c >= larger;
    return {a, b, c};
  }

 private:
  WholeRange first_, second_, third_;
};

/// Three distinct rows of which the second and the third are drawn again, up to ten times each, until every distance to those
/// before differs on the two sides by less than the tolerance (mesh units).
Triple draw_compatible_triple(RandomStream& random, const CorrespondenceSet& matches, double tolerance);

/// Progressive sampling: rows by 1 - d1/d2 in descending order (ties by row), of which the first n take part,
///
///   T_3 = N prod_{i<3} (3 - i) / (M - i),   T_{n+1} = T_n (n + 1) / (n - 2),   T'_{n+1} = T'_n + ceil(T_{n+1} - T_n),  T'_3 = 1
///
/// with N triples in all: n grows when triple T'_n has been drawn. Until then the n-th row is in every triple.
/// Source    [chum2005prosac].
class ProgressiveSampler {
 public:
  ProgressiveSampler(const CorrespondenceSet& matches, int triples);
  Triple draw(RandomStream& random);

  /// Bytes for so many rows.
  static double memory(int rows) { return 28.0 * rows; }

 private:
  Indices order_;
  int drawn_ = 0, taking_part_ = 3;
  double mean_, last_ = 1;  ///< T_n, T'_n
};

}  // namespace corral
