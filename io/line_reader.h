// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace corral {

/// Reads a text file line by line and converts fields to numbers; every error is an IoError that names the file and the
/// line. A last line without a newline is an error: 1.2 could be 1.25 cut short.
class LineReader {
 public:
  /// Both must outlive the reader. Lines starting with `comment` are skipped, as are blank ones ('\0': no comments).
  LineReader(const std::string& path, std::string_view text, char comment = '\0');

  /// Moves to the next line that is neither blank nor a comment; false at the end of the file.
  bool next();
  /// The same where a line must follow; `expected` describes it in the message.
  void need(const std::string& expected);

  std::string_view line() const { return line_; }      ///< without its end and without white space around
  std::size_t line_number() const { return number_; }  ///< of line(), from 1
  std::string_view rest() const { return text_; }      ///< what follows line()

  /// line() split at white space, or at each occurrence of `separator`.
  const std::vector<std::string_view>& fields();
  const std::vector<std::string_view>& fields(char separator);

  double number(std::string_view field) const;  ///< may be "nan" or "inf"
  double finite_number(std::string_view field) const;
  /// A whole number in low .. high.
  std::int64_t integer(std::string_view field, std::int64_t low, std::int64_t high, const std::string& what) const;

  [[noreturn]] void fail(const std::string& problem) const;

 private:
  const std::string& path_;
  std::string_view text_, line_;
  char comment_;
  std::size_t number_ = 0;
  std::vector<std::string_view> fields_;
};

/// Text from a file in quotes, shortened and made printable for a message.
std::string quoted(std::string_view text);

}  // namespace corral
