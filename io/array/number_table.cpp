// SPDX-License-Identifier: MIT
#include "io/array/number_table.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <limits>

#include "io/array/npy_file.h"
#include "io/disk/file.h"
#include "io/text/line_reader.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

bool ends_with(const std::string& text, std::string_view ending) {
  return text.size() >= ending.size() && text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

class TextTable {
 public:
  TextTable(const std::string& path, std::string_view content) : reader_(path, content, '#') {
    reader_.allow_open_end();
    table_.path = path;
  }

  NumberTable read() {
    bool here = reader_.next();
    if (here && read_names()) here = reader_.next();
    for (; here; here = reader_.next()) read_row();
    if (table_.lines.empty()) reader_.fail_at_end("rows of numbers");
    if (reader_.lacks_end())
      table_.notes.push_back("the last line lacks its end: its last number may have lost digits");
    table_.rows = Eigen::Map<const Eigen::MatrixXd>(numbers_.data(), static_cast<Eigen::Index>(width_),
                                                    static_cast<Eigen::Index>(table_.lines.size()));
    return std::move(table_);
  }

 private:
  /// A line with a semicolon or else a comma is separated by it; one at its end separates nothing, unless the names say so.
  const std::vector<std::string_view>& fields() {
    for (const char separator : {';', ','}) {
      if (reader_.line().find(separator) == std::string_view::npos) continue;
      fields_ = reader_.fields(separator);
      if (fields_.size() > 1 && fields_.back().empty() && fields_.size() != table_.names.size()) fields_.pop_back();
      return fields_;
    }
    return fields_ = reader_.fields();
  }

  /// Whether the line holds names: a field that begins with a letter and is no number.
  bool read_names() {
    const auto is_name = [](std::string_view field) {
      return !field.empty() && (std::isalpha(static_cast<unsigned char>(field[0])) || field[0] == '"') &&
             !parse_double(field);
    };
    if (!std::any_of(fields().begin(), fields().end(), is_name)) return false;
    for (const std::string_view field : fields_) {
      std::string name;
      for (const char letter : field)
        if (letter != '"') name += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
      table_.names.push_back(std::move(name));
    }
    width_ = fields_.size();
    return true;
  }

  void read_row() {
    fields();
    if (width_ == 0) width_ = fields_.size();
    if (fields_.size() != width_)
      reader_.fail("found " + std::to_string(fields_.size()) + " fields, expected " + std::to_string(width_) +
                   " as in the first row");
    for (const std::string_view field : fields_) {
      const bool is_missing = field.empty() && !table_.names.empty();  // as pandas writes a nan
      numbers_.push_back(is_missing ? std::numeric_limits<double>::quiet_NaN() : reader_.number(field));
    }
    table_.lines.push_back(static_cast<int>(reader_.line_number()));
  }

  LineReader reader_;
  NumberTable table_;
  std::vector<std::string_view> fields_;
  std::size_t width_ = 0;
  std::vector<double> numbers_;
};

}  // namespace

std::string NumberTable::place(int row) const {
  return lines.empty() ? "row " + std::to_string(row) : "line " + std::to_string(lines[static_cast<std::size_t>(row)]);
}

void NumberTable::fail(int row, const std::string& problem) const { throw IoError(path, place(row), problem); }

ArrayName split_array_name(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || !ends_with(text.substr(0, colon), ".npz") || std::filesystem::exists(text))
    return {text, ""};
  return {text.substr(0, colon), text.substr(colon + 1)};
}

NumberTable read_number_table(const std::string& name) {
  const ArrayName array = split_array_name(name);
  const std::string content = read_file(array.file);
  if (content.empty()) throw IoError(array.file, "", "the file is empty, expected rows of numbers");
  const bool is_npz = ends_with(array.file, ".npz");
  if (!is_npz && !ends_with(array.file, ".npy")) return TextTable(array.file, content).read();
  NumberTable table;
  table.path = name;
  table.rows = (is_npz ? parse_npz(array.file, content, array.name) : parse_npy(array.file, content)).rows;
  if (table.rows.size() == 0) throw IoError(name, "", "the array is empty, expected rows of numbers");
  return table;
}

NumberTable with_width(NumberTable table, int width, const std::string& what) {
  const bool lies = table.size() == width && table.width() != width && table.names.empty();
  if (lies) {
    table.rows = Eigen::MatrixXd(table.rows.transpose());
    table.lines.clear();
    table.notes.push_back(what + " are read as columns: the file has " + std::to_string(width) + " rows of " +
                          std::to_string(table.size()));
  } else if (table.size() == width) {
    table.notes.push_back(what + " are read as rows: the file has as many rows as columns");
  }
  if (table.width() < width)
    table.fail(
        0, "found " + std::to_string(table.width()) + " numbers, expected " + std::to_string(width) + " of " + what);
  return table;
}

}  // namespace corral
