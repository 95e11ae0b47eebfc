// SPDX-License-Identifier: MIT
// Lists of points: one per line; further columns (colours, intensities) are not read. In front may stand a line with the names
// of the columns, and one with the number of points.
#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>
#include <limits>
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

/// Names of a column that counts the points; pandas has none for it.
bool is_counter(const std::string& name) {
  static constexpr const char* kNames[] = {"",   "id", "idx",   "index",   "unnamed: 0",
                                           "no", "nr", "point", "pointid", "point_id"};
  return std::find(std::begin(kNames), std::end(kNames), name) != std::end(kNames);
}

/// Where in `names` those of three columns stand, each under one of its two names; -1 where it does not.
std::array<int, 3> places_of(const std::array<std::array<const char*, 2>, 3>& wanted,
                             const std::vector<std::string>& names) {
  std::array<int, 3> places;
  std::transform(wanted.begin(), wanted.end(), places.begin(), [&](const auto& either) {
    const auto found = std::find_if(names.begin(), names.end(),
                                    [&](const std::string& name) { return name == either[0] || name == either[1]; });
    return found == names.end() ? -1 : static_cast<int>(found - names.begin());
  });
  return places;
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
    if (has_normals_) cloud.normals = points_of_rows(normals_);
    if (!note_.empty()) cloud.notes.push_back(note_);
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
  /// numbers; the first may be empty.
  void read_header() {
    if (!reader_.next()) return;
    for (const std::string_view field : columns()) {
      if (field == "//") continue;
      const std::string name = plain_name(field);
      const bool is_name = !name.empty() && std::isalpha(static_cast<unsigned char>(name[0])) && !parse_double(field);
      if (!is_name && !(name.empty() && names_.empty())) {
        names_.clear();
        return;
      }
      names_.push_back(name);
    }
    if (names_.size() < 3) {
      names_.clear();
      return;
    }
    find_columns();
    reader_.next();
  }

  /// The names say where x, y and z are, or else these are the first three columns that do not count the points; and where the
  /// normals are.
  void find_columns() {
    const auto axes = places_of({{{"x", "points:0"}, {"y", "points:1"}, {"z", "points:2"}}}, names_);  // of ParaView
    const auto unknown = std::count(axes.begin(), axes.end(), -1);
    const std::size_t first = is_counter(names_[0]) ? 1 : 0;
    if (unknown == 1 || unknown == 2 || names_.size() < first + 3)
      reader_.fail("found " + quoted(reader_.line()) + ", expected columns named x, y and z");
    for (std::size_t axis = 0; axis < 3; ++axis)
      axes_[axis] = unknown == 0 ? static_cast<std::size_t>(axes[axis]) : first + axis;
    if (unknown > 0)
      note_ = "the columns named " + quoted(names_[first]) + ", " + quoted(names_[first + 1]) + " and " +
              quoted(names_[first + 2]) + " are read as x, y and z";
    const auto normals = places_of({{{"nx", "normals:0"}, {"ny", "normals:1"}, {"nz", "normals:2"}}}, names_);
    has_normals_ = std::count(normals.begin(), normals.end(), -1) == 0;
    for (std::size_t axis = 0; axis < 3 && has_normals_; ++axis)
      normal_axes_[axis] = static_cast<std::size_t>(normals[axis]);
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
    if (has_normals_ && fields.size() <= *std::max_element(normal_axes_.begin(), normal_axes_.end()))
      reader_.fail("found " + quoted(reader_.line()) + ", expected a normal as the names say");
    if (!names_.empty() && fields.size() == names_.size() + 1 &&
        !fields.back().empty())  // R names no column of row names
      reader_.fail("found " + std::to_string(fields.size()) + " columns, expected " + std::to_string(names_.size()) +
                   " as there are names: which of them has none is not known");
    if (width_ == 0) {
      width_ = fields.size();
      first_line_ = reader_.line_number();
    }
    if (fields.size() != width_)
      reader_.fail("found " + std::to_string(fields.size()) + " columns, expected " + std::to_string(width_) +
                   " as in line " + std::to_string(first_line_));
    for (const std::size_t column : axes_) numbers_.push_back(coordinate(fields[column]));
    for (std::size_t axis = 0; axis < 3 && has_normals_; ++axis) normals_.push_back(number(fields[normal_axes_[axis]]));
  }

  /// In a table with names, as pandas writes it, an empty cell is a missing number; without, a decimal comma may be to blame.
  bool is_missing(std::string_view field) const { return field.empty() && !names_.empty(); }
  double coordinate(std::string_view field) const { return is_missing(field) ? kMissing : reader_.coordinate(field); }
  double number(std::string_view field) const { return is_missing(field) ? kMissing : reader_.number(field); }

  LineReader reader_;
  static constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::string> names_;  // of the columns; empty where the file has none
  std::string note_;
  std::array<std::size_t, 3> axes_ = {0, 1, 2}, normal_axes_ = {};
  bool has_normals_ = false;
  std::size_t width_ = 0, first_line_ = 0;
  std::optional<std::int64_t> count_;
  std::vector<double> numbers_, normals_;
};

}  // namespace

StoredMesh parse_xyz(const std::string& path, std::string_view content) { return ListReader(path, content).read(); }

}  // namespace corral
