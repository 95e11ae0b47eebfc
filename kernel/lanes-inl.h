// SPDX-License-Identifier: MIT
// Eight doubles, or sixteen floats, that are added, compared and selected together, in as many registers as the machine
// needs. Every target of Highway computes each lane by the same IEEE operations and sums the lanes in one fixed order, so
// that results are the same to the last bit on every machine. Floats are for filters that may be wrong by a known amount.
//
// Compiled once for each target; only sources with foreach_target.h include this.
#if defined(CORRAL_KERNEL_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef CORRAL_KERNEL_LANES_INL_H
#undef CORRAL_KERNEL_LANES_INL_H
#else
#define CORRAL_KERNEL_LANES_INL_H
#endif

#include <hwy/highway.h>

#include <cstdint>
#include <type_traits>

#include "kernel/columns.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Where a comparison of registers is true.
template <class T, int kN>
struct RegisterMask {
  using Tag = hn::FixedTag<T, kN>;
  static constexpr int kCount = kN;
  hn::Mask<Tag> raw;

  /// One bit per lane, the first the lowest.
  friend HWY_INLINE unsigned bits(RegisterMask mask) {
    std::uint8_t bytes[8];
    hn::StoreMaskBits(Tag(), mask.raw, bytes);
    std::conditional_t<(kN > 8), std::uint16_t, std::uint8_t> result;
    hwy::CopyBytes<sizeof(result)>(bytes, &result);
    return result;
  }
};

/// One register.
template <class T, int kN>
struct Register {
  using Number = T;
  using Tag = hn::FixedTag<T, kN>;
  using Mask = RegisterMask<T, kN>;
  static constexpr int kCount = kN;
  hn::Vec<Tag> raw;

  static HWY_INLINE Register fill(T number) { return {hn::Set(Tag(), number)}; }
  static HWY_INLINE Register load(const T* from) { return {hn::LoadU(Tag(), from)}; }
  /// As numbers of that type, which must be able to hold them: floats rounded, whole numbers as such.
  template <class Stored>
  HWY_INLINE void store(Stored* to) const {
    const hn::Rebind<std::int32_t, Tag> integers;
    const hn::Rebind<Stored, Tag> tag;
    if constexpr (std::is_same_v<Stored, T>)
      hn::StoreU(raw, tag, to);
    else if constexpr (sizeof(Stored) == 1)
      hn::StoreU(hn::DemoteTo(tag, whole(integers)), tag, to);
    else if constexpr (std::is_same_v<Stored, std::int32_t>)
      hn::StoreU(whole(integers), tag, to);
    else
      hn::StoreU(hn::DemoteTo(tag, raw), tag, to);
  }

  /// Writes the numbers whose bits are set one behind the other, and anything behind them up to a register in all. Compress
  /// of other targets, and of doubles, reads tables that g++ copies to the stack at every call.
  HWY_INLINE void pack(unsigned which, T* to) const {
    if constexpr (HWY_TARGET == HWY_AVX3 && kN * sizeof(T) == 64) {
      const hn::Repartition<std::uint32_t, Tag> words;
      const std::uint64_t bits = sizeof(T) == 8 ? twice(which) : which;
      const auto packed = hn::CompressBits(hn::BitCast(words, raw), reinterpret_cast<const std::uint8_t*>(&bits));
      hn::StoreU(hn::BitCast(Tag(), packed), Tag(), to);
    } else {
      T numbers[kN];
      hn::StoreU(raw, Tag(), numbers);
      for (; which != 0; which &= which - 1) *to++ = numbers[hwy::Num0BitsBelowLS1Bit_Nonzero32(which)];
    }
  }

  friend HWY_INLINE Register operator+(Register a, Register b) { return {hn::Add(a.raw, b.raw)}; }
  friend HWY_INLINE Register operator-(Register a, Register b) { return {hn::Sub(a.raw, b.raw)}; }
  friend HWY_INLINE Register operator*(Register a, Register b) { return {hn::Mul(a.raw, b.raw)}; }
  friend HWY_INLINE Register operator/(Register a, Register b) { return {hn::Div(a.raw, b.raw)}; }
  friend HWY_INLINE Mask operator<(Register a, Register b) { return {hn::Lt(a.raw, b.raw)}; }
  friend HWY_INLINE Mask operator<=(Register a, Register b) { return {hn::Le(a.raw, b.raw)}; }
  friend HWY_INLINE Mask operator==(Register a, Register b) { return {hn::Eq(a.raw, b.raw)}; }
  friend HWY_INLINE Register select(Mask mask, Register a, Register b) {
    return {hn::IfThenElse(mask.raw, a.raw, b.raw)};
  }
  /// a < b ? a : b, and a < b ? b : a. The instructions of x86 do just that, also for NaN and zeros; others do not.
  friend HWY_INLINE Register smaller(Register a, Register b) {
    if constexpr (kMinIsComparison) return {hn::Min(a.raw, b.raw)};
    return select(a < b, a, b);
  }
  friend HWY_INLINE Register larger(Register a, Register b) {
    if constexpr (kMinIsComparison) return {hn::Max(b.raw, a.raw)};
    return select(a < b, b, a);
  }
  friend HWY_INLINE Register square_root(Register a) { return {hn::Sqrt(a.raw)}; }
  friend HWY_INLINE Register magnitude(Register a) { return {hn::Abs(a.raw)}; }

  /// Lane i, and lane i + half the count.
  HWY_INLINE auto low_half() const { return Register<T, kN / 2>{hn::LowerHalf(hn::Half<Tag>(), raw)}; }
  HWY_INLINE auto high_half() const { return Register<T, kN / 2>{UpperHalf(hn::Half<Tag>(), raw)}; }

 private:
  static constexpr bool kMinIsComparison = HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128;

  /// Eight bits, each twice.
  [[maybe_unused]] static HWY_INLINE std::uint64_t twice(unsigned bits) {
    bits = (bits | bits << 4) & 0x0F0F;
    bits = (bits | bits << 2) & 0x3333;
    bits = (bits | bits << 1) & 0x5555;
    return bits | bits << 1;
  }

  template <class Integers>
  HWY_INLINE auto whole(Integers integers) const {
    if constexpr (sizeof(T) == 8)
      return hn::DemoteTo(integers, raw);
    else
      return hn::ConvertTo(integers, raw);
  }
};

/// Two halves, where one register does not hold all lanes.
template <class Half>
struct MaskPair {
  static constexpr int kCount = 2 * Half::kCount;
  Half low, high;
  friend HWY_INLINE unsigned bits(MaskPair mask) { return bits(mask.low) | bits(mask.high) << Half::kCount; }
};

template <class Half>
struct Pair {
  using Number = typename Half::Number;
  using Mask = MaskPair<typename Half::Mask>;
  static constexpr int kCount = 2 * Half::kCount;
  Half low, high;

  static HWY_INLINE Pair fill(Number number) { return {Half::fill(number), Half::fill(number)}; }
  static HWY_INLINE Pair load(const Number* from) { return {Half::load(from), Half::load(from + Half::kCount)}; }
  template <class Stored>
  HWY_INLINE void store(Stored* to) const {
    low.store(to), high.store(to + Half::kCount);
  }
  HWY_INLINE void pack(unsigned which, Number* to) const {
    const unsigned of_low = which & ((1u << Half::kCount) - 1);
    low.pack(of_low, to);
    high.pack(which >> Half::kCount, to + hwy::PopCount(of_low));
  }

  friend HWY_INLINE Pair operator+(Pair a, Pair b) { return {a.low + b.low, a.high + b.high}; }
  friend HWY_INLINE Pair operator-(Pair a, Pair b) { return {a.low - b.low, a.high - b.high}; }
  friend HWY_INLINE Pair operator*(Pair a, Pair b) { return {a.low * b.low, a.high * b.high}; }
  friend HWY_INLINE Pair operator/(Pair a, Pair b) { return {a.low / b.low, a.high / b.high}; }
  friend HWY_INLINE Mask operator<(Pair a, Pair b) { return {a.low < b.low, a.high < b.high}; }
  friend HWY_INLINE Mask operator<=(Pair a, Pair b) { return {a.low <= b.low, a.high <= b.high}; }
  friend HWY_INLINE Mask operator==(Pair a, Pair b) { return {a.low == b.low, a.high == b.high}; }
  friend HWY_INLINE Pair select(Mask mask, Pair a, Pair b) {
    return {select(mask.low, a.low, b.low), select(mask.high, a.high, b.high)};
  }
  friend HWY_INLINE Pair smaller(Pair a, Pair b) { return {smaller(a.low, b.low), smaller(a.high, b.high)}; }
  friend HWY_INLINE Pair larger(Pair a, Pair b) { return {larger(a.low, b.low), larger(a.high, b.high)}; }
  friend HWY_INLINE Pair square_root(Pair a) { return {square_root(a.low), square_root(a.high)}; }
  friend HWY_INLINE Pair magnitude(Pair a) { return {magnitude(a.low), magnitude(a.high)}; }

  HWY_INLINE Half low_half() const { return low; }
  HWY_INLINE Half high_half() const { return high; }
};

/// So many numbers in the registers of the target.
template <class T, int kN, bool kFits = (kN <= static_cast<int>(HWY_LANES(T)))>
struct Registers {
  using Type = Register<T, kN>;
};
template <class T, int kN>
struct Registers<T, kN, false> {
  using Type = Pair<typename Registers<T, kN / 2>::Type>;
};

using Lanes = typename Registers<double, kLanes>::Type;       ///< eight doubles
using Floats = typename Registers<float, kFloatLanes>::Type;  ///< sixteen floats

/// The lanes added in one fixed order: lane i to lane i + half the count, until one is left.
template <class Numbers>
HWY_INLINE auto sum(Numbers values) {
  if constexpr (Numbers::kCount == 1)
    return hn::GetLane(values.raw);
  else
    return sum(values.low_half() + values.high_half());
}

/// The largest lane; none may be NaN.
template <class Numbers>
HWY_INLINE auto largest(Numbers values) {
  if constexpr (Numbers::kCount == 1)
    return hn::GetLane(values.raw);
  else
    return largest(larger(values.low_half(), values.high_half()));
}

/// The smallest lane, of equal ones the first; none may be NaN.
template <class Numbers>
HWY_INLINE auto smallest(Numbers values) {
  typename Numbers::Number v[Numbers::kCount];
  values.store(v);
  auto least = v[0];
  for (const auto value : v) least = value < least ? value : least;
  return least;
}

}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
