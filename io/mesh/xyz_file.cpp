// SPDX-License-Identifier: MIT
// Lists of points: one per line; further columns (colours, normals, intensities) are not read. In front may stand a line with
// the names of the columns, and one with the number of points.
#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include "io/mesh/mesh_cleanup.h"
#include "io/text/line_reader.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

/// Without the quotes around it, in small letters.
std::string plain_name(std::string_view name) {
  while (!name.empty() && (name.front() == '"' || name.front() == '/')) name.remove_prefix(1);
  while (!name.empty() && name.back() == '"') name.remove_suffix(1);
  std::string plain(name);
  std::transform(plain.begin(), plain.end(), plain.begin(), [](unsigned char letter) { return std::tolower(letter); });
  return plain;
}

class ListReader {
 public:
  ListReader(const std::string& path, std::string_view content) : reader_(path, content, '#') {}

  StoredMesh read() {
    read_header();
    for (bool here = read_count(); here; here = !is_full() && reader_.next()) read_point();
    if (count_ && !is_full())
      reader_.fail_at_end("point " + std::to_string(points()) + " of " + std::to_string(*count_));
    if (numbers_.empty()) reader_.fail("no point, expected lines like '0 0 0'");
    StoredMesh cloud;
    cloud.vertices = points_of_rows(numbers_);
    if (count_) note_ending(reader_, "point", cloud.notes);
    return cleaned(std::move(cloud));
  }

 private:
  std::int64_t points() const { return static_cast<std::int64_t>(numbers_.size() / 3); }
  bool is_full() const { return count_ && points() == *count_; }

  /// A line that contains a semicolon or else a comma is separated by it: a decimal comma then gives fields that are not
  /// numbers.
  const std::vector<std::string_view>& columns() {
    for (const char separator : {';', ','})
      if (reader_.line().find(separator) != std::string_view::npos) return reader_.fields(separator);
    return reader_.fields();
  }

  /// Leaves the reader at the first line behind the names, if there is one: fields that begin with a letter and are no
  /// numbers. They say where x, y and z are, or else these are the first three columns.
  void read_header() {
    if (!reader_.next()) return;
    std::vector<std::string> names;
    for (const std::string_view field : columns()) {
      if (field == "//") continue;
      names.push_back(plain_name(field));
      if (names.back().empty() || !std::isalpha(static_cast<unsigned char>(names.back()[0])) || parse_double(field))
        return;
    }
    if (names.size() < 3) return;
    int known = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string name(1, "xyz"[axis]), other = "points:" + std::string(1, "012"[axis]);  // as ParaView writes it
      const auto place = std::find_if(names.begin(), names.end(),
                                      [&](const std::string& found) { return found == name || found == other; });
      if (place == names.end()) continue;
      axes_[axis] = static_cast<std::size_t>(place - names.begin());
      ++known;
    }
    if (known == 1 || known == 2)
      reader_.fail("found " + quoted(reader_.line()) + ", expected columns named x, y and z");
    reader_.next();
  }

  /// Whether the reader is at a point, after a line with nothing but their number.
  bool read_count() {
    if (reader_.line().empty()) return false;
    if (reader_.fields().size() > 1 || !parse_int(reader_.line())) return true;
    // The shortest line of a point takes 6 bytes ("0 0 0\n"); the last may lack its end.
    const auto bytes = static_cast<std::int64_t>(reader_.rest().size());
    count_ = reader_.integer(reader_.line(), 1, kMaximumCount, "the number of points");
    if (*count_ > (bytes + 1) / 6)
      reader_.fail("the file promises " + std::to_string(*count_) + " points, but only " + std::to_string(bytes) +
                   " bytes follow");
    numbers_.reserve(3 * static_cast<std::size_t>(*count_));
    reader_.allow_open_end();
    return reader_.next();
  }

  void read_point() {
    if (points() == kMaximumCount) reader_.fail("more points than can be counted");
    const auto& fields = columns();
    if (fields.size() <= *std::max_element(axes_.begin(), axes_.end()))
      reader_.fail("found " + quoted(reader_.line()) + ", expected at least the three coordinates of a point");
    if (width_ == 0) {
      width_ = fields.size();
      first_line_ = reader_.line_number();
    }
    if (fields.size() != width_)
      reader_.fail("found " + std::to_string(fields.size()) + " columns, expected " + std::to_string(width_) +
                   " as in line " + std::to_string(first_line_));
    for (const std::size_t column : axes_) numbers_.push_back(reader_.coordinate(fields[column]));
  }

  LineReader reader_;
  std::array<std::size_t, 3> axes_ = {0, 1, 2};
  std::size_t width_ = 0, first_line_ = 0;
  std::optional<std::int64_t> count_;
  std::vector<double> numbers_;
};

}  // namespace

StoredMesh parse_xyz(const std::string& path, std::string_view content) { return ListReader(path, content).read(); }

}  // namespace corral
