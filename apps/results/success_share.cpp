// SPDX-License-Identifier: MIT
#include "apps/results/success_share.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "apps/results/statistics.h"
#include "kernel/number_text.h"

namespace corral {

const std::vector<double> kCorrectShares = {1, 2, 5, 10, 20, 50, 100};

SuccessShare success_share(const RowNumbers& success) {
  SuccessShare share;
  double sum = 0;
  for (const double each : success)
    if (!std::isnan(each)) sum += each, ++share.pairs;
  if (share.pairs > 0) share.success = sum / share.pairs;
  std::tie(share.low, share.high) = wilson_interval(sum, share.pairs);
  return share;
}

std::size_t correct_share_bin(double share) {
  const auto place = std::upper_bound(kCorrectShares.begin(), kCorrectShares.end() - 1, 100 * share);
  return static_cast<std::size_t>(place - kCorrectShares.begin());
}

std::string correct_share_text(std::size_t bin) {
  return to_text(bin == 0 ? 0 : kCorrectShares[bin - 1]) + " to " + to_text(kCorrectShares[bin]) + " %";
}

}  // namespace corral
