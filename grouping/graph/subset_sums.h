// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

namespace corral {

// Products of a matrix of bits with whole numbers. Only sources include this.
// Plain form  tests/support/reference/groupers.h

constexpr int kBlockColumns = 8;    ///< columns of a block, a bit each
constexpr int kBlocksTogether = 4;  ///< blocks whose sums are looked up together

/// Blocks of columns: one byte per row, the first column in the lowest bit.
struct BitBlocks {
  const std::uint8_t* bytes;
  int rows;
  std::ptrdiff_t stride;  ///< of a block, a multiple of kFloatLanes; bytes behind the last row count nowhere
  int blocks;
};

/// sums[row] += the sum of the numbers of the columns whose bits are set in the row. Modulo 2^32; `numbers` are as many as
/// columns, `sums` as many as a stride. A block whose numbers are all 0 is not read.
void add_named(const BitBlocks& matrix, const std::int32_t* numbers, std::int32_t* sums);

}  // namespace corral
