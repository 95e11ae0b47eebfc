// SPDX-License-Identifier: MIT
#include "kernel/options.h"

namespace corral::detail {

std::string accepted_text(const OptionRange& range, bool whole_number) {
  const std::string kind = whole_number ? "a whole number" : "a finite number";
  const std::string low = (range.open ? " above " : " of at least ") + to_text(range.low);
  if (range.high == std::numeric_limits<double>::max()) return kind + low;
  return kind + low + (range.open_end ? " and below " : " and at most ") + to_text(range.high);
}

std::string accepted_text(const std::vector<std::string>& choices) {
  std::string text;
  for (const std::string& choice : choices) text += (text.empty() ? "" : "|") + choice;
  return text;
}

void reject_option(const std::string& who, const std::string& name, const std::string& value,
                   const std::string& accepted) {
  throw InvalidInput(who, "option " + name, value, accepted);
}

void reject_unknown_option(const std::string& who, const std::string& name, const std::vector<OptionValue>& known) {
  std::vector<std::string> names;
  for (const OptionValue& option : known) names.push_back(option.name);
  throw InvalidInput(who, "option name", "'" + name + "'", names.empty() ? "no options" : accepted_text(names));
}

}  // namespace corral::detail
