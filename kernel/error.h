// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

namespace corral {

/// A value that a function cannot work with: says who refuses, which field, what it holds and what is accepted.
class InvalidInput : public std::invalid_argument {
 public:
  InvalidInput(const std::string& who, const std::string& field, const std::string& value, const std::string& accepted);
  /// The same for a number, written so that reading it back gives the same double.
  InvalidInput(const std::string& who, const std::string& field, double value, const std::string& accepted);
};

/// Throws InvalidInput unless the value is finite and above zero.
void require_positive(const std::string& who, const std::string& field, double value);

/// A file that cannot be read or written: names the file, the place in it (may be empty) and what was expected there.
class IoError : public std::runtime_error {
 public:
  IoError(const std::string& path, const std::string& place, const std::string& problem);
};

}  // namespace corral
