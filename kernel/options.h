// SPDX-License-Identifier: MIT
#pragma once

// How an options struct is known to parsers, help texts, run records and the README. Each struct lists its fields once:
//
//   struct ExampleOptions {
//     double tolerance_pr = 3;
//     template <class Self, class Visitor>
//     static void visit_fields(Self& self, Visitor&& visit) {
//       visit(OptionField{"tolerance_pr", "pr", "3", "what it does", above(0)}, self.tolerance_pr);
//     }
//   };
//
// A field is a double, an int, a std::uint64_t, a bool, or an enum that has `choice_names(Enum)` beside it.

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {

/// Accepted values of a number: low (excluded if `open`) .. high (excluded if `open_end`), and finite.
struct OptionRange {
  double low = 0;
  double high = std::numeric_limits<double>::max();
  bool open = false, open_end = false;
  bool contains(double value) const {
    return (open ? value > low : value >= low) && (open_end ? value < high : value <= high);
  }
};
inline OptionRange above(double low) { return {low, std::numeric_limits<double>::max(), true}; }
inline OptionRange at_least(double low) { return {low, std::numeric_limits<double>::max(), false}; }
inline OptionRange within(double low, double high) { return {low, high, false}; }
inline OptionRange above_up_to(double low, double high) { return {low, high, true}; }
inline OptionRange at_least_below(double low, double high) { return {low, high, false, true}; }

/// What a field means to a reader.
struct OptionField {
  const char* name;
  const char* unit;     ///< "pr", "" for a pure number or a choice
  const char* paper;    ///< value in [yang2017evaluation] Table 1, or the form it prints; "" where it has none
  const char* meaning;  ///< one line
  OptionRange range = {};
};

/// A field with its value, as text.
struct OptionValue {
  std::string name, unit, value, paper, accepted, meaning;
};

/// Changes asked for by name: name -> text.
using OptionOverrides = std::map<std::string, std::string>;

/// The same of several algorithms, by their names.
using OptionsByName = std::map<std::string, OptionOverrides>;

namespace detail {

std::string accepted_text(const OptionRange& range, bool whole_number);
std::string accepted_text(const std::vector<std::string>& choices);
[[noreturn]] void reject_option(const std::string& who, const std::string& name, const std::string& value,
                                const std::string& accepted);
[[noreturn]] void reject_unknown_option(const std::string& who, const std::string& name,
                                        const std::vector<OptionValue>& known);

template <class Enum>
std::vector<std::string> choices() {
  const auto names = choice_names(Enum{});
  return {names.begin(), names.end()};
}

template <class Value>
std::string accepted_values(const OptionField& field) {
  if constexpr (std::is_same_v<Value, bool>)
    return accepted_text({"false", "true"});
  else if constexpr (std::is_enum_v<Value>)
    return accepted_text(choices<Value>());
  else
    return accepted_text(field.range, std::is_integral_v<Value>);
}

template <class Value>
std::string value_text(const Value& value) {
  if constexpr (std::is_same_v<Value, bool>)
    return value ? "true" : "false";
  else if constexpr (std::is_enum_v<Value>)
    return choices<Value>()[static_cast<std::size_t>(value)];
  else if constexpr (std::is_integral_v<Value>)
    return std::to_string(value);
  else
    return to_text(value);
}

/// False if the text is not a value of the type (its range is checked by validate_options).
template <class Value>
bool parse_value(const std::string& text, Value& value) {
  if constexpr (std::is_same_v<Value, bool>) {
    value = text == "true";
    return text == "true" || text == "false";
  } else if constexpr (std::is_enum_v<Value>) {
    const auto names = choices<Value>();
    for (std::size_t i = 0; i < names.size(); ++i)
      if (names[i] == text) return value = static_cast<Value>(i), true;
    return false;
  } else if constexpr (std::is_same_v<Value, std::uint64_t>) {
    const auto parsed = parse_unsigned(text);
    return parsed ? (value = *parsed, true) : false;
  } else if constexpr (std::is_same_v<Value, int>) {
    const auto parsed = parse_int(text);
    if (!parsed || *parsed < std::numeric_limits<int>::min() || *parsed > std::numeric_limits<int>::max()) return false;
    return value = static_cast<int>(*parsed), true;
  } else {
    const auto parsed = parse_double(text);
    return parsed ? (value = *parsed, true) : false;
  }
}

}  // namespace detail

/// The name of an enum's value.
template <class Enum>
std::string choice_text(Enum value) {
  return detail::value_text(value);
}

/// Throws InvalidInput naming the first field that is out of its range (NaN is out of every range).
template <class Options>
void validate_options(const Options& options, const std::string& who) {
  Options::visit_fields(options, [&](const OptionField& field, const auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_arithmetic_v<Value> && !std::is_same_v<Value, bool>)
      if (!field.range.contains(static_cast<double>(value)))
        detail::reject_option(who, field.name, detail::value_text(value), detail::accepted_values<Value>(field));
  });
}

/// Every field with its present value, in order.
template <class Options>
std::vector<OptionValue> describe_options(const Options& options) {
  std::vector<OptionValue> values;
  Options::visit_fields(options, [&](const OptionField& field, const auto& value) {
    values.push_back({field.name, field.unit, detail::value_text(value), field.paper,
                      detail::accepted_values<std::decay_t<decltype(value)>>(field), field.meaning});
  });
  return values;
}

/// The defaults with the named fields replaced. Throws InvalidInput for an unknown name (listing the known ones), a text
/// that is not a value, or a value out of range.
template <class Options>
Options parse_options(const OptionOverrides& overrides, const std::string& who) {
  Options options;
  OptionOverrides unused = overrides;
  Options::visit_fields(options, [&](const OptionField& field, auto& value) {
    const auto found = unused.find(field.name);
    if (found == unused.end()) return;
    using Value = std::decay_t<decltype(value)>;
    if (!detail::parse_value(found->second, value))
      detail::reject_option(who, field.name, "'" + found->second + "'", detail::accepted_values<Value>(field));
    unused.erase(found);
  });
  if (!unused.empty()) detail::reject_unknown_option(who, unused.begin()->first, describe_options(options));
  validate_options(options, who);
  return options;
}

}  // namespace corral
