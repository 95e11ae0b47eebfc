// SPDX-License-Identifier: MIT
#include "kernel/error.h"

#include <cmath>

#include "kernel/number_text.h"

namespace corral {

InvalidInput::InvalidInput(const std::string& who, const std::string& field, const std::string& value,
                           const std::string& accepted)
    : std::invalid_argument(who + ": " + field + " is " + value + ", expected " + accepted) {}

InvalidInput::InvalidInput(const std::string& who, const std::string& field, double value, const std::string& accepted)
    : InvalidInput(who, field, to_text(value), accepted) {}

void require_positive(const std::string& who, const std::string& field, double value) {
  if (!(value > 0) || !std::isfinite(value)) throw InvalidInput(who, field, value, "a finite number above zero");
}

IoError::IoError(const std::string& path, const std::string& place, const std::string& problem)
    : std::runtime_error(path + (place.empty() ? ": " : ", " + place + ": ") + problem) {}

}  // namespace corral
