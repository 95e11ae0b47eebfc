// SPDX-License-Identifier: MIT
#pragma once

// Numbers in the files of mesh formats: packed bytes or text.

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "io/line_reader.h"
#include "kernel/number_text.h"

namespace corral {

struct NumberType {
  std::size_t bytes;  ///< 1, 2, 4 or 8; 4 or 8 for floating point
  char kind;          ///< i: signed, u: unsigned, f: floating point
};

/// The number that the first `type.bytes` bytes of `raw` hold; they must be there.
inline double decode_number(const NumberType& type, const char* raw, bool big_endian = false) {
  std::array<unsigned char, 8> bytes{};
  std::uint64_t bits = 0;
  std::memcpy(bytes.data(), raw, type.bytes);
  for (std::size_t i = 0; i < type.bytes; ++i) bits = bits << 8 | bytes[big_endian ? i : type.bytes - 1 - i];
  if (type.kind == 'f' && type.bytes == 8) {
    double number;
    std::memcpy(&number, &bits, 8);
    return number;
  }
  if (type.kind == 'f') {
    const auto word = static_cast<std::uint32_t>(bits);
    float number;
    std::memcpy(&number, &word, 4);
    return number;
  }
  if (type.kind == 'u') return static_cast<double>(bits);
  const unsigned unused = 64 - 8 * static_cast<unsigned>(type.bytes);
  return static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused);  // carries the sign up
}

/// The number in a field of text, which must be in the range of the type; `name` is that of the type in a message.
inline double parse_number(const LineReader& reader, std::string_view field, const NumberType& type,
                           std::string_view name) {
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
  return static_cast<double>(reader.integer(field, low, high, "a value of type " + std::string(name)));
}

}  // namespace corral
