// SPDX-License-Identifier: MIT
#pragma once

namespace corral {

/// How numbers of pairs become those of a level, where the paper does not say. The defaults are those of the summaries.
struct Averaging {
  bool half_sum = false;  ///< (precision + recall) / 2 stands for F1
  bool pooled = false;    ///< the matches of all pairs of a level are counted together, instead of means over pairs
  bool leave_out_empty = false;  ///< an empty selection has no precision, instead of 0 (of means only)
};

}  // namespace corral
