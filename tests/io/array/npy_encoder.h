// SPDX-License-Identifier: MIT
#pragma once

// Arrays as numpy writes them, and archives of them, byte by byte.

#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "io/disk/inflate.h"

namespace corral::testing {

/// `bytes` of a number, the lowest first.
inline std::string little(std::uint64_t number, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(number >> (8 * i));
  return text;
}

/// The numbers as they lie in memory (of a little-endian machine).
template <class Number>
std::string raw(const std::vector<double>& numbers) {
  std::string text;
  for (const double number : numbers) {
    const auto stored = static_cast<Number>(number);
    char bytes[sizeof stored];
    std::memcpy(bytes, &stored, sizeof stored);
    text.append(bytes, sizeof stored);
  }
  return text;
}

inline std::string npy_of(const std::string& header, const std::string& body, int version = 1) {
  return "\x93NUMPY" + std::string(1, static_cast<char>(version)) + std::string(1, '\0') +
         little(header.size(), version == 1 ? 2 : 4) + header + body;
}

inline std::string npy_header(const std::string& type, const std::string& shape, bool by_columns = false) {
  return "{'descr': '" + type + "', 'fortran_order': " + (by_columns ? "True" : "False") + ", 'shape': " + shape +
         ", }          \n";
}

/// Doubles, row by row.
inline std::string npy(const std::string& shape, const std::vector<double>& numbers) {
  return npy_of(npy_header("<f8", shape), raw<double>(numbers));
}

struct ZipMember {
  std::string name, content;
  std::string deflated = {};  ///< the compressed content; empty: stored
};

inline std::string zip(const std::vector<ZipMember>& members) {
  std::string body, list;
  for (const ZipMember& member : members) {
    const std::string& data = member.deflated.empty() ? member.content : member.deflated;
    const std::string common = little(member.deflated.empty() ? 0 : 8, 2) + little(0, 4) +
                               little(checksum_of(member.content), 4) + little(data.size(), 4) +
                               little(member.content.size(), 4) + little(member.name.size(), 2);
    list += "PK\1\2" + little(20, 2) + little(20, 2) + little(0, 2) + common + little(0, 2) + little(0, 2) +
            little(0, 2) + little(0, 2) + little(0, 4) + little(body.size(), 4) + member.name;
    body += "PK\3\4" + little(20, 2) + little(0, 2) + common + little(0, 2) + member.name + data;
  }
  return body + list + "PK\5\6" + little(0, 4) + little(members.size(), 2) + little(members.size(), 2) +
         little(list.size(), 4) + little(body.size(), 4) + little(0, 2);
}

/// Arrays by name, stored.
inline std::string npz(const std::vector<std::pair<std::string, std::string>>& arrays) {
  std::vector<ZipMember> members;
  for (const auto& [name, content] : arrays) members.push_back({name + ".npy", content});
  return zip(members);
}

}  // namespace corral::testing
