// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <optional>

namespace corral {

/// A number that may be absent, in the room of a double: a study has a hundred million of them. NaN is absent.
class OptionalNumber {
 public:
  OptionalNumber() = default;
  OptionalNumber(std::nullopt_t) {}
  OptionalNumber(double number) : number_(number) {}
  OptionalNumber(const std::optional<double>& number) : number_(number.value_or(kAbsent)) {}

  bool has_value() const { return number_ == number_; }
  explicit operator bool() const { return has_value(); }
  double operator*() const { return number_; }  ///< NaN if absent
  double value_or(double other) const { return has_value() ? number_ : other; }
  bool operator==(const OptionalNumber& other) const {
    return number_ == other.number_ || (!has_value() && !other.has_value());
  }
  bool operator!=(const OptionalNumber& other) const { return !(*this == other); }
  operator std::optional<double>() const { return has_value() ? std::optional<double>(number_) : std::nullopt; }

 private:
  static constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

  double number_ = kAbsent;
};

}  // namespace corral
