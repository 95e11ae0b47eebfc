// SPDX-License-Identifier: MIT
#pragma once

// PLY files for tests, in all three encodings from one description.

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "kernel/number_text.h"

namespace corral::testing {

inline const std::array<std::string, 3> kPlyFormats = {"ascii", "binary_little_endian", "binary_big_endian"};

/// One value and its type: b h i signed of 1 2 4 bytes, B H I unsigned, f d floating point.
struct PlyValue {
  char type;
  double value;
};
using PlyRow = std::vector<PlyValue>;

inline std::string raw_bytes(std::uint64_t bits, std::size_t bytes, bool big_endian) {
  std::string raw(bytes, '\0');
  for (std::size_t i = 0; i < bytes; ++i)
    raw[big_endian ? bytes - 1 - i : i] = static_cast<char>(static_cast<unsigned char>(bits >> (8 * i)));
  return raw;
}

inline std::string encode(const PlyValue& value, bool big_endian) {
  std::uint64_t bits = 0;
  switch (value.type) {
    case 'f': {
      const auto number = static_cast<float>(value.value);
      std::memcpy(&bits, &number, 4);
      bits &= 0xffffffffU;  // the lower half on a little-endian machine
      return raw_bytes(bits, 4, big_endian);
    }
    case 'd':
      std::memcpy(&bits, &value.value, 8);
      return raw_bytes(bits, 8, big_endian);
    default:
      break;
  }
  bits = static_cast<std::uint64_t>(static_cast<std::int64_t>(value.value));
  const std::size_t bytes = value.type == 'b' || value.type == 'B' ? 1 : value.type == 'h' || value.type == 'H' ? 2 : 4;
  return raw_bytes(bits, bytes, big_endian);
}

inline std::string ply_text(const PlyValue& value) {
  const bool is_whole = value.type != 'f' && value.type != 'd';
  return is_whole ? std::to_string(static_cast<std::int64_t>(value.value)) : to_text(value.value);
}

/// The body of a file: one line of text per row, or its packed bytes.
inline std::string ply_body(const std::string& format, const std::vector<PlyRow>& rows) {
  std::string body;
  for (const PlyRow& row : rows) {
    for (const PlyValue& value : row)
      body += format == "ascii" ? ply_text(value) + " " : encode(value, format == "binary_big_endian");
    if (format == "ascii") body.back() = '\n';
  }
  return body;
}

/// A whole file; `declarations` are the lines of the header after the format.
inline std::string ply_file(const std::string& format, const std::string& declarations,
                            const std::vector<PlyRow>& rows) {
  return "ply\nformat " + format + " 1.0\n" + declarations + "end_header\n" + ply_body(format, rows);
}

/// A square of float vertices with one quad.
inline std::string square_ply(const std::string& format) {
  return ply_file(format,
                  "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                  "element face 1\nproperty list uchar int vertex_indices\n",
                  {{{'f', 0}, {'f', 0}, {'f', 0.5}},
                   {{'f', 1}, {'f', 0}, {'f', 0.5}},
                   {{'f', 1}, {'f', 1}, {'f', 0.5}},
                   {{'f', 0}, {'f', 1}, {'f', 0.5}},
                   {{'B', 4}, {'i', 0}, {'i', 1}, {'i', 2}, {'i', 3}}});
}

/// Everything the format allows: comments, extra elements before, between and after, lists in them, vertex properties
/// of any type in any order around the coordinates, faces with extra properties and corners of any whole type.
inline std::string intricate_ply(const std::string& format) {
  return ply_file(
      format,
      "comment made by hand\nobj_info more of it\n"
      "element camera 2\nproperty double focal\nproperty list uchar short pixels\n"
      "element vertex 4\nproperty uchar red\nproperty double z\nproperty list ushort float weights\n"
      "property float x\nproperty int8 quality\nproperty short y\n"
      "element strip 1\nproperty list int int16 strips\n"
      "element face 2\nproperty uint32 flags\nproperty list uint ushort vertex_index\nproperty float32 area\n"
      "element edge 1\nproperty int vertex1\nproperty uint vertex2\n",
      {{{'d', 35.5}, {'B', 2}, {'h', -7}, {'h', 300}},
       {{'d', 50}, {'B', 0}},
       {{'B', 255}, {'d', 0.1}, {'H', 1}, {'f', 0.5}, {'f', 1.5}, {'b', -128}, {'h', -300}},
       {{'B', 0}, {'d', 0.2}, {'H', 0}, {'f', 2.5}, {'b', 127}, {'h', 300}},
       {{'B', 1}, {'d', -0.3}, {'H', 2}, {'f', 1}, {'f', 2}, {'f', 3.5}, {'b', 0}, {'h', 32767}},
       {{'B', 2}, {'d', 1e300}, {'H', 0}, {'f', 4.5}, {'b', 1}, {'h', -32768}},
       {{'i', 3}, {'h', 0}, {'h', 1}, {'h', -1}},
       {{'I', 4294967295.0}, {'I', 4}, {'H', 0}, {'H', 1}, {'H', 2}, {'H', 3}, {'f', 1}},
       {{'I', 0}, {'I', 3}, {'H', 3}, {'H', 1}, {'H', 0}, {'f', 2}},
       {{'i', -1}, {'I', 4000000000.0}}});
}

}  // namespace corral::testing
