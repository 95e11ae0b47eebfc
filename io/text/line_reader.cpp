// SPDX-License-Identifier: MIT
#include "io/text/line_reader.h"

#include <algorithm>
#include <cmath>

#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

bool is_white(char letter) { return letter == ' ' || (letter >= '\t' && letter <= '\r'); }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_white(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_white(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace

std::string quoted(std::string_view text) {
  std::string shown = "'";
  for (const char letter : text.substr(0, 40)) shown += letter >= ' ' && letter < 127 ? letter : '?';
  return shown + (text.size() > 40 ? "...'" : "'");
}

bool is_utf16(std::string_view text) {
  const std::string_view mark = text.substr(0, 2);
  return mark == "\xFF\xFE" || mark == "\xFE\xFF";
}

LineReader::LineReader(const std::string& path, std::string_view text, char comment)
    : path_(path), text_(text), comment_(comment) {
  if (is_utf16(text))
    throw IoError(path, "byte 0", "found text in UTF-16, expected ASCII or UTF-8: save it in one of these");
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // some editors put it in front of UTF-8
  if (text_.substr(0, kByteOrderMark.size()) == kByteOrderMark) text_.remove_prefix(kByteOrderMark.size());
  newline_ = std::min(text_.find('\n'), text_.size());
  const std::size_t first_return = text_.substr(0, newline_).find('\r');
  ends_in_cr_ = first_return != std::string_view::npos && first_return + 1 != newline_;
}

/// Takes the next line of the file, whatever it holds.
void LineReader::step() {
  ++number_;
  if (newline_ < at_) newline_ = std::min(text_.find('\n', at_), text_.size());  // kept: there may be none for long
  const std::string_view before = text_.substr(at_, newline_ - at_);
  const std::size_t length = std::min(before.find('\r'), before.size()), end = at_ + length;
  line_ = before.substr(0, length);
  lacks_end_ = end == text_.size();
  const bool is_crlf = length < before.size() && end + 1 == newline_ && newline_ < text_.size() && !ends_in_cr_;
  at_ = std::min(end + (is_crlf ? 2 : 1), text_.size());
  if (comments_behind_) line_ = line_.substr(0, line_.find(comment_));
  line_ = trimmed(line_);
}

bool LineReader::next() {
  while (at_ < text_.size()) {
    step();
    if (continuations_ && !line_.empty() && line_.back() == '\\') {
      for (joined_.clear(); !line_.empty() && line_.back() == '\\' && at_ < text_.size(); step())
        joined_.append(line_.substr(0, line_.size() - 1)) += ' ';
      joined_ += line_;
      line_ = trimmed(joined_);
    }
    taken_ = 0;
    if (line_.empty()) continue;
    if (lacks_end_ && !open_end_) fail("the file ends within this line: it was cut short, or lacks its last newline");
    if (comment_ == '\0' || line_.front() != comment_) return true;
  }
  line_ = {};
  return false;
}

void LineReader::need(std::string_view expected) {
  if (!next()) fail_at_end(expected);
}

void LineReader::fail_at_end(std::string_view expected) const {
  throw IoError(path_, "line " + std::to_string(number_ + 1), "the file ends here, expected " + std::string(expected));
}

std::string_view LineReader::take() {
  while (taken_ < line_.size() && is_white(line_[taken_])) ++taken_;
  const std::size_t first = taken_;
  while (taken_ < line_.size() && !is_white(line_[taken_])) ++taken_;
  return line_.substr(first, taken_ - first);
}

const std::vector<std::string_view>& LineReader::fields() {
  fields_.clear();
  taken_ = 0;
  for (std::string_view field = take(); !field.empty(); field = take()) fields_.push_back(field);
  taken_ = 0;
  return fields_;
}

const std::vector<std::string_view>& LineReader::fields(char separator) {
  fields_.clear();
  std::string_view left = line_;
  while (true) {
    const std::size_t end = left.find(separator);
    fields_.push_back(trimmed(left.substr(0, end)));
    if (end == std::string_view::npos) return fields_;
    left.remove_prefix(end + 1);
  }
}

double LineReader::number(std::string_view field) const {
  const auto value = parse_double(field);
  if (!value) fail("found " + quoted(field) + ", expected a number");
  return *value;
}

double LineReader::finite_number(std::string_view field) const {
  const double value = number(field);
  if (!std::isfinite(value)) fail("found " + quoted(field) + ", expected a finite number");
  return value;
}

double LineReader::coordinate(std::string_view field) const {
  const double value = number(field);
  if (std::isinf(value)) fail("found " + quoted(field) + ", expected a finite number");
  return value;
}

std::int64_t LineReader::integer(std::string_view field, std::int64_t low, std::int64_t high,
                                 std::string_view what) const {
  const auto value = parse_int(field);
  if (!value || *value < low || *value > high)
    fail(std::string(what) + " is " + quoted(field) + ", expected " +
         (low < high    ? "a whole number in " + std::to_string(low) + " .. " + std::to_string(high)
          : low == high ? std::to_string(low)
                        : "none: there is no such thing"));
  return *value;
}

void LineReader::fail(const std::string& problem) const {
  throw IoError(path_, "line " + std::to_string(number_), problem);
}

}  // namespace corral
