// SPDX-License-Identifier: MIT
// Poses in text files: matrices in rows, trajectories, logs of pairs, Stanford's .conf.
#include <algorithm>
#include <cctype>
#include <cmath>

#include "io/pose/pose_entry.h"
#include "io/text/line_reader.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

constexpr std::string_view kSeparators = " \t\r\v\f,;[](){}", kRowEnds = ";])}";

/// The numbers up to the end of a line, a semicolon or a closing bracket.
struct Row {
  std::string place;            ///< "line 7"
  std::vector<double> numbers;  ///< at least one
  std::string first;            ///< as it is written
};

/// The line without what programs print around a matrix: "T =", "np.array(" and "dtype=float32".
std::string_view without_words(std::string_view line) {
  line = line.substr(0, line.find("dtype"));
  if (line.empty() || (!std::isalpha(static_cast<unsigned char>(line.front())) && line.front() != '_')) return line;
  const std::size_t bracket = line.find('['), word = line.substr(0, bracket).find_last_of("=(");
  return word == std::string_view::npos ? line : line.substr(word + 1);
}

void add_rows(const LineReader& reader, std::vector<Row>& rows) {
  const Row empty{"line " + std::to_string(reader.line_number()), {}, ""};
  Row row = empty;
  const auto finish = [&] {
    if (!row.numbers.empty()) rows.push_back(row);
    row = empty;
  };
  std::string_view left = without_words(reader.line());
  while (!left.empty()) {
    const std::string_view field = left.substr(0, left.find_first_of(kSeparators));
    if (!field.empty()) {
      if (row.numbers.empty()) row.first = field;
      row.numbers.push_back(reader.finite_number(field));
    }
    left.remove_prefix(field.size());
    if (left.empty()) break;
    if (kRowEnds.find(left.front()) != std::string_view::npos) finish();
    left.remove_prefix(1);
  }
  finish();
}

bool is_conf_word(std::string_view word) { return word == "bmesh" || word == "mesh" || word == "camera"; }

/// The world is R(q)^T p + t: the quaternion is that of the transpose.
std::vector<PoseEntry> parse_conf(LineReader& reader) {
  std::vector<PoseEntry> entries;
  do {
    const std::vector<std::string_view> fields = reader.fields();
    if (!is_conf_word(fields[0])) reader.fail("found " + quoted(fields[0]) + ", expected bmesh, mesh or camera");
    if (fields[0] == "camera") continue;  // of a picture, not of a scan
    if (fields.size() != 9)
      reader.fail("has " + std::to_string(fields.size()) + " fields, expected bmesh FILE tx ty tz qx qy qz qw");
    PoseEntry entry{std::string(fields[1]), "", "", "line " + std::to_string(reader.line_number()), {}};
    for (std::size_t i = 2; i < 9; ++i) {
      const double number = reader.finite_number(fields[i]);
      entry.numbers.push_back(i >= 5 && i < 8 ? -number : number);
    }
    entries.push_back(entry);
  } while (reader.next());
  return entries;
}

/// The number of a fragment in the header of a log, as a name.
std::string fragment(const std::string& path, const Row& header, std::size_t column) {
  const double number = header.numbers[column];
  if (!(number >= 0 && number < 1e9) || number != std::floor(number))
    throw IoError(path, header.place,
                  "found " + to_text(number) + " as a fragment, expected the numbers of two and their count");
  return std::to_string(static_cast<long long>(number));
}

std::vector<PoseEntry> parse_log(const std::string& path, const std::vector<Row>& rows) {
  std::vector<PoseEntry> entries;
  for (std::size_t i = 0; i < rows.size(); i += 5) {
    for (std::size_t row = i; row < i + 5; ++row) {
      const std::size_t expected = row == i ? 3 : 4;
      const std::string what = row == i ? "two fragments and their count" : "a row of a 4x4 matrix";
      if (row >= rows.size()) throw IoError(path, rows.back().place, "the file ends after it, expected " + what);
      if (rows[row].numbers.size() != expected)
        throw IoError(path, rows[row].place,
                      "has " + std::to_string(rows[row].numbers.size()) + " numbers, expected " + what);
    }
    const std::string target = fragment(path, rows[i], 0), source = fragment(path, rows[i], 1);
    PoseEntry entry{source, target == source ? "" : target, "", rows[i].place, {}};
    for (std::size_t row = i + 1; row < i + 5; ++row)
      entry.numbers.insert(entry.numbers.end(), rows[row].numbers.begin(), rows[row].numbers.end());
    entries.push_back(entry);
  }
  return entries;
}

bool has_unit_length(const double* numbers) {
  return std::abs(Eigen::Map<const Eigen::Vector4d>(numbers).norm() - 1) < 0.01;
}

/// Rows of seven numbers have no convention of their own: the quaternion is where all of them have unit length.
bool is_quaternion_first(const std::vector<Row>& rows) {
  const auto all = [&](std::size_t at) {
    return std::all_of(rows.begin(), rows.end(), [&](const Row& row) { return has_unit_length(&row.numbers[at]); });
  };
  return all(0) && !all(3);
}

void order_seven(PoseEntry& entry, bool is_quaternion_first) {
  std::vector<double>& n = entry.numbers;
  if (is_quaternion_first) {
    n = {n[4], n[5], n[6], n[1], n[2], n[3], n[0]};
    entry.notes.push_back("7 numbers are read as a quaternion w x y z and a translation");
  } else {
    entry.notes.push_back("7 numbers are read as a translation and a quaternion x y z w");
  }
}

/// A pose in each row.
std::vector<PoseEntry> parse_trajectory(const std::vector<Row>& rows) {
  std::vector<PoseEntry> entries;
  const bool first = rows[0].numbers.size() == 7 && is_quaternion_first(rows);
  for (const Row& row : rows) {
    PoseEntry entry{std::to_string(entries.size()), "", "", rows.size() > 1 ? row.place : "", row.numbers};
    if (row.numbers.size() == 8) {
      entry.source = row.first;
      entry.numbers.erase(entry.numbers.begin());
    }
    if (row.numbers.size() == 7) order_seven(entry, first);
    entries.push_back(entry);
  }
  return entries;
}

std::vector<PoseEntry> parse_rows(const std::string& path, const std::vector<Row>& rows) {
  const std::size_t width = rows.empty() ? 0 : rows[0].numbers.size();
  const bool is_even =
      std::all_of(rows.begin(), rows.end(), [&](const Row& row) { return row.numbers.size() == width; });
  if (width == 3 && rows.size() > 1 && rows[1].numbers.size() == 4) return parse_log(path, rows);
  if (is_even && (width == 7 || width == 8 || width == 12 || width == 16)) return parse_trajectory(rows);
  PoseEntry entry;
  for (const Row& row : rows) entry.numbers.insert(entry.numbers.end(), row.numbers.begin(), row.numbers.end());
  const std::size_t count = entry.numbers.size();
  if (is_even && width == 3 && count == 12)
    throw IoError(path, "",
                  "found 4 rows of 3 numbers, expected 3 rows of 4: the matrix is transposed, its translation stands "
                  "in the last row");
  if (count != 16 && count != 12)
    throw IoError(path, "",
                  "found " + std::to_string(count) + " numbers in " + std::to_string(rows.size()) +
                      " rows, expected the 16 of a 4x4 matrix, the 12 of a 3x4 matrix, or a pose in each row");
  return {entry};
}

}  // namespace

std::vector<PoseEntry> parse_poses(const std::string& path, const std::string& content) {
  const std::size_t begin = content.find_first_not_of(" \t\r\n\xEF\xBB\xBF"), end = content.find_last_not_of(" \t\r");
  if (begin == std::string::npos) throw IoError(path, "", "the file is empty, expected a pose");
  if (content[begin] == '{') {
    const std::size_t next = content.find_first_not_of(" \t\r\n", begin + 1);
    if (next != std::string::npos && (content[next] == '"' || content[next] == '}'))
      return parse_pose_json(path, content);
  }
  const std::string whole = content + "\n";
  LineReader reader(path, whole, '#');
  std::vector<PoseEntry> entries;
  std::vector<Row> rows;
  while (reader.next()) {
    if (rows.empty() && is_conf_word(reader.fields()[0])) {
      entries = parse_conf(reader);
      break;
    }
    if (reader.line().front() != '%') add_rows(reader, rows);
  }
  if (entries.empty()) entries = parse_rows(path, rows);
  // The last row of a 4x4 matrix is 0 0 0 1, so that a number which is cut short is noticed; elsewhere it may go unseen.
  const bool ends_in_number = std::isdigit(static_cast<unsigned char>(content[end])) || content[end] == '.';
  if (ends_in_number && entries.back().numbers.size() != 16)
    entries.back().notes.push_back("the last line has no newline: if the file was cut short, its last number is wrong");
  return entries;
}

}  // namespace corral
