// SPDX-License-Identifier: MIT
#include "io/array/npy_file.h"

#include <algorithm>
#include <cctype>
#include <limits>

#include "io/text/line_reader.h"
#include "io/text/stored_number.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";

/// The description of an array: a Python dictionary such as {'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), }.
class Header {
 public:
  Header(const std::string& path, std::string_view text, std::size_t first) : path_(path), text_(text), first_(first) {
    expect('{');
    while (!accept('}')) {
      const std::string_view key = word();
      expect(':');
      if (key == "descr")
        read_type(word());
      else if (key == "fortran_order")
        read_order();
      else if (key == "shape")
        read_shape();
      else
        fail("found the key " + quoted(key) + ", expected descr, fortran_order and shape");
      if (!accept(',')) {
        expect('}');
        break;
      }
    }
    if (!has_type_ || !has_order_ || !has_shape_)
      fail("found " + quoted(text_) + ", expected descr, fortran_order and shape");
  }

  NumberType type{8, 'f'};
  bool big_endian = false, by_columns = false;
  std::vector<std::size_t> shape;

 private:
  void read_type(std::string_view name) {
    has_type_ = true;
    const auto bytes = name.size() == 3 ? parse_int(name.substr(2)).value_or(0) : 0;
    const char order = name.empty() ? ' ' : name[0], kind = name.size() < 2 ? ' ' : name[1];
    const bool is_order = order == '<' || order == '>' || order == '|' || order == '=';
    const bool is_whole = (kind == 'i' || kind == 'u') && (bytes == 1 || bytes == 2 || bytes == 4 || bytes == 8);
    const bool is_float = kind == 'f' && (bytes == 4 || bytes == 8);
    if (!is_order || !(is_whole || is_float || (kind == 'b' && bytes == 1)))
      fail("the numbers are of type " + quoted(name) + ", expected one of i1 i2 i4 i8 u1 u2 u4 u8 f4 f8 b1");
    big_endian = order == '>';
    type = {static_cast<std::size_t>(bytes), kind == 'b' ? 'u' : kind};
  }

  void read_order() {
    has_order_ = true;
    const std::string_view value = plain();
    if (value != "True" && value != "False") fail("fortran_order is " + quoted(value) + ", expected True or False");
    by_columns = value == "True";
  }

  void read_shape() {
    has_shape_ = true;
    expect('(');
    while (!accept(')')) {
      std::string_view length = plain();
      if (!length.empty() && length.back() == 'L') length.remove_suffix(1);  // as Python 2 wrote it
      const auto value = parse_unsigned(length);
      if (!value) fail("a length of the shape is " + quoted(length) + ", expected a whole number");
      shape.push_back(static_cast<std::size_t>(*value));
      if (!accept(',')) {
        expect(')');
        return;
      }
    }
  }

  void skip_white() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
  }
  bool accept(char letter) {
    skip_white();
    if (at_ == text_.size() || text_[at_] != letter) return false;
    ++at_;
    return true;
  }
  void expect(char letter) {
    if (!accept(letter)) fail("expected '" + std::string(1, letter) + "' in the description of the array");
  }
  /// A text in quotes.
  std::string_view word() {
    skip_white();
    const char quote = at_ < text_.size() ? text_[at_] : ' ';
    const std::size_t end = quote == '\'' || quote == '"' ? text_.find(quote, at_ + 1) : std::string_view::npos;
    if (end == std::string_view::npos) fail("expected a text in quotes: arrays of named fields are not read");
    const std::string_view text = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    return text;
  }
  std::string_view plain() {
    skip_white();
    const std::size_t first = at_;
    while (at_ < text_.size() && std::isalnum(static_cast<unsigned char>(text_[at_]))) ++at_;
    return text_.substr(first, at_ - first);
  }
  [[noreturn]] void fail(const std::string& problem) const {
    throw IoError(path_, "byte " + std::to_string(first_ + at_), problem);
  }

  const std::string& path_;
  std::string_view text_;
  std::size_t first_, at_ = 0;
  bool has_type_ = false, has_order_ = false, has_shape_ = false;
};

std::string shape_text(const std::vector<std::size_t>& shape) {
  std::string text;
  for (const std::size_t length : shape) text += (text.empty() ? "" : " x ") + std::to_string(length);
  return text.empty() ? "a single number" : text;
}

/// Rows and columns of a table of this shape. Their product can be multiplied by eight.
std::pair<std::size_t, std::size_t> table_shape(const std::string& path, std::vector<std::size_t> shape) {
  const std::string text = shape_text(shape);
  while (shape.size() > 2 && shape.front() == 1) shape.erase(shape.begin());
  if (shape.size() > 2) throw IoError(path, "", "the array is " + text + ", expected a list or a table");
  shape.resize(2, 1);  // a list is one column, a number is one row
  constexpr std::size_t kMost = std::numeric_limits<int>::max();
  if (shape[0] > kMost || shape[1] > kMost)
    throw IoError(path, "", "the array is " + text + ", more than can be counted");
  return {shape[0], shape[1]};
}

}  // namespace

StoredArray parse_npy(const std::string& path, std::string_view content) {
  const auto fail = [&](std::size_t byte, const std::string& problem) {
    throw IoError(path, "byte " + std::to_string(byte), problem);
  };
  if (content.substr(0, kMagic.size()) != kMagic)
    fail(0, "not a NumPy array, expected a file that begins with \\x93NUMPY");
  if (content.size() < 12) fail(content.size(), "the file ends here, expected the description of an array");
  const int version = static_cast<unsigned char>(content[6]);
  if (version < 1 || version > 3) fail(6, "the version is " + std::to_string(version) + ", expected 1, 2 or 3");
  const NumberType length_type{version == 1 ? std::size_t{2} : std::size_t{4}, 'u'};
  const std::size_t begin = 8 + length_type.bytes;
  const auto length = static_cast<std::size_t>(decode_number(length_type, content.data() + 8));
  if (length > content.size() - begin)
    fail(8, "the description is " + std::to_string(length) + " bytes long, but only " +
                std::to_string(content.size() - begin) + " follow");
  const Header header(path, content.substr(begin, length), begin);
  const auto [rows, columns] = table_shape(path, header.shape);
  const std::string_view body = content.substr(begin + length);
  const std::size_t room = body.size() / header.type.bytes;
  if (columns != 0 && rows > room / columns)
    fail(begin + length, "the array is " + shape_text(header.shape) + ", but only " + std::to_string(body.size()) +
                             " bytes follow, room for " + std::to_string(room) + " numbers");
  if (rows * columns * header.type.bytes != body.size())
    fail(begin + length + rows * columns * header.type.bytes, "more bytes follow, expected the end of the array");
  StoredArray array;
  array.shape = header.shape;
  array.is_whole = header.type.kind != 'f';
  array.rows.resize(static_cast<Eigen::Index>(columns), static_cast<Eigen::Index>(rows));
  if (!header.by_columns) {
    decode_numbers(header.type, header.big_endian, body.data(), header.type.bytes, rows * columns, array.rows.data());
    return array;
  }
  for (std::size_t row = 0; row < rows; ++row)
    decode_numbers(header.type, header.big_endian, body.data() + row * header.type.bytes, rows * header.type.bytes,
                   columns, array.rows.data() + row * columns);
  return array;
}

}  // namespace corral
