// SPDX-License-Identifier: MIT
#include "kernel/all_finite.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "tests/support/execution.h"
#include "tests/support/reference/columns.h"

namespace corral {
namespace {

constexpr double kLargest = std::numeric_limits<double>::max(), kInfinity = std::numeric_limits<double>::infinity(),
                 kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(AllFinite, OneNumberAnywhereIsSeen) {
  for (const std::int64_t each : testing::available_targets()) {
    const testing::ForcedTarget forced(each);
    for (const std::size_t count : {1U, 31U, 32U, 33U, 100U})
      for (std::size_t at = 0; at < count; ++at)
        for (const double number : {kInfinity, -kInfinity, kNaN, kLargest, -kLargest}) {
          std::vector<double> numbers(count, kLargest);  // sums of these would not be finite
          numbers[at] = number;
          const auto size = static_cast<Eigen::Index>(count);
          EXPECT_EQ(all_finite(numbers.data(), size), testing::reference_all_finite(numbers.data(), size))
              << testing::target_name(each) << ", " << number << " at " << at << " of " << count;
        }
    EXPECT_TRUE(all_finite(nullptr, 0));
  }
}

}  // namespace
}  // namespace corral
