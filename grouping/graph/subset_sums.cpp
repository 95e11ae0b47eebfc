// SPDX-License-Identifier: MIT
#include "grouping/graph/subset_sums.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "grouping/graph/subset_sums.cpp"
#include <hwy/foreach_target.h>

#include "kernel/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

using Number = std::int32_t;

/// The sums of every subset of four numbers, that of the numbers named by the bits of i at i.
struct alignas(64) SubsetSums {
  Number at[16];
};

SubsetSums add_up(const Number* numbers) {
  SubsetSums sums{};
  for (int bit = 0; bit < 4; ++bit)
    for (int i = 0; i < 1 << bit; ++i) sums.at[(1 << bit) + i] = sums.at[i] + numbers[bit];
  return sums;
}

/// For blocks that are looked up together, and in each for the lower and the upper half of a byte.
using Tables = SubsetSums[kBlocksTogether][2];

#if HWY_CAP_GE512

/// to[row] += what the bytes of the row name in the tables. A register of indices looks up in a register of sums.
HWY_INLINE void look_up(const Tables& tables, const std::uint8_t* const (&bytes)[kBlocksTogether], int rows,
                        Number* to) {
  const hn::FixedTag<Number, 16> words;
  const hn::FixedTag<std::uint8_t, 16> names;
  hn::Vec<hn::FixedTag<Number, 16>> sums[kBlocksTogether][2];
  for (int k = 0; k < kBlocksTogether; ++k)
    for (int half = 0; half < 2; ++half) sums[k][half] = hn::Load(words, tables[k][half].at);
  const auto low = hn::Set(words, 15);
  for (int row = 0; row < rows; row += kFloatLanes) {
    auto sum = hn::LoadU(words, to + row);
    for (int k = 0; k < kBlocksTogether; ++k) {
      const auto name = hn::PromoteTo(words, hn::LoadU(names, bytes[k] + row));
      const auto lower = hn::IndicesFromVec(words, hn::And(name, low));
      const auto upper = hn::IndicesFromVec(words, hn::ShiftRight<4>(name));
      sum = hn::Add(sum, hn::Add(hn::TableLookupLanes(sums[k][0], lower), hn::TableLookupLanes(sums[k][1], upper)));
    }
    hn::StoreU(sum, words, to + row);
  }
}

#else

/// The same by a table of both halves, which stays in the cache.
HWY_INLINE void look_up(const Tables& tables, const std::uint8_t* const (&bytes)[kBlocksTogether], int rows,
                        Number* to) {
  static_assert(kBlocksTogether == 4);
  Number sums[kBlocksTogether][256];
  for (int k = 0; k < kBlocksTogether; ++k)
    for (int i = 0; i < 256; ++i) sums[k][i] = tables[k][0].at[i % 16] + tables[k][1].at[i / 16];
  for (int row = 0; row < rows; ++row)
    to[row] += sums[0][bytes[0][row]] + sums[1][bytes[1][row]] + sums[2][bytes[2][row]] + sums[3][bytes[3][row]];
}

#endif

HWY_FLATTEN void add_named(const BitBlocks& matrix, const Number* numbers, Number* sums) {
  Tables tables;
  const std::uint8_t* columns[kBlocksTogether];
  int waiting = 0;
  const auto add = [&](const std::uint8_t* bytes, const Number* of_block) HWY_ATTR {
    columns[waiting] = bytes;
    for (int half = 0; half < 2; ++half) tables[waiting][half] = add_up(of_block + 4 * half);
    if (++waiting < kBlocksTogether) return;
    look_up(tables, columns, matrix.rows, sums);
    waiting = 0;
  };
  for (int block = 0; block < matrix.blocks; ++block) {
    const Number* const of_block = numbers + kBlockColumns * block;
    if (std::any_of(of_block, of_block + kBlockColumns, [](Number each) { return each != 0; }))
      add(matrix.bytes + block * matrix.stride, of_block);
  }
  constexpr Number kNothing[kBlockColumns] = {};
  while (waiting > 0) add(matrix.bytes, kNothing);
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(add_named);

void add_named(const BitBlocks& matrix, const std::int32_t* numbers, std::int32_t* sums) {
  HWY_DYNAMIC_DISPATCH(add_named)(matrix, numbers, sums);
}

}  // namespace corral
#endif
