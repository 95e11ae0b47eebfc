// SPDX-License-Identifier: MIT
#include "io/line_reader.h"

#include <cmath>

#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

constexpr std::string_view kWhite = " \t\r\v\f";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kWhite);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kWhite) - first + 1);
}

}  // namespace

std::string quoted(std::string_view text) {
  std::string shown = "'";
  for (const char letter : text.substr(0, 40)) shown += letter >= ' ' && letter < 127 ? letter : '?';
  return shown + (text.size() > 40 ? "...'" : "'");
}

LineReader::LineReader(const std::string& path, std::string_view text, char comment)
    : path_(path), text_(text), comment_(comment) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // some editors put it in front of UTF-8
  if (text_.substr(0, kByteOrderMark.size()) == kByteOrderMark) text_.remove_prefix(kByteOrderMark.size());
}

bool LineReader::next() {
  while (!text_.empty()) {
    ++number_;
    const std::size_t end = text_.find('\n');
    line_ = trimmed(text_.substr(0, end));
    if (end == std::string_view::npos) {
      text_ = {};
      if (line_.empty()) return false;
      fail("the file ends within this line: it was cut short, or lacks its last newline");
    }
    text_.remove_prefix(end + 1);
    if (!line_.empty() && (comment_ == '\0' || line_.front() != comment_)) return true;
  }
  line_ = {};
  return false;
}

void LineReader::need(const std::string& expected) {
  if (!next()) throw IoError(path_, "line " + std::to_string(number_ + 1), "the file ends here, expected " + expected);
}

const std::vector<std::string_view>& LineReader::fields() {
  fields_.clear();
  std::string_view left = line_;
  while (!left.empty()) {
    const std::size_t end = left.find_first_of(kWhite);
    fields_.push_back(left.substr(0, end));
    if (end == std::string_view::npos) break;
    left.remove_prefix(std::min(left.find_first_not_of(kWhite, end), left.size()));
  }
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

std::int64_t LineReader::integer(std::string_view field, std::int64_t low, std::int64_t high,
                                 const std::string& what) const {
  const auto value = parse_int(field);
  if (!value || *value < low || *value > high)
    fail(what + " is " + quoted(field) + ", expected " +
         (low < high    ? "a whole number in " + std::to_string(low) + " .. " + std::to_string(high)
          : low == high ? std::to_string(low)
                        : "none: there is no such thing"));
  return *value;
}

void LineReader::fail(const std::string& problem) const {
  throw IoError(path_, "line " + std::to_string(number_), problem);
}

}  // namespace corral
