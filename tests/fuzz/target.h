// SPDX-License-Identifier: MIT
#pragma once

// What the fuzzers call: a reader or an algorithm, fed with bytes. IoError and InvalidInput refuse them, which is an answer; anything
// else that is thrown, and a promise that does not hold, is a finding.

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace corral::fuzz {

struct Target {
  const char* name = "";
  void (*run)(const std::string& bytes) = nullptr;
};

const std::vector<Target>& file_targets();
const std::vector<Target>& study_targets();
const std::vector<Target>& grouper_targets();
const std::vector<Target>& surface_targets();
const std::vector<Target>& view_targets();

inline void require(bool holds, const char* promise) {
  if (holds) return;
  std::fprintf(stderr, "broken: %s\n", promise);
  std::abort();
}

/// A file with these bytes, for readers that take a path; there is one of each name.
inline std::string in_file(std::string_view bytes, const std::string& name) {
  static const std::string folder = [] {
    std::string path = "/dev/shm/corral_fuzz_XXXXXX";
    require(::mkdtemp(path.data()) != nullptr, "there is a folder for files");
    return path;
  }();
  std::ofstream(folder + "/" + name, std::ios::binary) << bytes;
  return folder + "/" + name;
}

/// Bytes as choices and numbers; zeros when they have come to an end.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : bytes_(bytes) {}

  template <class Value>
  Value take() {
    Value value{};
    const std::size_t count = std::min(sizeof value, bytes_.size());
    std::memcpy(&value, bytes_.data(), count);
    bytes_.remove_prefix(count);
    return value;
  }
  int below(int count) { return take<unsigned char>() % count; }

  /// Most of them small multiples of 1/4, where ties and equal points are; some of any size, few of none.
  double coordinate() {
    const int kind = below(64);
    if (kind == 0) return take<double>();
    if (kind < 16) return take<float>();
    return take<signed char>() / 4.0;
  }
  /// The same, but so that lengths, scaled by 1024 or squared, are numbers.
  double moderate() {
    const double value = coordinate();
    return value > -1e6 && value < 1e6 && !(value > -1e-6 && value < 1e-6) ? value : 0;
  }
  bool is_empty() const { return bytes_.empty(); }

 private:
  std::string_view bytes_;
};

}  // namespace corral::fuzz
