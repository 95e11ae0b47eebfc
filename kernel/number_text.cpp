// SPDX-License-Identifier: MIT
#include "kernel/number_text.h"

#include <charconv>
#include <cmath>

namespace corral {
namespace {

/// Whether a decimal number that fits no double is too small for it rather than too large.
bool is_below_one(std::string_view text) {
  const std::size_t exponent = text.find_first_of("eE");
  if (exponent != std::string_view::npos) return text.find('-', exponent) != std::string_view::npos;
  return text.find_first_of("123456789") > text.find('.');
}

template <class Number>
std::optional<Number> parse_whole(std::string_view text) {
  // std::from_chars knows no leading '+', though printf("%+g") writes one.
  if (text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+') text.remove_prefix(1);
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, status] = std::from_chars(text.data(), end, value);
  if constexpr (std::is_floating_point_v<Number>) {
    // A magnitude below the smallest denormal is zero to a reader of meshes; one above the largest double is an error.
    if (status == std::errc::result_out_of_range && stop == end && is_below_one(text)) return 0.0;
  }
  if (status != std::errc() || stop != end) return std::nullopt;
  return value;
}

}  // namespace

std::string to_text(double value) {
  char buffer[32];
  const bool is_count = value == std::floor(value) && std::abs(value) < 1e7;
  const auto result = is_count ? std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed)
                               : std::to_chars(buffer, buffer + sizeof buffer, value);
  return std::string(buffer, result.ptr);
}

std::optional<double> parse_double(std::string_view text) { return parse_whole<double>(text); }
std::optional<std::int64_t> parse_int(std::string_view text) { return parse_whole<std::int64_t>(text); }
std::optional<std::uint64_t> parse_unsigned(std::string_view text) { return parse_whole<std::uint64_t>(text); }

}  // namespace corral
