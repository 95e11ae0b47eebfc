// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace corral {

/// The shortest decimal text that reads back as the same double, that of whole numbers below 10^7 in digits alone; "nan", "inf",
/// "-inf" for what is not finite.
std::string to_text(double value);

/// The whole text as a number, independent of the locale; a leading '+' is accepted. Absent if any character is left
/// over or the value does not fit the type; a double too small for one is 0. "nan" and "inf" parse as double: the caller
/// decides whether they may stand.
std::optional<double> parse_double(std::string_view text);
std::optional<std::int64_t> parse_int(std::string_view text);
std::optional<std::uint64_t> parse_unsigned(std::string_view text);

}  // namespace corral
