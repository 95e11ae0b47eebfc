// SPDX-License-Identifier: MIT
#pragma once

// Numbers in the files of mesh formats: packed bytes or text.

#include <cstdint>
#include <string_view>

#include "io/text/line_reader.h"

namespace corral {

struct NumberType {
  std::size_t bytes;  ///< 1, 2, 4 or 8; 4 or 8 for floating point
  char kind;          ///< i: signed, u: unsigned, f: floating point
};

/// The numbers at `first`, `first + stride`, ...: all their bytes must be there.
void decode_numbers(const NumberType& type, bool big_endian, const char* first, std::size_t stride, std::size_t count,
                    double* numbers);
/// The same for whole numbers of at most four bytes.
void decode_numbers(const NumberType& type, bool big_endian, const char* first, std::size_t stride, std::size_t count,
                    std::int64_t* numbers);

/// The number that the first `type.bytes` bytes of `raw` hold; they must be there.
inline double decode_number(const NumberType& type, const char* raw, bool big_endian = false) {
  double number;
  decode_numbers(type, big_endian, raw, 0, 1, &number);
  return number;
}

/// The number in a field of text, which must be in the range of the type; `name` is that of the type in a message.
double parse_number(const LineReader& reader, std::string_view field, const NumberType& type, std::string_view name);

}  // namespace corral
