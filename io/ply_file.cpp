// SPDX-License-Identifier: MIT
// PLY: a text header that names elements and their properties, then the elements as lines of text or as packed bytes.
#include <cmath>

#include "io/mesh_file.h"
#include "io/ply_header.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

/// The values of a text body, one element per line.
class TextBody {
 public:
  TextBody(const std::string&, LineReader& reader) : reader_(reader) {}

  /// The fewest bytes that an element can take: a digit and a separator per property.
  static std::size_t smallest(const PlyElement& element) { return 2 * element.properties.size(); }
  std::size_t bytes_left() const { return reader_.rest().size(); }

  void begin(const PlyElement& element, std::int64_t row) {
    reader_.need("element " + quoted(element.name) + " " + std::to_string(row) + " of " +
                 std::to_string(element.count));
    fields_ = &reader_.fields();
    next_ = 0;
  }
  double value(const PlyType& type) {
    if (next_ == fields_->size()) fail("found " + std::to_string(next_) + " values, expected more");
    return parse_number(reader_, (*fields_)[next_++], type, type.name);
  }
  std::size_t values_left() const { return fields_->size() - next_; }
  void end() {
    if (next_ < fields_->size())
      fail("found " + std::to_string(fields_->size()) + " values, expected " + std::to_string(next_));
  }
  void finish() {
    if (reader_.next())
      fail("found " + quoted(reader_.line()) + " after the last element, expected the end of the file");
  }
  [[noreturn]] void fail(const std::string& problem) const { reader_.fail(problem); }

 private:
  LineReader& reader_;
  const std::vector<std::string_view>* fields_ = nullptr;
  std::size_t next_ = 0;
};

/// The values of a binary body.
template <bool kBigEndian>
class BinaryBody {
 public:
  BinaryBody(const std::string& path, LineReader& reader) : path_(path), all_(reader.rest()), left_(all_) {}

  static std::size_t smallest(const PlyElement& element) {
    std::size_t bytes = 0;
    for (const PlyProperty& property : element.properties)
      bytes += (property.count_type ? property.count_type : property.type)->bytes;
    return bytes;
  }
  std::size_t bytes_left() const { return left_.size(); }
  void begin(const PlyElement&, std::int64_t) {}

  double value(const PlyType& type) {
    place_ = all_.size() - left_.size();
    if (left_.size() < type.bytes) fail("the file ends within a value");
    const double number = decode_number(type, left_.data(), kBigEndian);
    left_.remove_prefix(type.bytes);
    return number;
  }
  std::size_t values_left() const { return left_.size(); }
  void end() {}
  void finish() {
    place_ = all_.size() - left_.size();
    if (!left_.empty())
      fail(std::to_string(left_.size()) + " bytes follow the last element, expected the end of the file");
  }
  [[noreturn]] void fail(const std::string& problem) const {
    throw IoError(path_, "byte " + std::to_string(place_) + " after the header", problem);
  }

 private:
  const std::string& path_;
  std::string_view all_, left_;
  std::size_t place_ = 0;  // of the value read last
};

/// The positions of the properties that form a mesh.
struct Layout {
  int x, y, z;
  int corners;
};

template <class Body>
class MeshReader {
 public:
  MeshReader(const std::string& path, const PlyHeader& header, LineReader& reader) : path_(path), body_(path, reader) {
    bool seen = false;
    for (const PlyElement& element : header.elements) {
      check_size(element);
      const Layout layout = layout_of(element);
      if (element.name == "vertex") {
        seen = true;
        vertices_ = element.count;
        mesh_.vertices.resize(vertices_, 3);
      }
      if (element.properties.empty()) continue;
      for (std::int64_t row = 0; row < element.count; ++row) read_row(element, layout, row);
    }
    if (!seen) throw IoError(path_, "header", "no element vertex, expected one");
    body_.finish();
    for (const int corner : largest_corners_)
      if (corner >= vertices_)
        throw IoError(
            path_, "faces",
            "a corner is vertex " + std::to_string(corner) + ", expected 0 .. " + std::to_string(vertices_ - 1));
    mesh_.triangles = triangles_.build();
  }

  StoredMesh take() { return std::move(mesh_); }

 private:
  /// An element cannot hold more than the bytes that are there.
  void check_size(const PlyElement& element) const {
    const std::size_t smallest = Body::smallest(element);
    if (smallest > 0 && static_cast<std::size_t>(element.count) > body_.bytes_left() / smallest + 1)
      throw IoError(path_, "header",
                    "promises " + std::to_string(element.count) + " of element " + quoted(element.name) +
                        ", but only " + std::to_string(body_.bytes_left()) + " bytes follow");
  }

  Layout layout_of(const PlyElement& element) const {
    const Layout layout{element.find("x"), element.find("y"), element.find("z"),
                        std::max(element.find("vertex_indices"), element.find("vertex_index"))};
    if (element.name == "vertex") {
      for (const int place : {layout.x, layout.y, layout.z})
        if (place < 0 || element.properties[static_cast<std::size_t>(place)].count_type)
          throw IoError(path_, "header", "element vertex lacks a coordinate, expected properties x, y and z");
    } else if (element.name == "face") {
      if (layout.corners < 0 || !element.properties[static_cast<std::size_t>(layout.corners)].count_type ||
          element.properties[static_cast<std::size_t>(layout.corners)].type->kind == 'f')
        throw IoError(path_, "header",
                      "element face lacks its corners, expected a list of whole numbers vertex_indices");
    }
    return layout;
  }

  void read_row(const PlyElement& element, const Layout& layout, std::int64_t row) {
    const bool is_vertex = element.name == "vertex", is_face = element.name == "face";
    body_.begin(element, row);
    for (int place = 0; place < static_cast<int>(element.properties.size()); ++place) {
      const PlyProperty& property = element.properties[static_cast<std::size_t>(place)];
      if (property.count_type) {
        read_list(property);
        if (is_face && place == layout.corners) add_face();
      } else {
        const double value = body_.value(*property.type);
        if (!is_vertex || (place != layout.x && place != layout.y && place != layout.z)) continue;
        if (!std::isfinite(value)) body_.fail("found " + to_text(value) + ", expected a finite coordinate");
        if (place == layout.x) mesh_.vertices(row, 0) = value;
        if (place == layout.y) mesh_.vertices(row, 1) = value;
        if (place == layout.z) mesh_.vertices(row, 2) = value;
      }
    }
    body_.end();
  }

  void read_list(const PlyProperty& property) {
    const double count = body_.value(*property.count_type);
    if (!(count >= 0) || count > static_cast<double>(body_.values_left()))
      body_.fail("a list of " + std::to_string(static_cast<std::int64_t>(count)) +
                 " values, expected no more than follow");
    list_.clear();
    for (auto i = static_cast<std::int64_t>(count); i > 0; --i) list_.push_back(body_.value(*property.type));
  }

  void add_face() {
    if (list_.size() < 3) body_.fail("a face of " + std::to_string(list_.size()) + " corners, expected at least three");
    Indices corners;
    int largest = -1;
    for (const double corner : list_) {
      if (!(corner >= 0) || corner > static_cast<double>(kMaximumCount))
        body_.fail("a corner is " + to_text(corner) + ", expected a vertex");
      corners.push_back(static_cast<int>(corner));
      largest = std::max(largest, corners.back());
    }
    if (largest >= vertices_ && vertices_ > 0)
      body_.fail("a corner is vertex " + std::to_string(largest) + ", expected 0 .. " + std::to_string(vertices_ - 1));
    if (vertices_ == 0) largest_corners_.push_back(largest);  // faces before vertices: checked at the end
    triangles_.add_polygon(corners);
  }

  const std::string& path_;
  Body body_;
  StoredMesh mesh_;
  std::int64_t vertices_ = 0;
  TriangleBuilder triangles_;
  std::vector<double> list_;
  Indices largest_corners_;
};

}  // namespace

StoredMesh parse_ply(const std::string& path, std::string_view content) {
  LineReader reader(path, content);
  const PlyHeader header = parse_ply_header(reader);
  switch (header.encoding) {
    case PlyEncoding::Ascii:
      return MeshReader<TextBody>(path, header, reader).take();
    case PlyEncoding::Big:
      return MeshReader<BinaryBody<true>>(path, header, reader).take();
    case PlyEncoding::Little:
      break;
  }
  return MeshReader<BinaryBody<false>>(path, header, reader).take();
}

}  // namespace corral
