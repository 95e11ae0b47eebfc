// SPDX-License-Identifier: MIT
// PCD, the format of the Point Cloud Library: a text header that names the fields of a point, then the points as lines of
// text, as packed little-endian bytes, or field by field and compressed.
#include <lzf.h>

#include <array>
#include <cmath>

#include "io/mesh/mesh_cleanup.h"
#include "io/mesh/pcd_header.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

StoredMesh empty_cloud(const PcdHeader& header) {
  StoredMesh cloud;
  cloud.vertices.resize(header.points, 3);
  if (header.has_normals()) cloud.normals.resize(header.points, 3);
  cloud.sensor = header.sensor;
  return cloud;
}

/// Where the numbers of a field go; null for those that are not read.
double* column_of(StoredMesh& cloud, const PcdField& field) {
  if (field.axis < 0 || (field.axis >= 3 && cloud.normals.rows() == 0)) return nullptr;
  return field.axis < 3 ? cloud.vertices.col(field.axis).data() : cloud.normals.col(field.axis - 3).data();
}

StoredMesh read_text(const PcdHeader& header, LineReader& reader) {
  const std::size_t values = header.values_per_point(), bytes = reader.rest().size();
  // The shortest value takes two bytes: a digit and a separator. The last line may lack its end.
  if (static_cast<std::size_t>(header.points) > (bytes + 1) / (2 * values))
    reader.fail("the header promises " + std::to_string(header.points) + " points of " + std::to_string(values) +
                " values, but only " + std::to_string(bytes) + " bytes follow");
  StoredMesh cloud = empty_cloud(header);
  std::vector<double*> columns;
  for (const PcdField& field : header.fields) columns.push_back(column_of(cloud, field));
  reader.allow_open_end();
  for (std::int64_t row = 0; row < header.points; ++row) {
    if (!reader.next()) reader.fail_at_end("point " + std::to_string(row) + " of " + std::to_string(header.points));
    for (std::size_t i = 0; i < header.fields.size(); ++i) {
      const PcdField& field = header.fields[i];
      for (std::int64_t left = field.count; left > 0; --left) {
        const std::string_view text = reader.take();
        if (text.empty())
          reader.fail("found " + std::to_string(reader.fields().size()) + " values, expected " +
                      std::to_string(values));
        const bool is_coordinate = field.axis >= 0 && field.axis < 3 && field.type.kind == 'f';
        const double value =
            is_coordinate ? reader.coordinate(text) : parse_number(reader, text, field.type, field.type_name);
        if (columns[i]) columns[i][row] = value;
      }
    }
    if (!reader.take().empty())
      reader.fail("found " + std::to_string(reader.fields().size()) + " values, expected " + std::to_string(values));
  }
  note_ending(reader, "point", cloud.notes);
  return cloud;
}

/// The library's own writer pads a file: after the last point follow as many zero bytes as the header leaves free in a page
/// of memory.
bool is_page_filler(std::string_view left, std::size_t header_bytes) {
  for (const std::size_t page : {4096U, 16384U, 65536U})
    if (header_bytes + left.size() == page) return left.find_first_not_of('\0') == std::string_view::npos;
  return false;
}

/// What follows the line DATA.
class BinaryPoints {
 public:
  BinaryPoints(const std::string& path, const PcdHeader& header, std::string_view body, std::size_t header_bytes)
      : path_(path), header_(header), body_(body), header_bytes_(header_bytes) {}

  StoredMesh read() {
    const std::size_t points = static_cast<std::size_t>(header_.points), stride = header_.bytes_per_point();
    if (points > body_.size() / stride)
      throw IoError(path_, "header",
                    "promises " + std::to_string(points) + " points of " + std::to_string(stride) +
                        " bytes, but only " + std::to_string(body_.size()) + " bytes follow");
    cloud_ = empty_cloud(header_);
    std::size_t at = 0;
    for (const PcdField& field : header_.fields) {
      decode(field, body_.data() + at, stride, at);
      at += static_cast<std::size_t>(field.count) * field.type.bytes;
    }
    return finish(points * stride);
  }

  /// All values of the first field, then all of the second, and so on: compressed, behind the sizes before and after.
  StoredMesh read_compressed() {
    const std::size_t compressed = size_at(0), size = size_at(4);
    const std::string unpacked = unpack(compressed, size);
    cloud_ = empty_cloud(header_);
    std::size_t at = 0;
    for (const PcdField& field : header_.fields) {
      decode(field, unpacked.data() + at, field.type.bytes, at);
      at += static_cast<std::size_t>(header_.points * field.count) * field.type.bytes;
    }
    return finish(8 + compressed);
  }

 private:
  /// `place` is where the first number of the field is, for messages.
  void decode(const PcdField& field, const char* first, std::size_t stride, std::size_t place) {
    double* const column = column_of(cloud_, field);
    if (column == nullptr) return;
    const auto points = static_cast<std::size_t>(header_.points);
    decode_numbers(field.type, false, first, stride, points, column);
    if (field.axis >= 3) return;
    for (std::size_t row = 0; row < points; ++row)
      if (std::isinf(column[row]))
        fail(place + row * stride, "found " + to_text(column[row]) + " in point " + std::to_string(row) + " of " +
                                       std::to_string(points) + ", expected a finite coordinate");
  }

  std::size_t size_at(std::size_t place) const {
    constexpr NumberType kSize = {4, 'u'};
    if (body_.size() < 8) fail(body_.size(), "the file ends here, expected the two sizes of the compressed points");
    return static_cast<std::size_t>(decode_number(kSize, body_.data() + place));
  }

  /// The sizes are checked before there is memory for them: three bytes of LZF stand for 264 at most.
  std::string unpack(std::size_t compressed, std::size_t size) const {
    const std::size_t expected = static_cast<std::size_t>(header_.points) * header_.bytes_per_point();
    if (compressed > body_.size() - 8)
      fail(0, "promises " + std::to_string(compressed) + " compressed bytes, but only " +
                  std::to_string(body_.size() - 8) + " follow");
    if (size != expected)
      fail(4, "promises " + std::to_string(size) + " bytes of points, expected " + std::to_string(expected) +
                  " as the header says");
    if (size > 88 * compressed)
      fail(4, "promises " + std::to_string(size) + " bytes from " + std::to_string(compressed) +
                  " compressed ones, expected no more than 88 times as many");
    std::string bytes(size, '\0');
    const std::size_t found = size == 0 ? 0
                                        : lzf_decompress(body_.data() + 8, static_cast<unsigned>(compressed),
                                                         bytes.data(), static_cast<unsigned>(size));
    if (found != size)
      fail(8, "the compressed points are damaged, expected LZF data of " + std::to_string(size) + " bytes");
    return bytes;
  }

  StoredMesh finish(std::size_t used) {
    const std::string_view left = body_.substr(used);
    if (!left.empty() && !is_page_filler(left, header_bytes_))
      cloud_.notes.push_back(unread_note(left.size(), "point"));
    return std::move(cloud_);
  }

  [[noreturn]] void fail(std::size_t place, const std::string& problem) const {
    throw IoError(path_, "byte " + std::to_string(place) + " after the header", problem);
  }

  const std::string& path_;
  const PcdHeader& header_;
  std::string_view body_;
  std::size_t header_bytes_;
  StoredMesh cloud_;
};

}  // namespace

StoredMesh parse_pcd(const std::string& path, std::string_view content) {
  LineReader reader(path, content, '#');
  const PcdHeader header = parse_pcd_header(reader);
  if (header.encoding == PcdEncoding::Ascii) return cleaned(read_text(header, reader));
  const std::string_view body = reader.rest();
  BinaryPoints points(path, header, body, content.size() - body.size());
  return cleaned(header.encoding == PcdEncoding::Binary ? points.read() : points.read_compressed());
}

}  // namespace corral
