// SPDX-License-Identifier: MIT
#include "io/text/stored_number.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "kernel/number_text.h"

namespace corral {
namespace {

#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
constexpr bool kBigEndianHere = true;
#else
constexpr bool kBigEndianHere = false;
#endif

template <class Stored, class Number>
void decode_as(bool big_endian, const char* first, std::size_t stride, std::size_t count, Number* numbers) {
  Stored stored;
  if (big_endian == kBigEndianHere) {
    for (std::size_t i = 0; i < count; ++i, first += stride) {
      std::memcpy(&stored, first, sizeof stored);
      numbers[i] = static_cast<Number>(stored);
    }
    return;
  }
  std::array<char, sizeof(Stored)> turned;
  for (std::size_t i = 0; i < count; ++i, first += stride) {
    std::reverse_copy(first, first + sizeof stored, turned.begin());
    std::memcpy(&stored, turned.data(), sizeof stored);
    numbers[i] = static_cast<Number>(stored);
  }
}

template <class Number>
void decode(const NumberType& type, bool big_endian, const char* first, std::size_t stride, std::size_t count,
            Number* numbers) {
  const auto as = [&](auto stored) { decode_as<decltype(stored)>(big_endian, first, stride, count, numbers); };
  const bool is_signed = type.kind == 'i';
  if (type.kind == 'f') return type.bytes == 4 ? as(float()) : as(double());
  if (type.bytes == 1) return is_signed ? as(std::int8_t()) : as(std::uint8_t());
  if (type.bytes == 2) return is_signed ? as(std::int16_t()) : as(std::uint16_t());
  if (type.bytes == 4) return is_signed ? as(std::int32_t()) : as(std::uint32_t());
  return is_signed ? as(std::int64_t()) : as(std::uint64_t());
}

}  // namespace

void decode_numbers(const NumberType& type, bool big_endian, const char* first, std::size_t stride, std::size_t count,
                    double* numbers) {
  decode(type, big_endian, first, stride, count, numbers);
}

void decode_numbers(const NumberType& type, bool big_endian, const char* first, std::size_t stride, std::size_t count,
                    std::int64_t* numbers) {
  decode(type, big_endian, first, stride, count, numbers);
}

double parse_number(const LineReader& reader, std::string_view field, const NumberType& type, std::string_view name) {
  if (type.kind == 'f') return reader.number(field);
  if (type.kind == 'u' && type.bytes == 8) {
    const auto value = parse_unsigned(field);
    if (!value)
      reader.fail("a value of type " + std::string(name) + " is " + quoted(field) + ", expected a whole number from 0");
    return static_cast<double>(*value);
  }
  const std::int64_t half = std::int64_t{1}
                            << (8 * type.bytes - 2);  // half the range of one sign: the whole may not fit
  const std::int64_t low = type.kind == 'i' ? -2 * half : 0;
  const std::int64_t high = type.kind == 'i' ? 2 * (half - 1) + 1 : 4 * half - 1;
  const auto value = parse_int(field);
  if (value && *value >= low && *value <= high) return static_cast<double>(*value);
  reader.integer(field, low, high, "a value of type " + std::string(name));  // refuses it
  return 0;
}

}  // namespace corral
