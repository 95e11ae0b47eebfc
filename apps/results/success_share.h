// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "apps/results/level_table.h"

namespace corral {

/// A share of pairs with its Wilson interval of 95 %.
struct SuccessShare {
  double success = 0;
  int pairs = 0;
  double low = 0, high = 1;
};
SuccessShare success_share(const RowNumbers& success);  ///< over those that have a number

/// Bins of the share of correct matches, by their upper ends in per cent; the first begins at 0, the last holds its end too.
extern const std::vector<double> kCorrectShares;
std::size_t correct_share_bin(double share);  ///< of a share of 0 to 1
std::string correct_share_text(std::size_t bin);

}  // namespace corral
