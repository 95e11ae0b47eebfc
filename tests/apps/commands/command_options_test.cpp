// SPDX-License-Identifier: MIT
#include "apps/commands/command_options.h"

#include <gtest/gtest.h>

namespace corral {
namespace {

TEST(ParseSize, ReadsNumbersWithUnits) {
  const std::vector<std::pair<std::string, std::uint64_t>> sizes = {{"0", 0},
                                                                    {"1000", 1000},
                                                                    {"7b", 7},
                                                                    {"500MB", 500000000},
                                                                    {"20GB", 20000000000},
                                                                    {"1.5GB", 1500000000},
                                                                    {"1.5gb", 1500000000},
                                                                    {"2 kB", 2000},
                                                                    {"2k", 2000},
                                                                    {"2KiB", 2048},
                                                                    {"0.5MiB", 524288},
                                                                    {"3Ti", 3298534883328}};
  for (const auto& [text, bytes] : sizes) EXPECT_EQ(parse_size(text), bytes) << text;
}

TEST(ParseSize, RefusesAllElse) {
  for (const char* text : {"", "GB", "much", "-5MB", "+5", "1e3", "5mm", "5kmb", "5ib", "5i", "1.2.3GB", ".", "nan",
                           "inf", "5GBs", "5 G B", "99999999PB", " "})
    EXPECT_FALSE(parse_size(text)) << text;
}

}  // namespace
}  // namespace corral
