// SPDX-License-Identifier: MIT
#include "io/mesh/pcd_header.h"

#include <algorithm>
#include <array>
#include <set>

#include "io/mesh/mesh_file.h"

namespace corral {
namespace {

using Values = std::vector<std::string_view>;

/// The entries of the header, each on a line of its own, in the order that the format prescribes.
class Entries {
 public:
  explicit Entries(LineReader& reader) : reader_(reader) {}

  /// Whether the next entry is this one.
  bool is(const std::string& keyword) {
    if (!here_) reader_.need("the entry " + keyword);
    here_ = true;
    return reader_.fields()[0] == keyword;
  }
  /// The values of the entry that must come next.
  const Values& take(const std::string& keyword) {
    if (!is(keyword)) reader_.fail("found " + quoted(reader_.line()) + ", expected the entry " + keyword);
    here_ = false;
    const Values& fields = reader_.fields();
    values_.assign(fields.begin() + 1, fields.end());
    return values_;
  }
  const Values& take(const std::string& keyword, std::size_t count) {
    if (take(keyword).size() != count)
      reader_.fail(keyword + " has " + std::to_string(values_.size()) + " values, expected " + std::to_string(count));
    return values_;
  }
  std::int64_t take_count(const std::string& keyword) {
    return reader_.integer(take(keyword, 1)[0], 0, kMaximumCount, keyword);
  }

 private:
  LineReader& reader_;
  Values values_;
  bool here_ = false;  // the reader is at an entry that has not been consumed yet
};

/// Files of version .5, and those that name none, need not say more than the names of the fields and the number of points.
bool is_old(Entries& entries, const LineReader& reader) {
  if (!entries.is("VERSION") && (entries.is("FIELDS") || entries.is("COLUMNS"))) return true;
  const std::string_view version = entries.take("VERSION", 1)[0];
  for (const std::string_view known : {"0.7", ".7", "0.6", ".6"})
    if (version == known) return false;
  if (version == "0.5" || version == ".5") return true;
  reader.fail("found the version " + quoted(version) + ", expected 0.7, 0.6 or 0.5");
}

std::vector<PcdField> parse_fields(const LineReader& reader, const Values& names) {
  std::vector<PcdField> fields(names.size());
  std::set<std::string_view> seen;
  for (std::size_t i = 0; i < names.size(); ++i) {
    fields[i].name = names[i];
    // Gaps between the fields of a point all have the same name.
    if (!seen.insert(names[i]).second && names[i] != "_") reader.fail("field " + quoted(names[i]) + " occurs twice");
  }
  int axis = 0;
  for (const std::string_view wanted : {"x", "y", "z", "normal_x", "normal_y", "normal_z"}) {
    const auto place = std::find(names.begin(), names.end(), wanted);
    if (place != names.end())
      fields[static_cast<std::size_t>(place - names.begin())].axis = axis;
    else if (axis < 3)
      reader.fail("field " + quoted(wanted) + " is missing, expected fields x, y and z");
    ++axis;
  }
  return fields;
}

void parse_types(Entries& entries, const LineReader& reader, bool is_old, std::vector<PcdField>& fields) {
  const Values sizes = is_old && !entries.is("SIZE") ? Values(fields.size(), "4") : entries.take("SIZE", fields.size());
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (sizes[i] != "1" && sizes[i] != "2" && sizes[i] != "4" && sizes[i] != "8")
      reader.fail("the size of field " + quoted(fields[i].name) + " is " + quoted(sizes[i]) +
                  ", expected 1, 2, 4 or 8 bytes");
    fields[i].type.bytes = static_cast<std::size_t>(sizes[i][0] - '0');
  }
  const Values types = is_old && !entries.is("TYPE") ? Values(fields.size(), "F") : entries.take("TYPE", fields.size());
  for (std::size_t i = 0; i < fields.size(); ++i) {
    fields[i].type_name = std::string(types[i]) + std::string(sizes[i]);
    if (types[i] == "F" && fields[i].type.bytes < 4)
      reader.fail("field " + quoted(fields[i].name) + " is of floating point with " + std::string(sizes[i]) +
                  " bytes, expected 4 or 8");
    if (types[i] != "I" && types[i] != "U" && types[i] != "F")
      reader.fail("the type of field " + quoted(fields[i].name) + " is " + quoted(types[i]) + ", expected I, U or F");
    fields[i].type.kind = types[i] == "I" ? 'i' : types[i] == "U" ? 'u' : 'f';
  }
}

void parse_counts(const LineReader& reader, const Values& counts, std::vector<PcdField>& fields) {
  std::int64_t bytes = 0;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    PcdField& field = fields[i];
    field.count = reader.integer(counts[i], 1, kMaximumCount, "the count of field " + quoted(field.name));
    if (field.count > 1 && field.axis >= 0)
      reader.fail("the count of field " + quoted(field.name) + " is " + std::to_string(field.count) + ", expected 1");
    bytes += field.count * static_cast<std::int64_t>(field.type.bytes);
    if (bytes > kMaximumCount) reader.fail("a point takes more bytes than can be counted");
  }
}

PcdEncoding parse_encoding(const LineReader& reader, std::string_view encoding) {
  if (encoding == "ascii") return PcdEncoding::Ascii;
  if (encoding == "binary") return PcdEncoding::Binary;
  if (encoding == "binary_compressed") return PcdEncoding::Compressed;
  reader.fail("found the data " + quoted(encoding) + ", expected ascii, binary or binary_compressed");
}

/// tx ty tz qw qx qy qz. A file that knows nothing of the sensor has the default, at the origin without a turn.
std::optional<Eigen::Vector3d> parse_viewpoint(const LineReader& reader, const Values& values) {
  std::array<double, 7> pose;
  std::transform(values.begin(), values.end(), pose.begin(), [&](auto value) { return reader.finite_number(value); });
  if (pose == std::array<double, 7>{0, 0, 0, 1, 0, 0, 0}) return std::nullopt;
  return Eigen::Vector3d(pose[0], pose[1], pose[2]);
}

}  // namespace

bool PcdHeader::has_normals() const {
  return std::count_if(fields.begin(), fields.end(), [](const PcdField& field) { return field.axis >= 3; }) == 3;
}

std::size_t PcdHeader::values_per_point() const {
  std::size_t values = 0;
  for (const PcdField& field : fields) values += static_cast<std::size_t>(field.count);
  return values;
}

std::size_t PcdHeader::bytes_per_point() const {
  std::size_t bytes = 0;
  for (const PcdField& field : fields) bytes += static_cast<std::size_t>(field.count) * field.type.bytes;
  return bytes;
}

PcdHeader parse_pcd_header(LineReader& reader) {
  PcdHeader header;
  Entries entries(reader);
  const bool old = is_old(entries, reader);
  header.fields = parse_fields(reader, entries.take(old && entries.is("COLUMNS") ? "COLUMNS" : "FIELDS"));
  parse_types(entries, reader, old, header.fields);
  if (entries.is("COUNT")) parse_counts(reader, entries.take("COUNT", header.fields.size()), header.fields);
  const std::int64_t width = entries.take_count("WIDTH");
  const std::int64_t height = old && !entries.is("HEIGHT") ? 1 : entries.take_count("HEIGHT");
  // The pose of the sensor is not applied: points are read as they are. Version 0.6 does not have it.
  if (entries.is("VIEWPOINT")) header.sensor = parse_viewpoint(reader, entries.take("VIEWPOINT", 7));
  header.points = old && !entries.is("POINTS") ? width * height : entries.take_count("POINTS");
  if (header.points != width * height || header.points > kMaximumCount)
    reader.fail("POINTS is " + std::to_string(header.points) + ", expected WIDTH x HEIGHT, " + std::to_string(width) +
                " x " + std::to_string(height));
  header.encoding = parse_encoding(reader, entries.take("DATA", 1)[0]);
  return header;
}

}  // namespace corral
