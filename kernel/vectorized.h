// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <new>
#include <type_traits>
#include <vector>

namespace corral {

/// The vector registers that hot loops use.
enum class VectorLevel { Baseline, Avx2, Avx512 };

/// The best that this machine has, unless a lower one was forced.
VectorLevel vector_level();

/// From now on no better than this, in all threads (tests compare the levels). Never what the machine lacks.
void force_vector_level(VectorLevel level);

// Eight doubles that are added, compared and selected together, in as many registers as the machine needs. Every level
// computes each lane by the same IEEE operations (nothing is contracted) and sums the lanes in one fixed order, so that
// results are the same to the last bit on every machine. Beside them sixteen floats, for filters that may be wrong by a
// known amount.

namespace lanes {

#define CORRAL_INLINE inline __attribute__((always_inline))

using Double2 [[gnu::vector_size(16)]] = double;
using Double4 [[gnu::vector_size(32)]] = double;
using Double8 [[gnu::vector_size(64)]] = double;
using Float4 [[gnu::vector_size(16)]] = float;
using Float8 [[gnu::vector_size(32)]] = float;
using Float16 [[gnu::vector_size(64)]] = float;
using Integers2 [[gnu::vector_size(8)]] = std::int32_t;
using Integers4 [[gnu::vector_size(16)]] = std::int32_t;
using Integers8 [[gnu::vector_size(32)]] = std::int32_t;
using Integers16 [[gnu::vector_size(64)]] = std::int32_t;

/// A comparison of registers, made where it is used: compilers keep it in a mask register then, and nowhere else.
enum class Order { Less, LessEqual, Equal };
template <Order kOrder, class Numbers>
struct Comparison {
  static constexpr int kCount = sizeof(Numbers) / sizeof(Numbers{}[0]);
  Numbers a, b;
  CORRAL_INLINE Numbers choose(Numbers yes, Numbers no) const {
    if constexpr (kOrder == Order::Less)
      return a < b ? yes : no;
    else if constexpr (kOrder == Order::LessEqual)
      return a <= b ? yes : no;
    else
      return a == b ? yes : no;
  }
};

/// One register.
template <class Numbers, class Integers>
struct Register {
  using Number = std::remove_reference_t<decltype(Numbers{}[0])>;
  static constexpr int kCount = sizeof(Numbers) / sizeof(Number);
  Numbers value;

  static CORRAL_INLINE Register fill(Number number) {
    if (sizeof(Numbers) == 16 || __builtin_constant_p(number)) return {number - Numbers{}};
    Register result;  // left alone, g++ 12 sets lane by lane in inner loops
    if constexpr (sizeof(Number) == 4)
      asm("vbroadcastss %1, %0" : "=v"(result.value) : "vm"(number));
    else
      asm("vbroadcastsd %1, %0" : "=v"(result.value) : "vm"(number));
    return result;
  }
  static CORRAL_INLINE Register load(const Number* from) {
    Register result;
    __builtin_memcpy(&result.value, from, sizeof(Numbers));
    return result;
  }
  /// As numbers of that type, which must be able to hold them: floats rounded, whole numbers as such.
  template <class Stored>
  CORRAL_INLINE void store(Stored* to) const {
    using Vector [[gnu::vector_size(kCount * sizeof(Stored))]] = Stored;
    Vector stored;
    if constexpr (sizeof(Stored) == 1)
      stored = __builtin_convertvector(__builtin_convertvector(value, Integers), Vector);
    else
      stored = __builtin_convertvector(value, Vector);
    __builtin_memcpy(to, &stored, sizeof(Vector));
  }

  /// Writes the numbers whose bits are set one behind the other, and anything behind them up to a register in all.
  CORRAL_INLINE void pack(unsigned which, Number* to) const {
    if constexpr (sizeof(Numbers) == 64 && sizeof(Number) == 4) {
      Register packed;
      asm("vcompressps %1, %0%{%2%}%{z%}" : "=v"(packed.value) : "v"(value), "Yk"(static_cast<std::uint16_t>(which)));
      packed.store(to);
    } else {
      Number numbers[kCount];
      store(numbers);
      for (; which != 0; which &= which - 1) *to++ = numbers[__builtin_ctz(which)];
    }
  }

  friend CORRAL_INLINE Register operator+(Register a, Register b) { return {a.value + b.value}; }
  friend CORRAL_INLINE Register operator-(Register a, Register b) { return {a.value - b.value}; }
  friend CORRAL_INLINE Register operator*(Register a, Register b) { return {a.value * b.value}; }
  friend CORRAL_INLINE Register operator/(Register a, Register b) { return {a.value / b.value}; }
  friend CORRAL_INLINE Comparison<Order::Less, Numbers> operator<(Register a, Register b) { return {a.value, b.value}; }
  friend CORRAL_INLINE Comparison<Order::LessEqual, Numbers> operator<=(Register a, Register b) {
    return {a.value, b.value};
  }
  friend CORRAL_INLINE Comparison<Order::Equal, Numbers> operator==(Register a, Register b) {
    return {a.value, b.value};
  }
  template <Order kOrder>
  friend CORRAL_INLINE Register select(Comparison<kOrder, Numbers> mask, Register a, Register b) {
    return {mask.choose(a.value, b.value)};
  }
  friend CORRAL_INLINE Register smaller(Register a, Register b) { return {a.value < b.value ? a.value : b.value}; }
  friend CORRAL_INLINE Register larger(Register a, Register b) { return {a.value < b.value ? b.value : a.value}; }
  friend CORRAL_INLINE Register square_root(Register a) {
    Number numbers[kCount];
    a.store(numbers);
    for (Number& number : numbers) number = __builtin_sqrt(number);
    return load(numbers);
  }
  friend CORRAL_INLINE Register magnitude(Register a) { return {a.value < 0 ? -a.value : a.value}; }
  /// Lane i added to lane i + half the count.
  CORRAL_INLINE auto folded() const {
    if constexpr (kCount == 16)
      return Register<Float8, Integers8>{__builtin_shufflevector(value, value, 0, 1, 2, 3, 4, 5, 6, 7) +
                                         __builtin_shufflevector(value, value, 8, 9, 10, 11, 12, 13, 14, 15)};
    else if constexpr (kCount == 8)
      return Register<std::conditional_t<sizeof(Number) == 4, Float4, Double4>, Integers4>{
          __builtin_shufflevector(value, value, 0, 1, 2, 3) + __builtin_shufflevector(value, value, 4, 5, 6, 7)};
    else if constexpr (kCount == 4)
      return Register<Double2, Integers2>{__builtin_shufflevector(value, value, 0, 1) +
                                          __builtin_shufflevector(value, value, 2, 3)};
    else
      return value[0] + value[1];
  }
};

template <class Half>
struct ComparisonPair {
  static constexpr int kCount = 2 * Half::kCount;
  Half low, high;
};

/// Where a comparison is true: one bit per lane, the first the lowest. Compilers have no word for it.
template <Order kOrder, class Numbers>
CORRAL_INLINE unsigned bits(Comparison<kOrder, Numbers> mask) {
  constexpr bool kFloats = mask.kCount * 4 == sizeof(Numbers);
  unsigned result;
  if constexpr (sizeof(Numbers) == 64) {
    constexpr int kPredicate = kOrder == Order::Less ? 1 : kOrder == Order::LessEqual ? 2 : 0;
    std::uint16_t found;
    if constexpr (kFloats)
      asm("vcmpps %3, %2, %1, %0" : "=k"(found) : "v"(mask.a), "vm"(mask.b), "i"(kPredicate));
    else
      asm("vcmppd %3, %2, %1, %0" : "=k"(found) : "v"(mask.a), "vm"(mask.b), "i"(kPredicate));
    result = found;
  } else {
    const Numbers yes = reinterpret_cast<Numbers>(kOrder == Order::Less        ? mask.a < mask.b
                                                  : kOrder == Order::LessEqual ? mask.a <= mask.b
                                                                               : mask.a == mask.b);
    if constexpr (sizeof(Numbers) == 32 && kFloats)
      asm("vmovmskps %1, %0" : "=r"(result) : "x"(yes));
    else if constexpr (sizeof(Numbers) == 32)
      asm("vmovmskpd %1, %0" : "=r"(result) : "x"(yes));
    else if constexpr (kFloats)
      asm("movmskps %1, %0" : "=r"(result) : "x"(yes));
    else
      asm("movmskpd %1, %0" : "=r"(result) : "x"(yes));
  }
  return result;
}
template <class Half>
CORRAL_INLINE unsigned bits(ComparisonPair<Half> mask) {
  return bits(mask.low) | bits(mask.high) << Half::kCount;
}

/// Two halves, where one register does not hold all lanes.
template <class Half>
struct Pair {
  static constexpr int kCount = 2 * Half::kCount;
  Half low, high;

  using Number = typename Half::Number;

  static CORRAL_INLINE Pair fill(Number number) { return {Half::fill(number), Half::fill(number)}; }
  static CORRAL_INLINE Pair load(const Number* from) { return {Half::load(from), Half::load(from + Half::kCount)}; }
  template <class Stored>
  CORRAL_INLINE void store(Stored* to) const {
    low.store(to), high.store(to + Half::kCount);
  }

  CORRAL_INLINE void pack(unsigned which, Number* to) const {
    low.pack(which & ((1u << Half::kCount) - 1), to);
    high.pack(which >> Half::kCount, to + __builtin_popcount(which & ((1u << Half::kCount) - 1)));
  }

  friend CORRAL_INLINE Pair operator+(Pair a, Pair b) { return {a.low + b.low, a.high + b.high}; }
  friend CORRAL_INLINE Pair operator-(Pair a, Pair b) { return {a.low - b.low, a.high - b.high}; }
  friend CORRAL_INLINE Pair operator*(Pair a, Pair b) { return {a.low * b.low, a.high * b.high}; }
  friend CORRAL_INLINE Pair operator/(Pair a, Pair b) { return {a.low / b.low, a.high / b.high}; }
  friend CORRAL_INLINE auto operator<(Pair a, Pair b) {
    return ComparisonPair<decltype(a.low < b.low)>{a.low < b.low, a.high < b.high};
  }
  friend CORRAL_INLINE auto operator<=(Pair a, Pair b) {
    return ComparisonPair<decltype(a.low <= b.low)>{a.low <= b.low, a.high <= b.high};
  }
  friend CORRAL_INLINE auto operator==(Pair a, Pair b) {
    return ComparisonPair<decltype(a.low == b.low)>{a.low == b.low, a.high == b.high};
  }
  template <class Mask>
  friend CORRAL_INLINE Pair select(ComparisonPair<Mask> mask, Pair a, Pair b) {
    return {select(mask.low, a.low, b.low), select(mask.high, a.high, b.high)};
  }
  friend CORRAL_INLINE Pair smaller(Pair a, Pair b) { return {smaller(a.low, b.low), smaller(a.high, b.high)}; }
  friend CORRAL_INLINE Pair larger(Pair a, Pair b) { return {larger(a.low, b.low), larger(a.high, b.high)}; }
  friend CORRAL_INLINE Pair square_root(Pair a) { return {square_root(a.low), square_root(a.high)}; }
  friend CORRAL_INLINE Pair magnitude(Pair a) { return {magnitude(a.low), magnitude(a.high)}; }
  CORRAL_INLINE Half folded() const { return low + high; }
};

using Lanes8 = Register<Double8, Integers8>;
using Lanes4x2 = Pair<Register<Double4, Integers4>>;
using Lanes2x4 = Pair<Pair<Register<Double2, Integers2>>>;
using Floats16 = Register<Float16, Integers16>;
using Floats8x2 = Pair<Register<Float8, Integers8>>;
using Floats4x4 = Pair<Pair<Register<Float4, Integers4>>>;

/// The eight lanes added in one fixed order.
template <class Lanes>
CORRAL_INLINE double sum(Lanes values) {
  return values.folded().folded().folded();
}

/// The smallest lane; none may be NaN.
template <class Lanes>
CORRAL_INLINE double smallest(Lanes values) {
  double v[8];
  values.store(v);
  double least = v[0];
  for (const double value : v) least = value < least ? value : least;
  return least;
}

/// Tells a body which lanes to use.
template <class L, class F>
struct Kind {
  using Lanes = L;   ///< eight doubles
  using Floats = F;  ///< sixteen floats
};

template <class Body>
[[gnu::target("arch=x86-64-v4,prefer-vector-width=512"), gnu::flatten, gnu::noinline]] void run_avx512(Body& body) {
  body(Kind<Lanes8, Floats16>{});
}
template <class Body>
[[gnu::target("arch=x86-64-v3"), gnu::flatten, gnu::noinline]] void run_avx2(Body& body) {
  body(Kind<Lanes4x2, Floats8x2>{});
}
template <class Body>
[[gnu::flatten, gnu::noinline]] void run_baseline(Body& body) {
  body(Kind<Lanes2x4, Floats4x4>{});
}

}  // namespace lanes

/// Numbers of lanes: columns that hot loops read are padded to a multiple of them.
constexpr int kLanes = 8, kFloatLanes = 16;

constexpr int padded(int count, int lanes = kLanes) { return (count + lanes - 1) / lanes * lanes; }

/// Starts every column at a cache line, so that no lane load straddles two.
template <class T>
struct CacheLineAllocator {
  using value_type = T;
  CacheLineAllocator() = default;
  template <class Other>
  CacheLineAllocator(const CacheLineAllocator<Other>&) {}
  T* allocate(std::size_t count) { return static_cast<T*>(::operator new (count * sizeof(T), std::align_val_t{64})); }
  void deallocate(T* from, std::size_t) { ::operator delete (from, std::align_val_t{64}); }
  friend bool operator==(CacheLineAllocator, CacheLineAllocator) { return true; }
  friend bool operator!=(CacheLineAllocator, CacheLineAllocator) { return false; }
};
using AlignedColumn = std::vector<double, CacheLineAllocator<double>>;
using FloatColumn = std::vector<float, CacheLineAllocator<float>>;

/// Runs a body compiled for the vector level of this machine; it does its arithmetic in the lanes that it is given:
///
///   vectorized([&](auto kind) {
///     using Lanes = typename decltype(kind)::Lanes;
///     ... Lanes::load(x) + Lanes::fill(1) ...
///   });
template <class Body>
void vectorized(Body&& body) {
  switch (vector_level()) {
    case VectorLevel::Avx512:
      return lanes::run_avx512(body);
    case VectorLevel::Avx2:
      return lanes::run_avx2(body);
    case VectorLevel::Baseline:
      return lanes::run_baseline(body);
  }
}

}  // namespace corral
