// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace corral {

/// Reads a text file line by line and converts fields to numbers; every error is an IoError that names the file and the
/// line. A line ends at LF, CRLF or CR. A last line without its end is an error: 1.2 could be 1.25 cut short.
class LineReader {
 public:
  /// Both must outlive the reader. Lines starting with `comment` are skipped, as are blank ones ('\0': no comments). Throws
  /// IoError if is_utf16(text).
  LineReader(const std::string& path, std::string_view text, char comment = '\0');

  /// Formats that differ: `comment` also ends a line behind other text; a line that ends in '\' goes on in the next one; the
  /// last line may lack its end (where the format says how much it holds).
  void allow_comments_behind() { comments_behind_ = true; }
  void allow_continuations() { continuations_ = true; }
  void allow_open_end() { open_end_ = true; }

  /// Moves to the next line that is neither blank nor a comment; false at the end of the file.
  bool next();
  /// The same where a line must follow; `expected` describes it in the message.
  void need(std::string_view expected);
  [[noreturn]] void fail_at_end(std::string_view expected) const;  ///< what need() throws

  std::string_view line() const { return line_; }                    ///< without its end and white space around
  std::size_t line_number() const { return number_; }                ///< of line(), from 1
  std::string_view rest() const { return text_.substr(at_); }        ///< what follows line()
  bool lacks_end() const { return lacks_end_; }                      ///< line() was the last, without its end
  std::string_view take();                                           ///< the next field of line(); empty at its end
  void skip_letters(std::size_t count) { taken_ = count; }           ///< of line(), for take()
  std::string_view untaken() const { return line_.substr(taken_); }  ///< what take() has left of line()

  /// line() split at white space, or at each occurrence of `separator`.
  const std::vector<std::string_view>& fields();
  const std::vector<std::string_view>& fields(char separator);

  double number(std::string_view field) const;  ///< may be "nan" or "inf"
  double finite_number(std::string_view field) const;
  double coordinate(std::string_view field) const;  ///< finite, or nan: a missing point
  /// A whole number in low .. high.
  std::int64_t integer(std::string_view field, std::int64_t low, std::int64_t high, std::string_view what) const;

  [[noreturn]] void fail(const std::string& problem) const;

 private:
  void step();

  const std::string& path_;
  std::string_view text_, line_;
  char comment_;
  bool comments_behind_ = false, continuations_ = false, open_end_ = false, lacks_end_ = false;
  bool ends_in_cr_ = false;  // the first line does: then LF ends another line, or begins binary data
  std::size_t at_ = 0, newline_ = 0, taken_ = 0, number_ = 0;
  std::vector<std::string_view> fields_;
  std::string joined_;  // a line with its continuations
};

/// Whether a text begins with a mark of UTF-16, as Windows writes it: no reader here takes it.
bool is_utf16(std::string_view text);

/// Text from a file in quotes, shortened and made printable for a message.
std::string quoted(std::string_view text);

}  // namespace corral
